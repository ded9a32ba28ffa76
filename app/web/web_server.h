#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include "share/run_attachment.h"
#include "thimble/driver/result.h"

namespace thimble::web {

/// Serves the page of a live run to browsers on this computer: the page over HTTP, its updates over
/// WebSocket (LiveFeed). Requests without the token or from other origins are refused with a
/// sentence (RequestGuard). Messages of pages over WebSocket are ignored. Commands to the run come
/// by POST and use the same requests as all viewers (steer_run). All work is done in the thread
/// that calls `step`, which accesses the run only through SharedReader. Real-time: never from the
/// servo thread.
class WebServer {
 public:
  /// Time between two updates: 30 a second. [chosen: what a screen shows of a touch]
  static constexpr std::chrono::milliseconds kStep{33};
  /// Maximum number of pages at a time. [chosen]
  static constexpr std::size_t kPagesMax = 16;
  /// Maximum bytes of a message from a page; longer ones end its connection. [chosen: pages need to
  /// send nothing]
  static constexpr std::size_t kIncomingMax = 1024;

  /// Listens on a port of 127.0.0.1; 0: any free port. Keeps `runs`, which must outlive it. The
  /// error says what to do.
  static driver::Result<std::unique_ptr<WebServer>> listen(session::RunAttachment& runs,
                                                           std::uint16_t port);
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  /// Returns the URL to open, with the token.
  std::string address() const;
  std::uint16_t port() const noexcept;
  /// Returns the number of pages that are connected.
  std::size_t pages() const noexcept;
  /// Serves for kStep, then sends what is new to the pages.
  void step();
  /// Sends the rest of a run that is over to the pages, for at most `max_time`, and closes all
  /// connections.
  void leave(std::chrono::milliseconds max_time);

 private:
  class Parts;
  explicit WebServer(std::unique_ptr<Parts> parts);

  std::unique_ptr<Parts> parts_;
};

}  // namespace thimble::web
