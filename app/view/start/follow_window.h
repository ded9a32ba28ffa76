#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "share/run_attachment.h"
#include "thimble/driver/result.h"
#include "view/window.h"

namespace thimble::view {

/// Options of a window on the runs of other processes.
struct FollowSetup {
  std::filesystem::path thimble;  ///< The program `thimble`, which runs scenes.
  /// Arguments of `thimble` that start the run again after its end (`run_again_command`), from the
  /// run that opened the window; empty: the window does not start it.
  std::vector<std::string> again;
};

/// Opens a window on the followed runs and shows them until it is closed. While there is no run, it
/// shows a page that says so; if the run has ended, it says so and shows the next one. A run that
/// it started again ends with it; other runs are not affected. The error says why there is no
/// window. Real-time: never from the servo thread.
driver::Result<void> show_window(session::RunAttachment& runs, const FollowSetup& setup,
                                 const WindowChoice& choice);

}  // namespace thimble::view
