#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::driver::haply {

/// Port of the service [S docs.haply.co/inverseSDK].
inline constexpr std::uint16_t kPort = 10001;

/// Returns the port that THIMBLE_HAPLY_PORT names, else kPort; the settings file of the service can
/// change it. Real-time: never from the servo thread.
THIMBLE_EXPORT std::uint16_t port_of_user();

/// Callbacks of a socket while it is served, called by the serving thread.
class SocketCallbacks {
 public:
  SocketCallbacks() = default;
  SocketCallbacks(const SocketCallbacks&) = delete;
  SocketCallbacks& operator=(const SocketCallbacks&) = delete;
  virtual ~SocketCallbacks() = default;

  virtual void received(std::string_view text) = 0;       ///< A message arrived.
  virtual std::optional<std::string> next_message() = 0;  ///< Returns a message to send, if any.
  virtual std::string last_message() = 0;  ///< Returns the message to send at the end.
  virtual void lost() = 0;                 ///< The other side is gone.
};

/// A WebSocket to a service on this computer only.
class Socket {
 public:
  /// Connects and waits for the first message, at most `timeout_ns` in total. Sends nothing but the
  /// WebSocket handshake. Fails if no program listens, if it is not a WebSocket, or if it stays
  /// silent. Also fails if its process belongs to a user other than this one and root. Real-time:
  /// never from the servo thread.
  static Result<std::unique_ptr<Socket>> connect(std::uint16_t port, std::int64_t timeout_ns);
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  ~Socket();

  /// Returns the first message. Real-time: never from the servo thread.
  const std::string& first() const;
  /// Returns whether the other side is Thimble's own stand-in for the service (`thimble exec
  /// --serve haply`), which has no Inverse3. Real-time: never from the servo thread.
  bool is_stand_in() const;
  /// Reads and writes until `leave` or until the other side is lost. Run it in its own thread.
  void serve(SocketCallbacks& traffic);
  /// Wakes `serve`, which then asks for the next message. Real-time: safe; never waits.
  void ring() noexcept;
  /// Makes `serve` send the last message, close, and return, within a tenth of a second. From any
  /// thread.
  void leave() noexcept;

 private:
  class Connection;
  explicit Socket(std::unique_ptr<Connection> connection);

  std::unique_ptr<Connection> connection_;
};

}  // namespace thimble::driver::haply
