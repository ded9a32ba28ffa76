#pragma once

#include <Eigen/Core>
#include <optional>

#include "view/camera.h"
#include "view/text_style.h"

namespace thimble::view {

/// An arrow at the border of a picture that points to something outside of it.
struct BorderArrow {
  Eigen::Vector2d at{0, 0};         ///< Its point, pixels from the upper left corner.
  Eigen::Vector2d direction{0, 0};  ///< Unit vector, right and down.
};

/// Returns the arrow to a point of the world (m); none if the picture shows it, or if it is not
/// finite. `margin` is the distance of the arrow from the border, pixels.
std::optional<BorderArrow> arrow_to(const Camera& camera, const Eigen::Vector3d& p_W, double width,
                                    double height, double margin);

/// Moves the camera sideways by as much as it takes to show a point (W, m) within `share` of the
/// picture's half width and height; `aspect` is width by height. A point behind the eye, or close
/// to it, becomes the centre. NaN changes nothing.
void keep_in_picture(Camera& camera, const Eigen::Vector3d& p_W, double aspect, double share);

/// Draws the arrow to the tip (W, m) if it is outside of the picture, with the key that shows it.
/// Call between ImGui's NewFrame and Render. Real-time: never from the servo thread.
void draw_arrow_to_tip(const Camera& camera, const Eigen::Vector3d& p_WT, Theme theme,
                       const ScreenPart& part);

}  // namespace thimble::view
