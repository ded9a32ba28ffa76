#include "thimble/render/contact/smooth_normals.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "contact/fitted_normal.h"
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
  if (weights != NormalWeights::kRound) return corner_angle(to_next, to_last);
  return to_next.cross(to_last).norm() / (to_next.squaredNorm() * to_last.squaredNorm());
}

// The vertices of the triangles of a smooth group, and of those behind them.
std::vector<Vector3d> points_around(const ContactMesh& mesh, const SmoothNormals& normals,
                                    const std::vector<Corner>& group) {
  std::vector<std::int32_t> vertices;
  const std::int32_t centre = mesh.corners(group.front().triangle)[group.front().k];
  const auto add = [&](std::int32_t vertex) {
    if (vertex == centre) return;
    if (std::find(vertices.begin(), vertices.end(), vertex) == vertices.end()) {
      vertices.push_back(vertex);
    }
  };
  for (const Corner& at : group) {
    const auto& corners = mesh.corners(at.triangle);
    const std::size_t opposite = (at.k + 1) % 3;
    add(corners[opposite]);
    add(corners[(at.k + 2) % 3]);
    if (normals.crease(at.triangle, opposite)) continue;
    for (const std::int32_t vertex : mesh.corners(mesh.cell(at.triangle).neighbours[opposite])) {
      add(vertex);
    }
  }
  std::vector<Vector3d> points;
  points.reserve(vertices.size());
  for (const std::int32_t vertex : vertices) points.push_back(mesh.position(vertex));
  return points;
}

// Tells whether a normal stands well above every face of a group. A triangle lowered along corner
// normals that lean more than this away from it soon folds over (offset_tracker.h).
bool faces_all(const ContactMesh& mesh, const std::vector<Corner>& group, const Vector3d& normal) {
  return std::all_of(group.begin(), group.end(), [&](const Corner& at) {
    return mesh.cell(at.triangle).face.n.dot(normal) > 0.5;
  });
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
  Vector3d normal = sum / length;
  if (weights == NormalWeights::kFitted && length > 0) {
    const Vector3d fitted =
        fitted_normal(mesh.position(triangle, k), points_around(mesh, *this, group), normal);
    if (faces_all(mesh, group, fitted)) normal = fitted;
  }
  for (const Corner& at : group) {
    const auto t = static_cast<std::size_t>(at.triangle);
    // Faces that cancel out (a spike of no width, all smooth) have no mean: each keeps its own.
    corners_[t][at.k] = length > 0 ? normal : mesh.cell(at.triangle).face.n;
    done[3 * t + at.k] = true;
  }
}

}  // namespace thimble::render
