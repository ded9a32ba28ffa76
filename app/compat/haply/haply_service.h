#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "thimble/driver/result.h"

namespace thimble::compat::haply {

/// Begins the Server line of the stand-in's answer to a program that connects: a driver that looks
/// for an arm takes it for none.
inline constexpr const char* kServerName = "Thimble";

/// Where an Inverse3's service listens [S docs.haply.co/inverseSDK].
inline constexpr std::uint16_t kPort = 10001;

/// A WebSocket service on this computer that stands in for an Inverse3's: programs that were
/// written for one find the arms of `thimble exec` there. It lives in the process of `thimble exec`
/// and reaches the arms as the libraries that stand in for others' do (core/arm_access.h), by a
/// thread for each program.
///
/// Only programs of this user and of root on this computer are heard, as the kernel lists the owner
/// of each connection, and no web page of another: what names a foreign origin is refused. A
/// message may have 256 KiB. Who says anything that is no message of such a program gets no force
/// for it. Real-time: never from the servo thread, all of it.
class Service {
 public:
  using Report = std::function<void(const std::string& sentence)>;

  /// Listens on a port; 0: one that is free. The channel to the arms must be in use (use_channel)
  /// until the service is destroyed. Begins by opening all arms, for which whoever serves them has
  /// to go on with it. `report`, if given, gets a sentence when the first program of another user
  /// is refused, by a thread of the service. The error says what to do.
  static driver::Result<std::unique_ptr<Service>> listen(std::uint16_t port, Report report = {});
  /// Leaves, and waits for its threads.
  ~Service();
  Service(const Service&) = delete;
  Service& operator=(const Service&) = delete;

  /// Returns where it listens.
  std::uint16_t port() const noexcept;
  /// Returns whether the arms have been opened, or could not be; programs are let in from then on.
  bool ready() const noexcept;
  /// Returns how many programs have come.
  int programs() const noexcept;
  /// Returns how many connections were refused because their other end was not held by a process of
  /// this user or of root.
  int refused() const noexcept;
  /// Closes all connections. Any thread.
  void leave();
  /// Returns whether all its threads are done, after `leave`: until then whoever serves the arms
  /// has to go on with it.
  bool ended() const noexcept;

 private:
  class Listener;
  explicit Service(std::unique_ptr<Listener> listener);

  std::unique_ptr<Listener> listener_;
};

}  // namespace thimble::compat::haply
