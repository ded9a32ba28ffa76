#pragma once

#include <string>

#include "view/text_style.h"
#include "view/touch_source.h"

namespace thimble::view {

/// The time line below the scene: buttons and a bar to show any kept moment. Like the panel, it is
/// drawn between ImGui's NewFrame and Render. Real-time: never from the servo thread.
class TimeLine {
 public:
  /// Returns its height in a window's part of this width, pixels.
  static float height(float width);

  /// Draws it into `part`. At the newest moment of a run, its pause button and its speed are those
  /// of the run; at an earlier one, and in a recording, those of the playback. Returns why the run
  /// refused a request; empty: it did not.
  static std::string draw(const ScreenPart& part, TouchSource& source);

  /// Handles a key (a GLFW_KEY_...) of the time line; returns whether it was one. Space, comma and
  /// period are not at the newest moment of a run: there they mean the run. Without `arrows`, the
  /// arrow keys are not handled.
  static bool take_key(int key, TouchSource& source, bool arrows = true);
};

/// Returns the shown time as text: "2.431 of 8.000 s", "now", "12.4 s behind".
std::string words_of(const PlayHead& head);

}  // namespace thimble::view
