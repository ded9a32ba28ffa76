#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::driver::haply {

/// Where the service listens [S docs.haply.co/inverseSDK].
inline constexpr std::uint16_t kPort = 10001;

/// Returns the port that THIMBLE_HAPLY_PORT names, else kPort: the service's own file of settings
/// can move it. Real-time: never from the servo thread.
THIMBLE_EXPORT std::uint16_t port_of_user();

/// What passes over a socket while it is served. All are called by the thread that serves.
class Traffic {
 public:
  Traffic() = default;
  Traffic(const Traffic&) = delete;
  Traffic& operator=(const Traffic&) = delete;
  virtual ~Traffic() = default;

  virtual void received(std::string_view text) = 0;       ///< A message came.
  virtual std::optional<std::string> next_message() = 0;  ///< Returns what is to be sent, if any.
  virtual std::string last_message() = 0;                 ///< Returns what is sent at the end.
  virtual void lost() = 0;                                ///< The other side is gone.
};

/// A WebSocket to a service on this computer, and on no other.
class Socket {
 public:
  /// Connects and waits for the first message, at most `timeout_ns` in all. Nothing is sent but
  /// what opens a WebSocket. Fails if nobody listens, if it is no WebSocket, if it stays silent, or
  /// if a process of another user than this one and root speaks.
  /// Real-time: never from the servo thread.
  static Result<std::unique_ptr<Socket>> connect(std::uint16_t port, std::int64_t timeout_ns);
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  ~Socket();

  /// Returns the first message. Real-time: never from the servo thread.
  const std::string& first() const;
  /// Returns whether the other side is Thimble's own stand-in for the service (`thimble exec
  /// --serve haply`), behind which is no Inverse3. Real-time: never from the servo thread.
  bool is_stand_in() const;
  /// Reads and writes until `leave` or the loss of the other side; by a thread of its own.
  void serve(Traffic& traffic);
  /// Wakes `serve`, which then asks for the next message. Real-time: safe; never waits.
  void ring() noexcept;
  /// Lets `serve` send the last message, close, and return, within a tenth of a second. From any
  /// thread.
  void leave() noexcept;

 private:
  class Connection;
  explicit Socket(std::unique_ptr<Connection> connection);

  std::unique_ptr<Connection> connection_;
};

}  // namespace thimble::driver::haply
