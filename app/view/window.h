#pragma once

#include <string>

#include "thimble/driver/result.h"
#include "view/feedback/touch_thread.h"
#include "view/gl/palette.h"
#include "view/input/hand_input.h"
#include "view/playback/recording_view.h"

namespace thimble::view {

/// Initial state of a window, and when it closes by itself, for tests.
struct WindowChoice {
  HandSource hand = HandSource::kMouse;  ///< Source of the hand, if the run lets a viewer move it.
  FeedbackChoice felt;
  double ui_scale = 0;  ///< Scale of text and panel; 0: that of the monitor.
  Theme theme = Theme::kLight;
  double seconds = 0;        ///< Closes after this time, s; 0: when the user closes it.
  std::string last_picture;  ///< PNG of the window before it closes by itself; empty: none.
  double at = -1;  ///< Time of a recording at which it is stopped at first, s; below 0: it plays.
};

/// Opens a window that plays a recording until it is closed; `file` is its name. The error says why
/// there is no window. Real-time: never from the servo thread.
driver::Result<void> show_recording(const RecordingView& recording, const std::string& file,
                                    const WindowChoice& choice);

class RecordedRuns;

/// As `show_recording`, for several recordings and own signals on one time line. `name` is used for
/// the names of its pictures.
driver::Result<void> show_recordings(RecordedRuns& runs, const std::string& name,
                                     const WindowChoice& choice);

}  // namespace thimble::view
