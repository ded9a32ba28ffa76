#include "scene_shapes.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "math/elementary.h"

namespace thimble::scene {
namespace {

using Eigen::Vector3d;

constexpr double kSideMin = 1e-4, kSideMax = 2;  // m, as the size of meshes
constexpr int kAround = 96;  // sides of a drawn sphere: its facets lie within 0.03 % of the radius

/// Adds a rectangle about `middle`, with its own corners, so that its normals are its own.
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

/// Returns the directions to a ball's vertices between its poles, row by row.
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

SceneShape read_plane(YamlMap map, const Eigen::Matrix3d& R_WO, const Vector3d& p_WO) {
  Vector3d normal = map.optional_vector3("normal", Vector3d::UnitZ(), "", -1e3, 1e3);
  const double drawn = map.optional_number("drawn_side", 0.1, "m", kSideMin, kSideMax);
  if (!(normal.stableNorm() > 0)) {
    map.reject("normal", "expected a direction, found zeros");
    normal = Vector3d::UnitZ();
  }
  map.finish();
  const Vector3d n_W = R_WO * normal.stableNormalized();
  SceneShape shape{.shape_W = render::HalfSpace{.n_W = n_W, .p_WO = p_WO}, .mesh_W = {}};
  const Vector3d u = n_W.unitOrthogonal();
  add_rectangle(p_WO, drawn / 2 * u, drawn / 2 * n_W.cross(u), shape.mesh_W);
  return shape;
}

SceneShape read_sphere(YamlMap map, const Vector3d& p_WO) {
  const render::Sphere ball{.p_WO = p_WO,
                            .radius = map.require_number("radius", "m", kSideMin, kSideMax)};
  map.finish();
  return {ball, sphere_mesh(ball)};
}

SceneShape read_box(YamlMap map, const Eigen::Matrix3d& R_WO, const Vector3d& p_WO) {
  const Vector3d sides = map.require_vector3("sides", "m", kSideMin, kSideMax);
  const render::Box box{.R_WO = R_WO, .p_WO = p_WO, .half_sides = sides / 2};
  const bool wedges = map.optional_choice("form", 0, {"entry_face", "wedges"}) == 1;
  map.finish();
  if (wedges) return {render::WedgeBox{box}, box_mesh(box)};
  return {render::EntryFaceBox{box}, box_mesh(box)};
}

}  // namespace

std::optional<SceneShape> read_shape(YamlMap& object, const Eigen::Matrix3d& R_WO,
                                     const Eigen::Vector3d& p_WO) {
  if (object.has("plane")) return read_plane(object.require_map("plane"), R_WO, p_WO);
  if (object.has("sphere")) return read_sphere(object.require_map("sphere"), p_WO);
  if (object.has("box")) return read_box(object.require_map("box"), R_WO, p_WO);
  return {};
}

}  // namespace thimble::scene
