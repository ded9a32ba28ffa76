#include "view/live_scene.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "share/arm_lines.h"

namespace thimble::app::view {
namespace {

/// Returns whether a mesh is flat: it stands for a plane, which has no end.
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

DrawnObject drawn_object(const session::SharedScene& scene,
                         const session::SharedScene::Object& object) {
  DrawnObject drawn;
  drawn.name = object.name;
  drawn.stands_for_shape = object.kind == session::SharedKind::kShape;
  drawn.crease_angle = object.crease_angle;
  drawn.texture = object.texture;
  drawn.friction = object.friction;
  const auto vertices = std::span(scene.vertices).subspan(object.first_vertex, object.vertex_count);
  drawn.mesh.vertices.assign(vertices.begin(), vertices.end());
  for (const auto& [a, b, c] :
       std::span(scene.triangles).subspan(object.first_triangle, object.triangle_count)) {
    drawn.mesh.triangles.push_back({static_cast<std::int32_t>(a - object.first_vertex),
                                    static_cast<std::int32_t>(b - object.first_vertex),
                                    static_cast<std::int32_t>(c - object.first_vertex)});
  }
  drawn.endless = drawn.stands_for_shape && is_flat(drawn.mesh);
  return drawn;
}

/// Returns the rods of an arm, from its base to its tip.
std::vector<DrawnRod> rods_of(const session::SharedScene::Arm& arm,
                              const driver::TickRecord& tick) {
  std::vector<DrawnRod> rods;
  for (const session::ArmLine& line : session::arm_lines(arm, tick)) {
    for (std::size_t i = 0; i + 1 < line.size(); ++i) rods.push_back({line[i], line[i + 1]});
  }
  return rods;
}

}  // namespace

LiveScene::LiveScene(const session::SharedReader& reader) : reader_(reader) {
  const session::SharedScene& scene = reader.scene();
  scene_.name = scene.name;
  scene_.arm = scene.arm.name;
  scene_.arm_in_scene = scene.arm.in_scene;
  scene_.force_limit = scene.force_max > 0 ? scene.force_max : 5;
  scene_.rate = 1e9 / static_cast<double>(scene.period_ns);
  for (const session::SharedScene::Object& object : scene.objects) {
    scene_.objects.push_back(drawn_object(scene, object));
  }
  for (const auto& sample : scene.field) scene_.field.push_back({sample.p_W, sample.f_W});
}

bool LiveScene::update(DrawnMoment& moment) {
  moment.poses.resize(scene_.objects.size());
  moment.shapes.resize(scene_.objects.size());
  if (!reader_.newest(moment.tick)) return false;
  session::ScenePoses poses;
  if (reader_.poses(poses)) {
    for (std::size_t i = 0; i < poses.count; ++i) {
      const auto object = static_cast<std::size_t>(poses.object[i]);
      if (object < moment.poses.size()) moment.poses[object] = poses.pose[i];
    }
  }
  if (!reader_.patch(moment.patch)) moment.patch.triangle_count = 0;
  update_shapes(moment);
  moment.arm = rods_of(reader_.scene().arm, moment.tick);
  moment.others.clear();
  for (std::size_t i = 0; i < reader_.scene().more_arms.size(); ++i) {
    const session::SharedScene::Arm& arm = reader_.scene().more_arms[i];
    DrawnArm other;
    other.name = arm.in_scene;
    if (!reader_.newest_of(i + 1, other.tick)) continue;
    other.rods = rods_of(arm, other.tick);
    moment.others.push_back(std::move(other));
  }
  return true;
}

void LiveScene::update_shapes(DrawnMoment& moment) {
  const std::uint64_t moves = reader_.shape_moves();
  if (moves == shape_moves_) return;
  shape_moves_ = moves;
  for (std::size_t i = 0; i < scene_.objects.size(); ++i) {
    if (!reader_.scene().objects[i].shaped) continue;
    const auto shape = std::make_shared<render::TriangleMesh>(
        moment.shapes[i] ? *moment.shapes[i] : scene_.objects[i].mesh);
    reader_.shape(i, *shape);
    moment.shapes[i] = shape;
  }
}

}  // namespace thimble::app::view
