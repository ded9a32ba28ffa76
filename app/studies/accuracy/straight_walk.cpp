#include "studies/accuracy/straight_walk.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "mesh/surface_weights.h"

namespace thimble::studies {
namespace {

constexpr int kEdgesMax = 10000;  // per advance; only steps of metres cross more

/// An edge seen from a triangle: its start, its direction, and the direction into the triangle.
struct SeenEdge {
  Eigen::Vector3d from, along, inwards;
};

SeenEdge edge_of(const render::ContactMesh& mesh, std::int32_t triangle, std::size_t k) {
  const Eigen::Vector3d& from = mesh.position(triangle, k);
  const Eigen::Vector3d along = (mesh.position(triangle, (k + 1) % 3) - from).normalized();
  return {from, along, mesh.cell(triangle).face.n.cross(along)};
}

}  // namespace

StraightWalk::StraightWalk(const render::ContactMesh& mesh, std::int32_t triangle,
                           const Eigen::Vector3d& direction_W)
    : mesh_(mesh), triangle_(triangle) {
  p_W_ = render::point_at(mesh, triangle, Eigen::Vector3d::Constant(1.0 / 3));
  const Eigen::Vector3d& n = mesh.cell(triangle).face.n;
  d_W_ = (direction_W - direction_W.dot(n) * n).normalized();
}

void StraightWalk::advance(double length) noexcept {
  for (int edges = 0; edges < kEdgesMax; ++edges) {
    double nearest = std::numeric_limits<double>::infinity();
    std::size_t out = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const SeenEdge edge = edge_of(mesh_, triangle_, k);
      const double closing = -d_W_.dot(edge.inwards);
      if (!(closing > 0)) continue;
      const double way = std::max((p_W_ - edge.from).dot(edge.inwards), 0.0) / closing;
      if (way < nearest) {
        nearest = way;
        out = k;
      }
    }
    if (!(nearest < length)) {
      p_W_ += length * d_W_;
      return;
    }
    length -= nearest;
    p_W_ += nearest * d_W_;
    const SeenEdge left = edge_of(mesh_, triangle_, out);
    triangle_ = mesh_.cell(triangle_).neighbours[out];
    // The neighbour's normal gives its own inward direction at the same edge.
    const Eigen::Vector3d inwards = mesh_.cell(triangle_).face.n.cross(-left.along);
    d_W_ = (d_W_.dot(left.along) * left.along - d_W_.dot(left.inwards) * inwards).normalized();
  }
}

Eigen::Vector3d StraightWalk::weights() const noexcept {
  return render::within_triangle(render::projected_weights(mesh_, triangle_, p_W_));
}

}  // namespace thimble::studies
