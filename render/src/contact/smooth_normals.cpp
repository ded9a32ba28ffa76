#include "thimble/render/contact/smooth_normals.h"

#include <Eigen/Geometry>

#include "thimble/render/mesh/vertex_normals.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

// Is a corner of a triangle: one place in the fan of its vertex.
struct Corner {
  std::int32_t triangle;
  std::size_t k;

  bool operator==(const Corner&) const = default;
};

// The corner at the same vertex behind edge `edge` of the triangle.
Corner across(const ContactMesh& mesh, const Corner& at, std::size_t edge) {
  const std::int32_t vertex = mesh.corners(at.triangle)[at.k];
  const std::int32_t next = mesh.cell(at.triangle).neighbours[edge];
  std::size_t k = 0;
  while (mesh.corners(next)[k] != vertex) ++k;
  return {next, k};
}

double weight_of(const ContactMesh& mesh, NormalWeights weights, const Corner& at) {
  const Vector3d& p = mesh.position(at.triangle, at.k);
  const Vector3d to_next = mesh.position(at.triangle, (at.k + 1) % 3) - p;
  const Vector3d to_last = mesh.position(at.triangle, (at.k + 2) % 3) - p;
  if (weights == NormalWeights::kAngle) return corner_angle(to_next, to_last);
  return to_next.cross(to_last).norm() / (to_next.squaredNorm() * to_last.squaredNorm());
}

}  // namespace

SmoothNormals::SmoothNormals(const ContactMesh& mesh, double crease_angle, NormalWeights weights) {
  const auto count = static_cast<std::size_t>(mesh.triangle_count());
  corners_.resize(count);
  creases_.assign(count, 0);
  for (std::int32_t t = 0; t < mesh.triangle_count(); ++t) {
    const TriangleCell& cell = mesh.cell(t);
    for (std::size_t k = 0; k < 3; ++k) {
      const double angle = corner_angle(cell.face.n, mesh.cell(cell.neighbours[k]).face.n);
      if (angle > crease_angle) {
        creases_[static_cast<std::size_t>(t)] |= static_cast<std::uint8_t>(1U << k);
      }
    }
  }
  std::vector<bool> done(3 * count);
  for (std::int32_t t = 0; t < mesh.triangle_count(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (!done[3 * static_cast<std::size_t>(t) + k]) average_group(mesh, weights, t, k, done);
    }
  }
}

void SmoothNormals::average_group(const ContactMesh& mesh, NormalWeights weights,
                                  std::int32_t triangle, std::size_t k, std::vector<bool>& done) {
  // Clockwise to the group's first corner, or once around a vertex without creases.
  const Corner start{triangle, k};
  Corner first = start;
  while (!crease(first.triangle, first.k)) {
    const Corner before = across(mesh, first, first.k);
    if (before == start) break;
    first = before;
  }
  std::vector<Corner> group;
  Vector3d sum = Vector3d::Zero();
  for (Corner at = first;;) {
    group.push_back(at);
    sum += weight_of(mesh, weights, at) * mesh.cell(at.triangle).face.n;
    const std::size_t last_edge = (at.k + 2) % 3;
    if (crease(at.triangle, last_edge)) break;
    at = across(mesh, at, last_edge);
    if (at == first) break;
  }
  const double length = sum.norm();
  for (const Corner& at : group) {
    const auto t = static_cast<std::size_t>(at.triangle);
    // Faces that cancel out (a spike of no width, all smooth) have no mean: each keeps its own.
    corners_[t][at.k] = length > 0 ? Vector3d(sum / length) : mesh.cell(at.triangle).face.n;
    done[3 * t + at.k] = true;
  }
}

}  // namespace thimble::render
