#pragma once

#include <string>

#include "thimble/driver/result.h"

namespace thimble::app::view {

/// Says what a window shows.
struct WindowChoice {
  std::string name;           ///< Of the run; empty: the newest.
  double seconds = 0;         ///< Closes by itself after so long; 0: when the user closes it.
  std::string last_picture;   ///< PNG of the whole window, written before it closes; empty: none.
};

/// Opens a window on a run and shows it until the window is closed. Where there is no such run, or
/// it has ended, the window says so and takes the next of that name. The run never notices.
/// The error says why there is no window. Real-time: never from the servo thread.
driver::Result<void> show_window(const WindowChoice& choice);

}  // namespace thimble::app::view
