#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "mesh/contact_mesh.h"

namespace thimble::studies {

/// A straight walk on the surface of a mesh. It keeps its angle with each edge that it crosses, as
/// on the two triangles unfolded into a plane, so that the path itself adds no rotation.
class StraightWalk {
 public:
  /// Begins in the middle of a triangle, in the direction in its plane nearest to `direction_W`.
  /// Precondition: `direction_W` is not along the triangle's normal.
  StraightWalk(const render::ContactMesh& mesh, std::int32_t triangle,
               const Eigen::Vector3d& direction_W);

  /// Advances by `length` (m, > 0). A walk exactly through a vertex continues in one of its
  /// triangles.
  void advance(double length) noexcept;

  std::int32_t triangle() const noexcept { return triangle_; }  ///< Returns the current triangle.
  /// Returns the weights of the triangle's corners at the current point, at least 0, sum 1.
  Eigen::Vector3d weights() const noexcept;

 private:
  const render::ContactMesh& mesh_;
  std::int32_t triangle_;
  Eigen::Vector3d p_W_;
  Eigen::Vector3d d_W_;
};

}  // namespace thimble::studies
