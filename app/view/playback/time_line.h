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

  /// Draws it into `part` and moves the head of `source` by the user's input.
  static void draw(const ScreenPart& part, TouchSource& source);

  /// Handles a key (a GLFW_KEY_...) of the time line; returns whether it was one. Space is one only
  /// for a recording: for a run it means pause. Without `arrows`, the arrow keys are not handled.
  static bool take_key(int key, TouchSource& source, bool arrows = true);
};

/// Returns the shown time as text: "2.431 of 8.000 s", "now", "12.4 s behind".
std::string words_of(const PlayHead& head);

}  // namespace thimble::view
