#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "mesh/contact_mesh.h"

namespace thimble::studies {

/// A walk straight ahead on the surface of a mesh: over an edge it keeps its angle with it, as on
/// both triangles laid flat side by side, so that nothing but what is looked at on the way can
/// turn.
class StraightWalk {
 public:
  /// Begins in the middle of a triangle, towards what is nearest to `direction_W` in its plane.
  /// Precondition: `direction_W` is not along the triangle's normal.
  StraightWalk(const render::ContactMesh& mesh, std::int32_t triangle,
               const Eigen::Vector3d& direction_W);

  /// Goes on by `length` (m, > 0). A walk right through a vertex goes on in one of its triangles.
  void advance(double length) noexcept;

  std::int32_t triangle() const noexcept { return triangle_; }  ///< Returns where it is.
  /// Returns the weights of the triangle's corners there, at least 0, sum 1.
  Eigen::Vector3d weights() const noexcept;

 private:
  const render::ContactMesh& mesh_;
  std::int32_t triangle_;
  Eigen::Vector3d p_W_;
  Eigen::Vector3d d_W_;
};

}  // namespace thimble::studies
