#include "view/drawn_from_shared.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "share/arm_lines.h"
#include "surface/map/triangle_grid.h"

namespace thimble::view {
namespace {

/// Returns whether a mesh is flat: then it represents a plane.
bool is_flat(const render::TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : mesh.vertices) box.extend(vertex);
  if (box.isEmpty() || mesh.triangles.empty()) return false;
  const auto& c = mesh.triangles[0];
  const auto at = [&](std::int32_t v) { return mesh.vertices[static_cast<std::size_t>(v)]; };
  const Eigen::Vector3d n = (at(c[1]) - at(c[0])).cross(at(c[2]) - at(c[0])).normalized();
  return std::all_of(mesh.vertices.begin(), mesh.vertices.end(), [&](const auto& vertex) {
    return std::abs((vertex - at(c[0])).dot(n)) < 1e-9 * (1 + box.diagonal().norm());
  });
}

/// Returns ranges of the scene's vertices and triangles as a mesh.
render::TriangleMesh mesh_of(const session::SharedScene& scene, std::size_t first_vertex,
                             std::size_t vertex_count, std::size_t first_triangle,
                             std::size_t triangle_count) {
  render::TriangleMesh mesh;
  const auto vertices = std::span(scene.vertices).subspan(first_vertex, vertex_count);
  mesh.vertices.assign(vertices.begin(), vertices.end());
  for (const auto& [a, b, c] : std::span(scene.triangles).subspan(first_triangle, triangle_count)) {
    mesh.triangles.push_back({static_cast<std::int32_t>(a - first_vertex),
                              static_cast<std::int32_t>(b - first_vertex),
                              static_cast<std::int32_t>(c - first_vertex)});
  }
  return mesh;
}

DrawnObject drawn_object(const session::SharedScene& scene,
                         const session::SharedScene::Object& object) {
  DrawnObject drawn;
  drawn.name = object.name;
  drawn.is_placeholder = object.kind == session::SharedKind::kShape;
  drawn.field = object.kind == session::SharedKind::kField;
  drawn.crease_angle = object.crease_angle;
  drawn.texture = object.texture;
  drawn.friction = object.friction;
  drawn.mesh = mesh_of(scene, object.first_vertex, object.vertex_count, object.first_triangle,
                       object.triangle_count);
  if (const session::SharedScene::Map& map = object.map; map.parts > 0) {
    const auto values =
        std::span(scene.map_values)
            .subspan(map.first_value, object.triangle_count * render::grid_points(map.parts));
    drawn.map = {.quantity = map.quantity,
                 .unit = map.unit,
                 .min = map.min,
                 .max = map.max,
                 .parts = map.parts,
                 .values = {values.begin(), values.end()}};
  }
  drawn.endless = drawn.is_placeholder && is_flat(drawn.mesh);
  if (!drawn.endless) {
    drawn.collider = mesh_of(scene, object.collider_first_vertex, object.collider_vertex_count,
                             object.collider_first_triangle, object.collider_triangle_count);
  }
  return drawn;
}

}  // namespace

DrawnScene drawn_scene_of(const session::SharedScene& scene) {
  DrawnScene drawn;
  drawn.name = scene.name;
  drawn.arm = scene.arms.front().name;
  drawn.arm_in_scene = scene.arms.front().in_scene;
  drawn.force_limit = scene.force_max > 0 ? scene.force_max : 5;
  drawn.tip_radius = scene.tip_radius;
  drawn.duration = scene.duration;
  drawn.rate = 1e9 / static_cast<double>(scene.period_ns);
  for (const session::SharedScene::Object& object : scene.objects) {
    drawn.objects.push_back(drawn_object(scene, object));
  }
  for (const auto& sample : scene.field) drawn.field.push_back({sample.p_W, sample.f_W});
  return drawn;
}

std::vector<DrawnRod> rods_of(const session::SharedScene::Arm& arm,
                              const driver::TickRecord& tick) {
  std::vector<DrawnRod> rods;
  for (const session::ArmLine& line : session::arm_lines(arm, tick)) {
    for (std::size_t i = 0; i + 1 < line.size(); ++i) rods.push_back({line[i], line[i + 1]});
  }
  return rods;
}

}  // namespace thimble::view
