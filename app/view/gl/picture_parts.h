#pragma once

#include <Eigen/Geometry>
#include <functional>

#include "view/gl/canvas.h"

namespace thimble::view {

/// Draws a picture in parts: calls `within` for a box of it (pixels from the lower left of the
/// scene's part, inside of it) and `beside` for what is left, in up to four parts, each time with
/// all other pixels shut out. What both draw alike is the same as if drawn in one go.
void paint_apart(const Canvas& canvas, const Eigen::AlignedBox2i& box,
                 const std::function<void()>& within, const std::function<void()>& beside);

}  // namespace thimble::view
