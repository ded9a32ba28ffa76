#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include "share/run_attachment.h"
#include "thimble/driver/result.h"

namespace thimble::web {

/// Serves the page of a run that goes on to browsers on this computer: over HTTP the page, over
/// WebSocket what it is told (LiveFeed). Who has not the token, or asks for a page of somebody
/// else's, is refused with a sentence (RequestGuard). What pages say over WebSocket is not listened
/// to; what they ask of the run comes by POST and goes the way of all viewers (steer_run). All of
/// it goes on in the thread that calls `step`, and reaches the run by SharedReader
/// alone. Real-time: never from the servo thread.
class WebServer {
 public:
  /// Between two updates: 30 a second. [chosen: what a screen shows of a touch]
  static constexpr std::chrono::milliseconds kStep{33};
  /// Pages at a time. [chosen]
  static constexpr std::size_t kPagesMost = 16;
  /// Bytes of what a page may say; longer ones end its connection. [chosen: they need say nothing]
  static constexpr std::size_t kSaidMost = 1024;

  /// Listens on a port of 127.0.0.1; 0: one that is free. Keeps `runs`, which must outlive it. The
  /// error says what to do.
  static driver::Result<std::unique_ptr<WebServer>> listen(session::RunAttachment& runs,
                                                           std::uint16_t port);
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  /// Returns the address to open, with its token.
  std::string address() const;
  std::uint16_t port() const noexcept;
  /// Returns how many pages are connected.
  std::size_t pages() const noexcept;
  /// Serves for kStep, then looks what is new and tells the pages.
  void step();
  /// Tells the pages the rest of a run that is over, for `most` at most, and closes all
  /// connections.
  void leave(std::chrono::milliseconds most);

 private:
  class Parts;
  explicit WebServer(std::unique_ptr<Parts> parts);

  std::unique_ptr<Parts> parts_;
};

}  // namespace thimble::web
