#pragma once

#include <string>

#include "view/text_style.h"
#include "view/touch_source.h"

namespace thimble::view {

/// The line of time below the scene: buttons and a bar to look at any moment that is kept. As the
/// panel, it is drawn between ImGui's NewFrame and Render. Real-time: never from the servo thread.
class TimeLine {
 public:
  /// Returns how high it is in a window's part of this width, pixels.
  static float height(float width);

  /// Draws it into `part` and moves the head of `source` as the user asks.
  static void draw(const ScreenPart& part, TouchSource& source);

  /// Does what a key (a GLFW_KEY_...) asks of time; returns whether it was one of those. Space is
  /// one in a recording alone: a run is paused by it. Without `arrows` those are somebody else's.
  static bool take_key(int key, TouchSource& source, bool arrows = true);
};

/// Returns which moment is looked at: "2.431 of 8.000 s", "now", "12.4 s behind".
std::string words_of(const PlayHead& head);

}  // namespace thimble::view
