#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>

namespace thimble::render {

/// The part of a surface that is closest to the centre of a ball, for one triangle or one convex
/// shape. W, m.
struct BallFeature {
  /// Kind of part, by the directions in which it bends away from the ball.
  enum class Kind : std::uint8_t { kFace, kEdge, kCorner, kRound };

  std::int32_t id = -1;              ///< Triangle, or face of the shape.
  Kind kind = Kind::kFace;           ///< Kind of part.
  Eigen::Vector3d p_W{0, 0, 0};      ///< Closest point.
  Eigen::Vector3d n_W{0, 0, 0};      ///< Unit vector from there to the centre of the ball.
  Eigen::Vector3d along_W{0, 0, 0};  ///< Unit direction of an edge, or around a round part's axis.
  /// Of a round part: how far its normal turns on a path of the centre along `along_W`, and across
  /// it; 0 of a flat part, 1 of a corner.
  double bend_along = 0, bend_across = 0;
  double gap = 0;  ///< Distance of the ball from the part; negative inside.

  /// Returns the derivative of the closest point with respect to the centre.
  Eigen::Matrix3d slide() const noexcept {
    switch (kind) {
      case Kind::kFace:
        return Eigen::Matrix3d::Identity() - n_W * n_W.transpose();
      case Kind::kEdge:
        return along_W * along_W.transpose();
      case Kind::kCorner:
        break;
      case Kind::kRound: {
        const Eigen::Vector3d across = n_W.cross(along_W);
        return (1 - bend_along) * along_W * along_W.transpose() +
               (1 - bend_across) * across * across.transpose();
      }
    }
    return Eigen::Matrix3d::Zero();
  }

  /// Returns the largest of the part's bends over all directions.
  double bend_max() const noexcept {
    if (kind == Kind::kRound) return bend_along > bend_across ? bend_along : bend_across;
    return kind == Kind::kFace ? 0 : 1;
  }

  /// Returns the derivative of `n_W` with respect to the centre, times the distance from the part.
  Eigen::Matrix3d bend() const noexcept {
    if (kind == Kind::kFace) return Eigen::Matrix3d::Zero();
    return Eigen::Matrix3d::Identity() - n_W * n_W.transpose() - slide();
  }
};

}  // namespace thimble::render
