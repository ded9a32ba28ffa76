#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace thimble::render {

/// The part of a surface that is closest to the centre of a ball, for one triangle or one convex
/// shape. W, m.
struct BallFeature {
  /// Kind of part, by the directions in which it bends away from the ball.
  enum class Kind : std::uint8_t { kFace, kEdge, kCorner };

  std::int32_t id = -1;              ///< Triangle, or face of the shape.
  Kind kind = Kind::kFace;           ///< Kind of part.
  Eigen::Vector3d p_W{0, 0, 0};      ///< Closest point.
  Eigen::Vector3d n_W{0, 0, 0};      ///< Unit vector from there to the centre of the ball.
  Eigen::Vector3d along_W{0, 0, 0};  ///< Unit direction of an edge.
  double gap = 0;                    ///< Distance of the ball from the part; negative inside.

  /// Returns the derivative of the closest point with respect to the centre.
  Eigen::Matrix3d slide() const noexcept {
    switch (kind) {
      case Kind::kFace:
        return Eigen::Matrix3d::Identity() - n_W * n_W.transpose();
      case Kind::kEdge:
        return along_W * along_W.transpose();
      case Kind::kCorner:
        break;
    }
    return Eigen::Matrix3d::Zero();
  }

  /// Returns the derivative of `n_W` with respect to the centre, times the distance from the part.
  Eigen::Matrix3d bend() const noexcept {
    if (kind == Kind::kFace) return Eigen::Matrix3d::Zero();
    return Eigen::Matrix3d::Identity() - n_W * n_W.transpose() - slide();
  }
};

}  // namespace thimble::render
