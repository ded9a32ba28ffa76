#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "thimble/driver/result.h"

namespace thimble::compat::haply {

/// First word of the Server header in the service's answers: a driver that searches for an arm
/// recognises that this is no arm.
inline constexpr const char* kServerName = "Thimble";

/// Port of an Inverse3's service [S docs.haply.co/inverseSDK].
inline constexpr std::uint16_t kPort = 10001;

/// A WebSocket service on this computer that is compatible with an Inverse3's: programs for that
/// arm find the arms of `thimble exec` there. It runs in the process of `thimble exec` and accesses
/// the arms like the compatibility libraries (core/arm_access.h), with a thread for each program.
///
/// Only programs on this computer that belong to this user or to root are accepted, as the kernel
/// reports the owner of each connection. Web pages of other origins are refused. A message may have
/// 256 KiB. Invalid messages cause no force. Real-time: no function may be called from the servo
/// thread.
class Service {
 public:
  using Report = std::function<void(const std::string& sentence)>;

  /// Listens on a port; 0: any free port. The channel to the arms must be in use (use_channel)
  /// until the service is destroyed. Starts by opening all arms, so the thread that serves the arms
  /// must continue to do so. `report`, if given, gets a message when the first program of another
  /// user is refused, from a thread of the service. The error message has the remedy.
  static driver::Result<std::unique_ptr<Service>> listen(std::uint16_t port, Report report = {});
  /// Closes all connections and waits for the threads.
  ~Service();
  Service(const Service&) = delete;
  Service& operator=(const Service&) = delete;

  /// Returns its port.
  std::uint16_t port() const noexcept;
  /// Returns whether opening the arms has finished, with or without success; from then on programs
  /// are accepted.
  bool ready() const noexcept;
  /// Returns the number of programs that have connected.
  int programs() const noexcept;
  /// Returns the number of connections refused because their other end did not belong to a process
  /// of this user or of root.
  int refused() const noexcept;
  /// Closes all connections. Any thread.
  void leave();
  /// Returns whether all its threads have ended, after `leave`. Until then, the arms must still be
  /// served.
  bool ended() const noexcept;

 private:
  class Listener;
  explicit Service(std::unique_ptr<Listener> listener);

  std::unique_ptr<Listener> listener_;
};

}  // namespace thimble::compat::haply
