#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "view/drawn_scene.h"

namespace thimble::view {

/// An eye that circles about a point of the world. World: x towards the user, y to the user's
/// right, z up.
struct Camera {
  Eigen::Vector3d p_WTarget{0, 0, 0};  ///< What it looks at, m.
  double yaw = 0.5;                    ///< rad about z, from x: to the user's right.
  double pitch = 0.45;                 ///< rad above the horizon.
  double distance = 0.5;               ///< m, from the target.
  double opening = 0.5;                ///< rad, of the picture's height.

  /// Returns the direction from the target to the eye; unit vector in W.
  Eigen::Vector3d towards_eye() const;
  /// Returns where the eye is, m in W.
  Eigen::Vector3d p_WEye() const { return p_WTarget + distance * towards_eye(); }
  /// Tell the directions right and up in the picture; unit vectors in W.
  Eigen::Vector3d right() const;
  Eigen::Vector3d up() const;

  /// Takes the world to the eye: x right, y up, looking along -z.
  Eigen::Matrix4f view() const;
  /// Takes the eye's frame to the picture; `aspect` is width by height.
  Eigen::Matrix4f projection(double aspect) const;

  /// Finds where a point falls in a picture of this size: pixels from the left and from the top.
  /// Precondition: the point is before the eye.
  Eigen::Vector2d pixel(const Eigen::Vector3d& p_W, double width, double height) const;
  /// Finds the direction (unit, W) of the ray from the eye through a pixel.
  Eigen::Vector3d ray(double x, double y, double width, double height) const;

  /// Turns about the target by angles (rad); the pitch stays short of straight up and down.
  void orbit(double by_yaw, double by_pitch);
  /// Moves eye and target by shares of the picture's height, right and up.
  void pan(double right_share, double up_share);
  /// Comes `factor` times closer, between a millimetre and 10 m.
  void zoom(double factor);
};

/// Lists points that must be seen (W, m): of objects where they are, of the tip and the force. A
/// large mesh gives some thousand of its vertices.
std::vector<Eigen::Vector3d> framed_points(const DrawnScene& scene, const DrawnMoment& moment);

/// Finds a camera that shows the scene well: all of it in the picture, the touched side to the
/// front. `aspect` is the picture's width by height.
Camera frame(const DrawnScene& scene, const DrawnMoment& moment, double aspect);

}  // namespace thimble::view
