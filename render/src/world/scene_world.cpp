// Functions of SceneTouch that know of the world of its solids.

#include <utility>

#include "thimble/render/scene_touch.h"
#include "world/contact_world.h"

namespace thimble::render {

/// All solids of a scene as one object.
class SceneTouch::WorldTouch final : public ObjectTouch {
 public:
  explicit WorldTouch(std::vector<ContactWorld::Member> members) : world_(std::move(members)) {}

  driver::ForceCommand update(const driver::DeviceState& state) noexcept override {
    return world_(state);
  }
  void prepare(const driver::DeviceState& expected) const noexcept override {
    world_.prepare(expected);
  }
  // The scene asks its objects.
  bool inside(const Eigen::Vector3d&) const noexcept override { return false; }

  const ContactWorld& world() const noexcept { return world_; }

 private:
  ContactWorld world_;
};

SceneTouch::SceneTouch(std::vector<std::unique_ptr<ObjectTouch>> objects)
    : objects_(std::move(objects)) {
  std::vector<ContactWorld::Member> members;
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    const auto solids = objects_[i]->solids();
    const std::int16_t object = object_number(i);
    for (WorldSolid* solid : solids) members.push_back({.solid = solid, .object = object});
    if (solids.empty()) felt_.push_back({.touch = objects_[i].get(), .object = object});
  }
  if (members.size() > 1) {
    world_ = std::make_unique<WorldTouch>(std::move(members));
    felt_.insert(felt_.begin(), {.touch = world_.get(), .object = 0});
    return;
  }
  felt_.clear();
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    felt_.push_back({.touch = objects_[i].get(), .object = object_number(i)});
  }
}

SceneTouch::SceneTouch(SceneTouch&&) noexcept = default;
SceneTouch& SceneTouch::operator=(SceneTouch&&) noexcept = default;
SceneTouch::~SceneTouch() = default;

const ContactWorld* SceneTouch::world() const noexcept {
  return world_ ? &world_->world() : nullptr;
}

}  // namespace thimble::render
