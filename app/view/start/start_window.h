#pragma once

#include <filesystem>
#include <string>

#include "thimble/driver/result.h"
#include "view/content/window_loop.h"
#include "view/window.h"

namespace thimble::view {

/// Options of the start window.
struct StartSetup {
  std::filesystem::path thimble;  ///< The program `thimble`, which runs the scenes.
  std::string open;        ///< A file, or the name of a scene, to select first; may be empty.
  bool path_hand = false;  ///< The hand follows the path of the scene at first.
};

/// Opens the start window: the scenes with their pictures, recent files, a field and a dialog to
/// open others. It shows the chosen run or recording, and returns to the scenes. A run that it
/// started ends with it. The error says why there is no window. Real-time: never from the servo
/// thread.
driver::Result<void> show_start_window(const StartSetup& setup, const WindowChoice& choice);

/// Returns the function that draws the start window on `screen`, which must outlive it. A run that
/// was started there ends when the function is destroyed. Real-time: never from the servo thread.
DrawPicture start_window_on(Screen& screen, const StartSetup& setup, const WindowChoice& choice);

}  // namespace thimble::view
