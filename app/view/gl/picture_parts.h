#pragma once

#include <Eigen/Geometry>
#include <functional>

#include "view/gl/canvas.h"

namespace thimble::view {

/// Draws a picture in parts. Calls `within` for a box of it (pixels from the lower left of the
/// scene's part), and `beside` for the rest, in up to four parts. All other pixels are masked
/// meanwhile. If both draw the same, the result equals that of drawing at once.
void paint_apart(const Canvas& canvas, const Eigen::AlignedBox2i& box,
                 const std::function<void()>& within, const std::function<void()>& outside);

}  // namespace thimble::view
