#pragma once

#include <string>
#include <vector>

#include "view/drawn_scene.h"
#include "view/gl/palette.h"
#include "view/scene_painter.h"
#include "view/text_style.h"

namespace thimble::view {

/// What the marks of a picture mean, in words.
struct Legend {
  /// One line: a piece of colour and what it stands for.
  struct Line {
    Colour colour{};
    std::string text;
  };
  std::vector<Line> lines;
  double strongest = 0;  ///< N, at the end of the scale of forces; 0: no scale.
};

/// Returns what the marks that are chosen mean. Real-time: never from the servo thread.
Legend legend_of(const DrawnScene& scene, const DrawnMoment& moment, const PaintChoice& choice);

/// Writes a legend at the upper left of a part. To be called between ImGui's
/// NewFrame and Render.
void write_legend(const Legend& legend, Theme theme, const ScreenPart& part);

}  // namespace thimble::view
