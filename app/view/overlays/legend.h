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
  std::vector<Line> lines;
  double strongest = 0;  ///< N, at the end of the scale of forces; 0: no scale.
};

/// Returns the legend of the chosen marks. Real-time: never from the servo thread.
Legend legend_of(const DrawnScene& scene, const DrawnMoment& moment, const PaintChoice& choice);

/// Draws a legend at the upper left of a part. Call between ImGui's NewFrame and Render.
void write_legend(const Legend& legend, Theme theme, const ScreenPart& part);

}  // namespace thimble::view
