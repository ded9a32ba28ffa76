// Meshes of shapes. They are drawn, and give the hand's path and the mass of a moving body.

#include <Eigen/Geometry>
#include <cmath>
#include <cstddef>
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

/// Point of the outline of a solid of revolution: distance from the axis and height, m.
struct OutlinePoint {
  double rho = 0, z = 0;
};

/// Adds the surface that a line of the outline makes around the axis. The line goes from top to
/// bottom on the outside, as on a sphere. An end on the axis is a single vertex; a line that ends
/// where it begins is closed. The surface has its own vertices, so its normals are not averaged
/// with those beyond its rims.
void add_turned(const render::RoundFrame& frame, const std::vector<OutlinePoint>& line,
                render::TriangleMesh& mesh) {
  std::vector<std::int32_t> first;  // vertex of each point of the line
  for (const OutlinePoint& point : line) {
    if (!first.empty() && point.rho == line.front().rho && point.z == line.front().z) {
      first.push_back(first.front());
      continue;
    }
    first.push_back(static_cast<std::int32_t>(mesh.vertices.size()));
    const int count = point.rho > 0 ? kAround : 1;
    for (int k = 0; k < count; ++k) {
      const double round = 2 * std::numbers::pi * k / kAround;
      const Vector3d p_O(point.rho * math::cos(round), point.rho * math::sin(round), point.z);
      mesh.vertices.emplace_back(frame.p_WO + frame.R_WO * p_O);
    }
  }
  for (std::size_t row = 0; row + 1 < line.size(); ++row) {
    const auto at = [&](std::size_t i, int k) {
      return first[i] + (line[i].rho > 0 ? k % kAround : 0);
    };
    for (int k = 0; k < kAround; ++k) {
      if (line[row + 1].rho > 0) {
        mesh.triangles.push_back({at(row, k), at(row + 1, k), at(row + 1, k + 1)});
      }
      if (line[row].rho > 0) {
        mesh.triangles.push_back({at(row, k), at(row + 1, k + 1), at(row, k + 1)});
      }
    }
  }
}

/// Adds a part of a circle of the outline, from one angle above the plane z = 0 to a lower one.
void add_arc(const OutlinePoint& centre, double radius, double from, double to, int steps,
             std::vector<OutlinePoint>& line) {
  for (int i = 0; i <= steps; ++i) {
    const double angle = from + (to - from) * i / steps;
    const bool on_axis = centre.rho == 0 && std::abs(angle) >= std::numbers::pi / 2;
    line.push_back({on_axis ? 0 : centre.rho + radius * math::cos(angle),
                    centre.z + radius * math::sin(angle)});
  }
}

render::TriangleMesh mesh_of(const render::Cylinder& cylinder, double) {
  render::TriangleMesh mesh;
  const double r = cylinder.radius, h = cylinder.half_height;
  add_turned(cylinder, {{0, h}, {r, h}}, mesh);
  add_turned(cylinder, {{r, h}, {r, -h}}, mesh);
  add_turned(cylinder, {{r, -h}, {0, -h}}, mesh);
  return mesh;
}
render::TriangleMesh mesh_of(const render::Cone& cone, double) {
  render::TriangleMesh mesh;
  const double r = cone.radius, h = cone.half_height;
  add_turned(cone, {{0, h}, {r, -h}}, mesh);
  add_turned(cone, {{r, -h}, {0, -h}}, mesh);
  return mesh;
}
render::TriangleMesh mesh_of(const render::Capsule& capsule, double) {
  render::TriangleMesh mesh;
  std::vector<OutlinePoint> line;
  const double quarter = std::numbers::pi / 2;
  add_arc({0, capsule.half_height}, capsule.radius, quarter, 0, kAround / 4, line);
  add_arc({0, -capsule.half_height}, capsule.radius, 0, -quarter, kAround / 4, line);
  add_turned(capsule, line, mesh);
  return mesh;
}
render::TriangleMesh mesh_of(const render::Torus& torus, double) {
  render::TriangleMesh mesh;
  std::vector<OutlinePoint> line;
  add_arc({torus.radius, 0}, torus.tube, std::numbers::pi, -std::numbers::pi, kAround / 2, line);
  line.back() = line.front();
  add_turned(torus, line, mesh);
  return mesh;
}

}  // namespace

render::TriangleMesh SceneShape::mesh_W() const {
  return std::visit([this](const auto& shape) { return mesh_of(shape, drawn_side); }, shape_W);
}

}  // namespace thimble::scene
