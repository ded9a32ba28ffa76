#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

namespace thimble::render {

/// Tests which cubes of one size a triangle reaches into: by its plane and, seen along each axis,
/// by its edges [Schwarz]. The caller tests the box of the triangle. Never returns false where a
/// triangle grown by `room` on every side reaches in, rounding included.
class VolumeOverlap {
 public:
  VolumeOverlap(const std::array<Eigen::Vector3d, 3>& corners, double side, double room) noexcept {
    const Eigen::Vector3d n = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    const double half = side / 2 + room;
    normal_ = n;
    // Tests the cube's middle, so that one number holds its reach in any direction.
    plane_ = n.dot(corners[0]);
    const double size = (corners[1] - corners[0]).cwiseAbs().maxCoeff() +
                        (corners[2] - corners[0]).cwiseAbs().maxCoeff();
    reach_ = half * n.cwiseAbs().sum() + kRounding * size * size * (size + kPlaces * side);
    for (int axis = 0; axis < 3; ++axis) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      const double turn = n[axis] < 0 ? -1 : 1;
      for (std::size_t k = 0; k < 3; ++k) {
        const Eigen::Vector3d& a = corners[k];
        const Eigen::Vector3d edge = corners[(k + 1) % 3] - a;
        Edge& e = edges_[static_cast<std::size_t>(axis)][k];
        // Points to the inside of the triangle as seen along the axis.
        e.u = -turn * edge[v];
        e.v = turn * edge[u];
        e.min = e.u * a[u] + e.v * a[v] - half * (std::abs(e.u) + std::abs(e.v)) -
                kRounding * size * (size + kPlaces * side);
      }
    }
  }

  bool reaches(const Eigen::Vector3d& middle) const noexcept {
    if (!(std::abs(normal_.dot(middle) - plane_) <= reach_)) return false;
    for (int axis = 0; axis < 3; ++axis) {
      const double u = middle[(axis + 1) % 3], v = middle[(axis + 2) % 3];
      for (const Edge& e : edges_[static_cast<std::size_t>(axis)]) {
        if (!(e.u * u + e.v * v >= e.min)) return false;
      }
    }
    return true;
  }

 private:
  // Coordinates are at most 2^12 volumes; products of few factors are wrong by less than 2^-48.
  static constexpr double kRounding = 0x1p-48;
  static constexpr double kPlaces = 0x1p13;
  struct Edge {
    double u = 0, v = 0, min = 0;
  };
  Eigen::Vector3d normal_;
  double plane_ = 0, reach_ = 0;
  std::array<std::array<Edge, 3>, 3> edges_;
};

}  // namespace thimble::render
