// Meshes of shapes. They are drawn, and give the hand's path and the mass of a moving body.

#include <Eigen/Geometry>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

#include "math/elementary.h"
#include "thimble/scene/scene_file.h"

namespace thimble::scene {
namespace {

using Eigen::Vector3d;

constexpr int kAround =
    96;  // sides of a drawn round shape: its facets are within 0.03 % of the radius

/// Adds a rectangle around `middle`. It has its own vertices, so its normals are not averaged with
/// those of its neighbours.
void add_rectangle(const Vector3d& middle, const Vector3d& u, const Vector3d& v,
                   render::TriangleMesh& mesh) {
  const auto first = static_cast<std::int32_t>(mesh.vertices.size());
  for (const auto& [a, b] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
    mesh.vertices.emplace_back(middle + a * u + b * v);
  }
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

render::TriangleMesh box_mesh(const render::Box& box) {
  render::TriangleMesh mesh;
  for (std::int32_t face = 0; face < 6; ++face) {
    const Eigen::Index axis = face / 2, right = (axis + 1) % 3, up = (axis + 2) % 3;
    const Vector3d n_W = box.normal(face);
    const Vector3d v = box.half_sides[up] * box.R_WO.col(up);
    const Vector3d u = (face % 2 == 0 ? -1 : 1) * box.half_sides[right] * box.R_WO.col(right);
    add_rectangle(box.p_WO + box.half_sides[axis] * n_W, u, v, mesh);
  }
  return mesh;
}

constexpr int kRows = kAround / 2;

/// Returns the directions from a sphere's centre to its vertices between the poles, row by row.
std::vector<Vector3d> ball_directions() {
  std::vector<Vector3d> directions;
  for (int row = 1; row < kRows; ++row) {
    const double down = std::numbers::pi * row / kRows;
    for (int k = 0; k < kAround; ++k) {
      const double round = 2 * std::numbers::pi * k / kAround;
      directions.emplace_back(math::sin(down) * math::cos(round),
                              math::sin(down) * math::sin(round), math::cos(down));
    }
  }
  return directions;
}

render::TriangleMesh sphere_mesh(const render::Sphere& ball) {
  static const std::vector<Vector3d> directions = ball_directions();
  render::TriangleMesh mesh;
  mesh.vertices.emplace_back(ball.p_WO + ball.radius * Vector3d::UnitZ());
  for (const Vector3d& n : directions) mesh.vertices.emplace_back(ball.p_WO + ball.radius * n);
  mesh.vertices.emplace_back(ball.p_WO - ball.radius * Vector3d::UnitZ());
  const auto last = static_cast<std::int32_t>(mesh.vertices.size()) - 1;
  const auto at = [](int row, int k) {
    return static_cast<std::int32_t>(1 + (row - 1) * kAround + k % kAround);
  };
  for (int k = 0; k < kAround; ++k) {
    mesh.triangles.push_back({0, at(1, k), at(1, k + 1)});
    mesh.triangles.push_back({last, at(kRows - 1, k + 1), at(kRows - 1, k)});
    for (int row = 1; row + 1 < kRows; ++row) {
      mesh.triangles.push_back({at(row, k), at(row + 1, k), at(row + 1, k + 1)});
      mesh.triangles.push_back({at(row, k), at(row + 1, k + 1), at(row, k + 1)});
    }
  }
  return mesh;
}

render::TriangleMesh mesh_of(const render::Box& box, double) {
  return box_mesh(box);
}
render::TriangleMesh mesh_of(const render::Sphere& ball, double) {
  return sphere_mesh(ball);
}
render::TriangleMesh mesh_of(const render::HalfSpace& plane, double drawn_side) {
  render::TriangleMesh mesh;
  const Vector3d u = plane.n_W.unitOrthogonal();
  add_rectangle(plane.p_WO, drawn_side / 2 * u, drawn_side / 2 * plane.n_W.cross(u), mesh);
  return mesh;
}

}  // namespace

render::TriangleMesh SceneShape::mesh_W() const {
  return std::visit([this](const auto& shape) { return mesh_of(shape, drawn_side); }, shape_W);
}

}  // namespace thimble::scene
