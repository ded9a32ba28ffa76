#include "mesh/smooth_normals.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "math/elementary.h"
#include "mesh/fitted_normal.h"
#include "mesh/vertex_normals.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

double weight_of(const ContactMesh& mesh, NormalWeights weights, std::int32_t triangle,
                 std::size_t k) noexcept {
  const Vector3d& p = mesh.position(triangle, k);
  const Vector3d to_next = mesh.position(triangle, (k + 1) % 3) - p;
  const Vector3d to_last = mesh.position(triangle, (k + 2) % 3) - p;
  if (weights != NormalWeights::kRound) return corner_angle(to_next, to_last);
  return to_next.cross(to_last).norm() / (to_next.squaredNorm() * to_last.squaredNorm());
}

}  // namespace

SmoothNormals::SmoothNormals(const ContactMesh& mesh, double crease_angle, NormalWeights weights,
                             double concave_crease_angle)
    : crease_angle_(crease_angle),
      crease_cosine_(math::cos(crease_angle)),
      concave_crease_angle_(std::min(crease_angle, concave_crease_angle)),
      weights_(weights) {
  const auto count = static_cast<std::size_t>(mesh.triangle_count());
  corners_.resize(count);
  creases_.assign(count, 0);
  for (std::int32_t t = 0; t < mesh.triangle_count(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) find_crease(mesh, t, k);
  }
  Group group;
  group.taken.assign(static_cast<std::size_t>(mesh.vertex_count()), 0);
  done_.assign(3 * count, false);
  for (std::int32_t t = 0; t < mesh.triangle_count(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (!done_[3 * static_cast<std::size_t>(t) + k]) average_group(mesh, {t, k}, group);
    }
  }
  done_ = {};
}

// Returns the corner at the same vertex behind edge `edge` of the triangle.
auto SmoothNormals::across(const ContactMesh& mesh, const Corner& at, std::size_t edge) noexcept
    -> Corner {
  const std::int32_t vertex = mesh.corners(at.triangle)[at.k];
  const std::int32_t next = mesh.cell(at.triangle).neighbours[edge];
  std::size_t k = 0;
  while (k < 2 && mesh.corners(next)[k] != vertex) ++k;
  return {next, k};
}

void SmoothNormals::find_crease(const ContactMesh& mesh, std::int32_t triangle,
                                std::size_t k) noexcept {
  const TriangleCell& cell = mesh.cell(triangle);
  const Vector3d& n = cell.face.n;
  const Vector3d& behind = mesh.cell(cell.neighbours[k]).face.n;
  // The cosine is wrong by some 2^-53: if it is clear of the limit, it decides.
  constexpr double kClear = 1e-12;
  const double cosine = n.dot(behind);
  const bool concave = mesh.concave_edge(triangle, k);
  const double limit = concave ? concave_crease_angle_ : crease_angle_;
  const double limit_cosine = concave ? math::cos(concave_crease_angle_) : crease_cosine_;
  const bool clear = std::abs(cosine - limit_cosine) > kClear;
  const bool sharp = clear ? cosine < limit_cosine : corner_angle(n, behind) > limit;
  const auto bit = static_cast<std::uint8_t>(1U << k);
  std::uint8_t& creases = creases_[static_cast<std::size_t>(triangle)];
  creases = static_cast<std::uint8_t>(sharp ? creases | bit : creases & ~bit);
}

// Collects the vertices of the triangles of a smooth group, and of those behind them.
void SmoothNormals::collect_points(const ContactMesh& mesh, Group& group) const noexcept {
  std::vector<std::int32_t>& vertices = group.vertices;
  vertices.clear();
  const Corner& first = group.corners.front();
  const std::int32_t centre = mesh.corners(first.triangle)[first.k];
  if (++group.collected == 0) {
    std::fill(group.taken.begin(), group.taken.end(), 0);
    group.collected = 1;
  }
  const auto add = [&](std::int32_t vertex) {
    std::uint32_t& taken = group.taken[static_cast<std::size_t>(vertex)];
    if (vertex == centre || taken == group.collected) return;
    taken = group.collected;
    vertices.push_back(vertex);
  };
  for (const Corner& at : group.corners) {
    const auto& corners = mesh.corners(at.triangle);
    const std::size_t opposite = (at.k + 1) % 3;
    add(corners[opposite]);
    add(corners[(at.k + 2) % 3]);
    if (crease(at.triangle, opposite)) continue;
    for (const std::int32_t vertex : mesh.corners(mesh.cell(at.triangle).neighbours[opposite])) {
      add(vertex);
    }
  }
  group.points.clear();
  for (const std::int32_t vertex : vertices) group.points.push_back(mesh.position(vertex));
}

void SmoothNormals::average_group(const ContactMesh& mesh, const Corner& start,
                                  Group& group) noexcept {
  // Clockwise to the group's first corner, or once around a vertex without creases.
  Corner first = start;
  while (!crease(first.triangle, first.k)) {
    const Corner before = across(mesh, first, first.k);
    if (before == start) break;
    first = before;
  }
  group.corners.clear();
  Vector3d sum = Vector3d::Zero();
  for (Corner at = first;;) {
    group.corners.push_back(at);
    sum += weight_of(mesh, weights_, at.triangle, at.k) * mesh.cell(at.triangle).face.n;
    const std::size_t last_edge = (at.k + 2) % 3;
    if (crease(at.triangle, last_edge)) break;
    at = across(mesh, at, last_edge);
    if (at == first) break;
  }
  const double length = sum.norm();
  Vector3d normal = sum / length;
  if (weights_ == NormalWeights::kFitted && length > 0) {
    collect_points(mesh, group);
    const Vector3d fitted =
        fitted_normal(mesh.position(start.triangle, start.k), group.points, normal);
    // A triangle sunk along corner normals that lean more than this away from it soon turns over
    // (offset_tracker.h).
    const bool faces_all = std::all_of(
        group.corners.begin(), group.corners.end(),
        [&](const Corner& at) { return mesh.cell(at.triangle).face.n.dot(fitted) > 0.5; });
    if (faces_all) normal = fitted;
  }
  for (const Corner& at : group.corners) {
    const auto t = static_cast<std::size_t>(at.triangle);
    // Faces that cancel out (a spike of no width, all smooth) have no mean: each keeps its own
    // normal.
    corners_[t][at.k] = length > 0 ? normal : mesh.cell(at.triangle).face.n;
    done_[3 * t + at.k] = true;
  }
}

void SmoothNormals::prepare_refit(const ContactMesh& mesh) {
  corners_.reserve(mesh.triangles_max());
  creases_.reserve(mesh.triangles_max());
  done_.reserve(3 * mesh.triangles_max());
  seen_.reserve(mesh.vertices_max());
  group_.taken.reserve(mesh.vertices_max());
  done_.assign(3 * corners_.size(), false);
  seen_.assign(static_cast<std::size_t>(mesh.vertex_count()), 0);
  const bool grows = mesh.triangles_max() > corners_.size();
  std::size_t valence = grows ? ContactMesh::kValenceMax : 0;
  for (std::int32_t v = 0; v < mesh.vertex_count(); ++v) {
    valence = std::max(valence, mesh.fan(v).size());
  }
  // A group is at most a fan. A fan has one vertex around it per triangle (two if it is open), and
  // one more behind each.
  group_.corners.reserve(valence);
  group_.vertices.reserve(3 * valence);
  group_.points.reserve(3 * valence);
  group_.taken.assign(static_cast<std::size_t>(mesh.vertex_count()), 0);
}

void SmoothNormals::refit(const ContactMesh& mesh,
                          std::span<const std::int32_t> triangles) noexcept {
  // New triangles: prepare_refit has reserved memory.
  const auto count = static_cast<std::size_t>(mesh.triangle_count());
  corners_.resize(count);
  creases_.resize(count, 0);
  done_.resize(3 * count, false);
  seen_.resize(static_cast<std::size_t>(mesh.vertex_count()), 0);
  group_.taken.resize(static_cast<std::size_t>(mesh.vertex_count()), 0);
  for (const std::int32_t t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      find_crease(mesh, t, k);
      // The other side of the edge: it begins where this one ends.
      const Corner behind = across(mesh, {t, (k + 1) % 3}, k);
      find_crease(mesh, behind.triangle, behind.k);
    }
  }
  if (++refits_ == 0) {
    std::fill(seen_.begin(), seen_.end(), 0);
    refits_ = 1;
  }
  // A normal depends on the faces around its vertex, a fitted one also on the vertices behind them.
  for (const std::int32_t t : triangles) {
    for (const std::int32_t vertex : mesh.corners(t)) refit_vertex(mesh, vertex);
    if (weights_ != NormalWeights::kFitted) continue;
    for (const std::int32_t behind : mesh.cell(t).neighbours) {
      for (const std::int32_t vertex : mesh.corners(behind)) refit_vertex(mesh, vertex);
    }
  }
}

void SmoothNormals::refit_vertex(const ContactMesh& mesh, std::int32_t vertex) noexcept {
  std::uint32_t& seen = seen_[static_cast<std::size_t>(vertex)];
  if (seen == refits_) return;
  seen = refits_;
  const auto corner_at = [&](std::int32_t t) noexcept {
    return Corner{t, mesh.corners(t)[0] == vertex ? 0u : mesh.corners(t)[1] == vertex ? 1u : 2u};
  };
  const auto done = [this](const Corner& at) {
    return done_[3 * static_cast<std::size_t>(at.triangle) + at.k];
  };
  for (const std::int32_t t : mesh.fan(vertex)) done(corner_at(t)) = false;
  // In the same order as when a mesh is built.
  for (const std::int32_t t : mesh.fan(vertex)) {
    const Corner at = corner_at(t);
    if (!done(at)) average_group(mesh, at, group_);
  }
}

}  // namespace thimble::render
