#include "body/dent/patch_drawing.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "mesh/surface_weights.h"
#include "mesh/vertex_normals.h"

namespace thimble::render {
namespace {

// Marks a point for which there was no capacity.
constexpr std::uint16_t kNone = 0xffff;

// Minimum share of each triangle's area, seen along its first normal: well above rounding.
constexpr double kAreaLeft = 0.02;

}  // namespace

PatchDrawing::PatchDrawing(std::shared_ptr<const ContactMesh> mesh) : mesh_(std::move(mesh)) {
  const auto vertices = static_cast<std::size_t>(mesh_->vertex_count());
  normals_.resize(vertices);
  vertices_.resize(vertices);
  triangles_.assign(static_cast<std::size_t>(mesh_->triangle_count()), 0);
  for (std::int32_t v = 0; v < mesh_->vertex_count(); ++v) find_normal(v);
  points_.reserve(BodyPatch::kPointsMax);
  drawn_.reserve(BodyPatch::kTrianglesMax);
  source_.reserve(BodyPatch::kTrianglesMax);
}

void PatchDrawing::find_normal(std::int32_t vertex) noexcept {
  Eigen::Vector3d sum(0, 0, 0);
  for (const std::int32_t t : mesh_->fan(vertex)) {
    const auto& c = mesh_->corners(t);
    const auto k = static_cast<std::size_t>(std::find(c.begin(), c.end(), vertex) - c.begin());
    const Eigen::Vector3d& here = mesh_->position(vertex);
    sum += corner_angle(mesh_->position(c[(k + 1) % 3]) - here,
                        mesh_->position(c[(k + 2) % 3]) - here) *
           mesh_->cell(t).face.n;
  }
  normals_[static_cast<std::size_t>(vertex)] = sum.stableNormalized();
}

void PatchDrawing::begin() noexcept {
  ++round_;
  points_.clear();
  drawn_.clear();
  source_.clear();
  complete_ = true;
}

std::uint16_t PatchDrawing::add_point(const Point& point) noexcept {
  if (points_.size() == BodyPatch::kPointsMax) {
    complete_ = false;
    return kNone;
  }
  points_.push_back(point);
  return static_cast<std::uint16_t>(points_.size() - 1);
}

std::uint16_t PatchDrawing::corner(std::int32_t vertex, const DentMotion& motion) noexcept {
  Seen& seen = vertices_[static_cast<std::size_t>(vertex)];
  if (seen.round == round_) return seen.point;
  Point point;
  point.p = mesh_->position(vertex);
  point.u = motion.u(vertex);
  point.n = normal(vertex);
  point.vertex = vertex;
  point.moves = motion.moves(vertex);
  seen = {round_, add_point(point)};
  return seen.point;
}

void PatchDrawing::add_triangle(std::uint16_t a, std::uint16_t b, std::uint16_t c,
                                std::int32_t source) noexcept {
  if (drawn_.size() == BodyPatch::kTrianglesMax) complete_ = false;
  if (!complete_) return;
  drawn_.push_back({a, b, c});
  source_.push_back(source);
}

bool PatchDrawing::first_time(std::int32_t triangle) noexcept {
  std::uint32_t& seen = triangles_[static_cast<std::size_t>(triangle)];
  if (seen == round_) return false;
  seen = round_;
  return true;
}

void PatchDrawing::split(std::int32_t triangle, const Eigen::Vector3d& weights,
                         const Eigen::Vector3d& u, const std::array<Split, 3>& edges,
                         const DentMotion& motion) noexcept {
  first_time(triangle);
  const auto& corners = mesh_->corners(triangle);
  std::array<std::uint16_t, 3> at{};
  Point middle;
  middle.n.setZero();
  for (std::size_t k = 0; k < 3; ++k) {
    at[k] = corner(corners[k], motion);
    middle.n += weights[static_cast<Eigen::Index>(k)] * normal(corners[k]);
  }
  middle.p = point_at(*mesh_, triangle, weights);
  middle.u = u;
  middle.moves = true;
  const std::uint16_t cursor = add_point(middle);
  for (std::size_t k = 0; k < 3; ++k) {
    const std::int32_t from = corners[k];
    const std::int32_t to = corners[(k + 1) % 3];
    const double t = edges[k].place;
    Point point;
    point.p = mesh_->position(from) + t * (mesh_->position(to) - mesh_->position(from));
    point.u = edges[k].u;
    point.n = (1 - t) * normal(from) + t * normal(to);
    point.moves = true;
    const std::uint16_t edge = add_point(point);
    add_triangle(cursor, at[k], edge, triangle);
    add_triangle(cursor, edge, at[(k + 1) % 3], triangle);
    const std::int32_t behind = mesh_->cell(triangle).neighbours[k];
    first_time(behind);
    const auto& c = mesh_->corners(behind);
    const auto j = static_cast<std::size_t>(std::find(c.begin(), c.end(), to) - c.begin());
    const std::uint16_t opposite = corner(c[(j + 2) % 3], motion);
    add_triangle(at[(k + 1) % 3], edge, opposite, behind);
    add_triangle(edge, at[k], opposite, behind);
  }
}

void PatchDrawing::add_moving(const DentMotion& motion) noexcept {
  for (const std::int32_t vertex : motion.vertices()) {
    for (const std::int32_t t : mesh_->fan(vertex)) {
      if (!first_time(t)) continue;
      const auto& c = mesh_->corners(t);
      std::array<std::uint16_t, 3> at{};  // in a fixed order, independent of the compiler
      for (std::size_t k = 3; k-- > 0;) at[k] = corner(c[k], motion);
      add_triangle(at[0], at[1], at[2], t);
      if (!complete_) return;
    }
  }
}

// Returns the share of the dent at which no triangle has lost its area.
double PatchDrawing::share() const noexcept {
  double share = 1;
  for (const auto& [a, b, c] : drawn_) {
    const Point& o = points_[a];
    const Eigen::Vector3d e1 = points_[b].p - o.p;
    const Eigen::Vector3d e2 = points_[c].p - o.p;
    const Eigen::Vector3d d1 = points_[b].u - o.u;
    const Eigen::Vector3d d2 = points_[c].u - o.u;
    const Eigen::Vector3d normal = e1.cross(e2);
    // Area, along the first normal and times its own length: first + s linear + s^2 square.
    const double first = (1 - kAreaLeft) * normal.squaredNorm();
    const double linear = normal.dot(d1.cross(e2) + e1.cross(d2));
    const double square = normal.dot(d1.cross(d2));
    if (first + share * (std::min(linear, 0.0) + share * std::min(square, 0.0)) > 0) continue;
    // The least positive root, in the form that loses no digits.
    const double root = linear * linear - 4 * square * first;
    if (root < 0) continue;
    const double below = -linear + std::sqrt(root);
    if (below > 0) share = std::min(share, 2 * first / below);
  }
  return share;
}

void PatchDrawing::turn_normals(double share) noexcept {
  for (Point& point : points_) {
    point.u *= share;
    point.turn.setZero();
    point.area = 0;
  }
  for (const auto& corners : drawn_) {
    const Point& a = points_[corners[0]];
    const Point& b = points_[corners[1]];
    const Point& c = points_[corners[2]];
    const Eigen::Vector3d first = (b.p - a.p).cross(c.p - a.p);
    const Eigen::Vector3d now = (b.p + b.u - a.p - a.u).cross(c.p + c.u - a.p - a.u);
    for (const std::uint16_t k : corners) {
      points_[k].turn += now - first;
      points_[k].area += first.norm();
    }
  }
}

void PatchDrawing::finish(BodyPatch& patch) noexcept {
  patch.complete = complete_;
  patch.point_count = 0;
  patch.triangle_count = 0;
  patch.object = -1;
  patch.share = 1;
  if (!complete_) return;
  const double drawn = share();
  turn_normals(drawn);
  patch.share = static_cast<float>(drawn);
  for (const Point& point : points_) {
    Eigen::Vector3d n = point.n;
    // The border keeps its normals, because triangles next to the patch share them.
    if (point.moves && point.area > 0) n += point.turn / point.area;
    const Eigen::Vector3d p = point.p + point.u;
    const Eigen::Vector3f n_float = n.cast<float>();
    BodyPatch::Point& to = patch.points[patch.point_count++];
    to = {{p.x(), p.y(), p.z()}, {n_float.x(), n_float.y(), n_float.z()}, point.vertex};
  }
  for (std::size_t i = 0; i < drawn_.size(); ++i) {
    patch.triangles[i] = drawn_[i];
    patch.source[i] = source_[i];
  }
  patch.triangle_count = static_cast<std::uint16_t>(drawn_.size());
  if (!drawn_.empty()) patch.object = 0;
}

}  // namespace thimble::render
