// Functions of SceneTouch that know of the world of its solids.

#include <utility>

#include "thimble/render/scene_touch.h"
#include "world/contact_world.h"

namespace thimble::render {

SceneTouch::SceneTouch(std::vector<std::unique_ptr<ObjectTouch>> objects, SharedProxy shared)
    : objects_(std::move(objects)) {
  if (shared == SharedProxy::kNo) return;
  std::vector<ContactWorld::Member> members;
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    const auto solids = objects_[i]->solids();
    for (WorldSolid* solid : solids) {
      members.push_back({.solid = solid, .object = static_cast<std::int16_t>(i)});
    }
    if (solids.empty()) apart_.push_back(i);
  }
  if (members.size() > 1) {
    world_ = std::make_unique<ContactWorld>(std::move(members));
  } else {
    apart_.clear();
  }
}

SceneTouch::SceneTouch(SceneTouch&&) noexcept = default;
SceneTouch& SceneTouch::operator=(SceneTouch&&) noexcept = default;
SceneTouch::~SceneTouch() = default;

driver::ForceCommand SceneTouch::in_world(const driver::DeviceState& state) noexcept {
  driver::ForceCommand sum = (*world_)(state);
  for (const std::size_t i : apart_) add(i, state, sum);
  return sum;
}

void SceneTouch::prepare_world(const driver::DeviceState& expected) const noexcept {
  world_->prepare(expected);
  for (const std::size_t i : apart_) objects_[i]->prepare(expected);
}

}  // namespace thimble::render
