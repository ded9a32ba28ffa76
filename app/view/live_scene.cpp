#include "view/live_scene.h"

#include <cstddef>
#include <memory>
#include <utility>

#include "view/drawn_from_shared.h"

namespace thimble::view {

LiveScene::LiveScene(const session::SharedReader& reader)
    : reader_(reader), scene_(drawn_scene_of(reader.scene())) {}

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
  moment.arm = rods_of(reader_.scene().arms.front(), moment.tick);
  moment.others.clear();
  for (std::size_t i = 1; i < reader_.scene().arms.size(); ++i) {
    const session::SharedScene::Arm& arm = reader_.scene().arms[i];
    DrawnArm other;
    other.name = arm.in_scene;
    if (!reader_.newest_of(i, other.tick)) continue;
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

}  // namespace thimble::view
