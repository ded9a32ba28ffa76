#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <memory>
#include <utility>

#include "body/dent/bendable_polygon.h"
#include "mesh/surface_weights.h"
#include "support/meshes/shapes.h"
#include "support/random.h"

namespace thimble::support {

/// Returns a dent over a mesh of its own.
inline render::BendablePolygon dent_in(const render::TriangleMesh& mesh,
                                       const render::DentSettings& settings = {}) {
  auto contact =
      std::make_shared<const render::ContactMesh>(render::ContactMesh::build(mesh).value());
  return render::BendablePolygon::build(std::move(contact), settings).value();
}

/// Returns random weights of a place on a triangle: anywhere, or in half of the cases near an edge
/// or a corner.
inline Eigen::Vector3d any_weights(Random& random) {
  Eigen::Vector3d w{random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1)};
  const auto k = static_cast<Eigen::Index>(random.bits() % 3);
  const std::uint64_t where = random.bits() % 4;
  if (where == 0) w[k] *= 1e-4;
  if (where == 1) w[(k + 1) % 3] = w[(k + 2) % 3] = 1e-4 * w[k];
  return w / w.sum();
}

/// Puts the cursor `depth` (m) below a place of a triangle, along its normal.
inline void press(render::BendablePolygon& dent, std::int32_t triangle, const Eigen::Vector3d& w,
                  double depth) {
  const auto& mesh = dent.mesh();
  dent.touch(triangle, w, render::point_at(mesh, triangle, w) - depth * mesh.cell(triangle).face.n);
}

/// Presses until the motion has stopped.
inline void settle(render::BendablePolygon& dent, std::int32_t triangle, const Eigen::Vector3d& w,
                   double depth) {
  for (int i = 0; i < 120; ++i) press(dent, triangle, w, depth);
}

}  // namespace thimble::support
