#pragma once

#include <sys/types.h>

#include <memory>
#include <string>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::session {

/// Returns whether a display is available: X11 or Wayland. Real-time: never from the servo thread.
THIMBLE_EXPORT bool has_display();

/// Viewer process opened by a run; the run does not depend on it. Real-time: never from the servo
/// thread.
class ViewerProcess {
 public:
  /// Starts `thimble view RUN` with additional `arguments`. It stays open when the run ends, and
  /// reports the end.
  static driver::Result<std::unique_ptr<ViewerProcess>> start(
      const std::string& run, std::vector<std::string> arguments = {});

  /// Returns whether the viewer was closed by the user or ended by a signal; false if it could not
  /// open its window.
  bool closed();

 private:
  explicit ViewerProcess(pid_t pid) : pid_(pid) {}

  pid_t pid_;
  bool alive_ = true;
  bool closed_ = false;
};

}  // namespace thimble::session
