#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "view/drawn_scene.h"

namespace thimble::view {

/// A camera that orbits a point of the world. World: x towards the user, y to the user's right, z
/// up.
struct Camera {
  Eigen::Vector3d p_WTarget{0, 0, 0};  ///< The point at the centre of the picture, m.
  double yaw = 0.5;                    ///< rad about z, from x: to the user's right.
  double pitch = 0.45;                 ///< rad above the horizon.
  double distance = 0.5;               ///< Distance from the target, m.
  double opening = 0.5;                ///< Vertical field of view, rad.

  /// Returns the direction from the target to the eye; unit vector in W.
  Eigen::Vector3d towards_eye() const;
  /// Returns the position of the eye, m in W.
  Eigen::Vector3d p_WEye() const { return p_WTarget + distance * towards_eye(); }
  /// Return the directions right and up in the picture; unit vectors in W.
  Eigen::Vector3d right() const;
  Eigen::Vector3d up() const;

  /// Returns the transform from the world to the eye: x right, y up, looking along -z.
  Eigen::Matrix4f view() const;
  /// Returns the transform from the eye's frame to the picture; `aspect` is width by height.
  Eigen::Matrix4f projection(double aspect) const;

  /// Returns the position of a point in a picture of this size: pixels from the left and from the
  /// top. Precondition: the point is in front of the eye.
  Eigen::Vector2d pixel(const Eigen::Vector3d& p_W, double width, double height) const;
  /// Returns the direction (unit, W) of the ray from the eye through a pixel.
  Eigen::Vector3d ray(double x, double y, double width, double height) const;

  /// Turns the eye about the target by angles (rad). The pitch stays short of straight up and down.
  void orbit(double by_yaw, double by_pitch);
  /// Moves eye and target right and up, by fractions of the picture's height.
  void pan(double right_share, double up_share);
  /// Moves `factor` times closer; the distance stays between a millimetre and 10 m.
  void zoom(double factor);
};

/// Returns points that must be visible (W, m): of the objects, the tips and the forces. A large
/// mesh contributes some thousand of its vertices.
std::vector<Eigen::Vector3d> framed_points(const DrawnScene& scene, const DrawnMoment& moment);

/// Returns a camera that shows the whole scene, with the touched side to the front. `aspect` is the
/// picture's width by height.
Camera frame(const DrawnScene& scene, const DrawnMoment& moment, double aspect);

}  // namespace thimble::view
