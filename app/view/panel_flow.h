#pragma once

#include <imgui.h>

#include <string>

#include "view/gl/palette.h"

namespace thimble::view {

/// Returns a colour adapted for text in the current style.
ImVec4 shown_colour(const Colour& colour);

/// Places the items of a panel in lines, and starts a new line if there is no room. Use between
/// ImGui's NewFrame and Render.
class Flow {
 public:
  /// Call before each item; `width` in pixels.
  void next(float width);
  /// Draws a value right-aligned, with room for `widest`.
  void value(const Colour& colour, const std::string& text, const char* widest);

 private:
  bool first_ = true;
};

}  // namespace thimble::view
