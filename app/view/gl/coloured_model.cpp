#include "view/gl/coloured_model.h"

#include <Eigen/Geometry>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

namespace thimble::view {
namespace {

constexpr std::uint32_t kTubeSides = 6;

using Point = Eigen::Vector3d;

Eigen::Vector3f as_vertex(const Colour& colour) {
  return {colour[0], colour[1], colour[2]};
}

/// Returns two unit vectors perpendicular to `along` and to each other.
std::pair<Point, Point> across(const Point& along) {
  const Point u = along.unitOrthogonal();
  return {u, along.cross(u)};
}

/// Adds a ring of vertices; `tilt` turns the normals towards `along`, for a cone.
void add_tube_ring(const Point& centre, const std::pair<Point, Point>& axes, double radius,
                   const Point& tilt, const Colour& colour, ColouredMesh& mesh) {
  for (std::uint32_t k = 0; k < kTubeSides; ++k) {
    const double turn = 2 * std::numbers::pi * k / kTubeSides;
    const Point out = std::cos(turn) * axes.first + std::sin(turn) * axes.second;
    mesh.vertices.push_back({(centre + radius * out).cast<float>(),
                             (out + tilt).normalized().cast<float>(), as_vertex(colour)});
  }
}

/// Joins the last two rings by triangles.
void join_tube_rings(ColouredMesh& mesh) {
  const auto end = static_cast<std::uint32_t>(mesh.vertices.size());
  const std::uint32_t a = end - 2 * kTubeSides;
  const std::uint32_t b = end - kTubeSides;
  for (std::uint32_t k = 0; k < kTubeSides; ++k) {
    const std::uint32_t next = (k + 1) % kTubeSides;
    mesh.triangles.push_back({a + k, a + next, b + k});
    mesh.triangles.push_back({a + next, b + next, b + k});
  }
}

}  // namespace

void add_arrow(const Point& from, const Point& to, double radius, const Colour& colour,
               ColouredMesh& mesh) {
  const double length = (to - from).norm();
  if (!(length > 1e-9)) return;
  const Point along = (to - from) / length;
  const auto axes = across(along);
  const double head = std::min(6 * radius, 0.5 * length);
  const Point neck = to - head * along;
  add_tube_ring(from, axes, radius, Point::Zero(), colour, mesh);
  add_tube_ring(neck, axes, radius, Point::Zero(), colour, mesh);
  join_tube_rings(mesh);
  const Point tilt = 2.6 * radius / head * along;
  add_tube_ring(neck, axes, 2.6 * radius, tilt, colour, mesh);
  add_tube_ring(to, axes, 0, tilt, colour, mesh);
  join_tube_rings(mesh);
}

void add_tube(std::span<const Point> points, std::span<const Colour> colours, double radius,
              ColouredMesh& mesh) {
  std::pair<Point, Point> axes;
  bool begun = false;
  Point last(0, 0, 0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point& p = points[i];
    const Point next = i + 1 < points.size() ? points[i + 1] : p;
    const Point way = next - (begun ? last : p);
    if (begun && !((p - last).norm() > 1e-9)) continue;
    if (way.norm() > 1e-9) {
      // Rotates the ring with the path only; otherwise the tube would be twisted.
      const Point along = way.normalized();
      Point u = begun ? Point(axes.first - axes.first.dot(along) * along) : along.unitOrthogonal();
      if (!(u.norm() > 1e-3)) u = along.unitOrthogonal();
      u.normalize();
      axes = {u, along.cross(u)};
    } else if (!begun) {
      continue;
    }
    add_tube_ring(p, axes, radius, Point::Zero(), colours[i], mesh);
    if (begun) join_tube_rings(mesh);
    begun = true;
    last = p;
  }
}

ColouredModel::ColouredModel() {
  glBindVertexArray(*array_);
  glBindBuffer(GL_ARRAY_BUFFER, *vertices_);
  for (GLuint place = 0; place < 3; ++place) {
    glEnableVertexAttribArray(place);
    const std::size_t at = place * sizeof(Eigen::Vector3f);
    glVertexAttribPointer(place, 3, GL_FLOAT, GL_FALSE, sizeof(ColouredVertex),
                          reinterpret_cast<const void*>(at));  // NOLINT: OpenGL takes offsets so
  }
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, *indices_);
  glBindVertexArray(0);
}

void ColouredModel::set(const ColouredMesh& mesh) {
  const auto fill = [](const GlBuffer& buffer, const auto& data) {
    glBindBuffer(GL_ARRAY_BUFFER, *buffer);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(data.size() * sizeof(data[0])),
                 data.data(), GL_STREAM_DRAW);
  };
  glBindVertexArray(0);
  fill(vertices_, mesh.vertices);
  fill(indices_, mesh.triangles);
  indices_count_ = static_cast<GLsizei>(3 * mesh.triangles.size());
}

void ColouredModel::draw() const {
  if (indices_count_ == 0) return;
  glBindVertexArray(*array_);
  glDrawElements(GL_TRIANGLES, indices_count_, GL_UNSIGNED_INT, nullptr);
}

}  // namespace thimble::view
