#pragma once

#include <imgui.h>

#include <string>

#include "view/gl/palette.h"

namespace thimble::view {

/// Returns a colour as text of the current style is written in it.
ImVec4 shown_colour(const Colour& colour);

/// Puts the things of a panel one after the other, and on the next line where the room ends. To be
/// used between ImGui's NewFrame and Render.
class Flow {
 public:
  /// To be called before each; `width` in pixels.
  void next(float width);
  /// Writes a value so that its end stays where it is: there is room for `widest`.
  void value(const Colour& colour, const std::string& text, const char* widest);

 private:
  bool first_ = true;
};

}  // namespace thimble::view
