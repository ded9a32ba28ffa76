#pragma once

#include <string>
#include <vector>

#include "view/drawn_scene.h"
#include "view/gl/palette.h"
#include "view/scene_painter.h"
#include "view/text_style.h"

namespace thimble::view {

/// The meanings of the marks of a picture, in words.
struct Legend {
  /// One line: a colour and its meaning.
  struct Line {
    Colour colour{};
    std::string text;
  };
  /// The colours of a map, and its range.
  struct Scale {
    std::size_t object = 0;
    std::string text, min, max;
  };
  std::vector<Line> lines;
  std::vector<Scale> maps;
  double strongest = 0;  ///< N, at the end of the scale of forces; 0: no scale.
};

/// Returns the legend of the chosen marks, and of the maps of all objects. Real-time: never from
/// the servo thread.
Legend legend_of(const DrawnScene& scene, const DrawnMoment& moment, const PaintChoice& choice);

/// Draws a legend at the upper left of a part; returns the part that it covers, without size if it
/// is empty. Call between ImGui's NewFrame and Render.
ScreenPart write_legend(const Legend& legend, Theme theme, const ScreenPart& part);

}  // namespace thimble::view
