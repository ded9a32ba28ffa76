#pragma once

#include <string>

#include "share/run_attachment.h"
#include "thimble/driver/result.h"
#include "view/feedback/touch_thread.h"
#include "view/gl/palette.h"
#include "view/input/hand_input.h"
#include "view/playback/recording_view.h"

namespace thimble::view {

/// What a window begins with, and when it closes by itself, for tests.
struct WindowChoice {
  HandSource hand = HandSource::kMouse;  ///< Leads the simulated hand, where a run lets a viewer.
  FeltChoice felt;
  double ui_scale = 0;  ///< Of text and panel; 0: the monitor's.
  Theme theme = Theme::kLight;
  double seconds = 0;        ///< Closes after so long; 0: when the user closes it.
  std::string last_picture;  ///< PNG of the whole window, written before it closes so; empty: none.
  double at = -1;  ///< Of a recording: second at which it stands still at first; below 0: it plays.
};

/// Opens a window on the runs that are watched and shows them until it is closed. Where there is no
/// run, or it has ended, the window says so and takes the next. The runs never notice.
/// The error says why there is no window. Real-time: never from the servo thread.
driver::Result<void> show_window(session::RunAttachment& runs, const WindowChoice& choice);

/// Opens a window that plays a recording until it is closed; `file` names it. The error says why
/// there is no window. Real-time: never from the servo thread.
driver::Result<void> show_recording(const RecordingView& recording, const std::string& file,
                                    const WindowChoice& choice);

}  // namespace thimble::view
