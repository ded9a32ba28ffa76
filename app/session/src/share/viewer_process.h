#pragma once

#include <sys/types.h>

#include <memory>
#include <string>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::session {

/// Returns whether there is a screen to draw on: X11 or Wayland. Real-time: never from the servo
/// thread.
THIMBLE_EXPORT bool has_display();

/// The viewer that a run has opened, a process of its own: nothing of the run depends on it.
/// Real-time: never from the servo thread.
class ViewerProcess {
 public:
  /// Starts `thimble view RUN`, with more `arguments`. It stays when the run ends, and tells so.
  static driver::Result<std::unique_ptr<ViewerProcess>> start(
      const std::string& run, std::vector<std::string> arguments = {});

  /// Returns whether a person has closed it, or a signal has ended it; one that could not open its
  /// window was not closed.
  bool closed();

 private:
  explicit ViewerProcess(pid_t pid) : pid_(pid) {}

  pid_t pid_;
  bool alive_ = true;
  bool closed_ = false;
};

}  // namespace thimble::session
