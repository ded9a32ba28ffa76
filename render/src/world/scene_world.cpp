// Functions of SceneTouch that know of the world of its solids.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "thimble/render/scene_touch.h"
#include "world/contact_world.h"

namespace thimble::render {

/// All solids of a scene as one object.
class SceneTouch::WorldTouch final : public ObjectTouch {
 public:
  /// `object_of` has the index of each member's object in the scene.
  WorldTouch(std::vector<ContactWorld::Member> members, std::vector<std::size_t> object_of)
      : object_of_(std::move(object_of)), world_(std::move(members)) {}

  driver::ForceCommand update(const driver::DeviceState& state) noexcept override {
    return world_(state);
  }
  void prepare(const driver::DeviceState& expected) const noexcept override {
    world_.prepare(expected);
  }
  // The scene asks its objects.
  bool inside(const Eigen::Vector3d&) const noexcept override { return false; }

  const ContactWorld& world() const noexcept { return world_; }
  /// Returns whether `holds(object)` is true for an object that may contain a point (W, m).
  template <class Holds>
  bool any_at(const Eigen::Vector3d& p_W, const Holds& holds) const noexcept {
    return world_.any_at(p_W, [&](std::int32_t member) {
      return holds(object_of_[static_cast<std::size_t>(member)]);
    });
  }

 private:
  std::vector<std::size_t> object_of_;
  ContactWorld world_;
};

SceneTouch::SceneTouch(std::vector<std::unique_ptr<ObjectTouch>> objects)
    : objects_(std::move(objects)) {
  std::vector<ContactWorld::Member> members;
  std::vector<std::size_t> object_of;
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    const auto solids = objects_[i]->solids();
    const std::int16_t object = object_number(i);
    for (WorldSolid* solid : solids) {
      members.push_back({.solid = solid, .object = object});
      object_of.push_back(i);
    }
    if (solids.empty()) felt_.push_back({.touch = objects_[i].get(), .object = object});
  }
  if (members.size() > 1) {
    world_ = std::make_unique<WorldTouch>(std::move(members), std::move(object_of));
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

bool SceneTouch::inside(const Eigen::Vector3d& p_W) const noexcept {
  const auto holds = [&](const ObjectTouch& object) {
    return object.is_static() && object.inside(p_W);
  };
  if (world_ && world_->any_at(p_W, [&](std::size_t i) { return holds(*objects_[i]); })) {
    return true;
  }
  return std::any_of(felt_.begin(), felt_.end(), [&](const Felt& felt) {
    return felt.touch != world_.get() && holds(*felt.touch);
  });
}

void SceneTouch::list_memory(std::vector<std::span<const std::byte>>& memory) const {
  // Bytes of the law of a shape or mesh with a spring [measured: 360].
  constexpr std::size_t kLaw = 384;
  constexpr std::size_t kObjectsMax = 4;
  memory.push_back(std::as_bytes(std::span(this, 1)));
  memory.push_back(std::as_bytes(std::span(felt_)));
  for (std::size_t i = 0; i < std::min(felt_.size(), kObjectsMax); ++i) {
    const bool is_world = felt_[i].touch == world_.get();
    memory.emplace_back(reinterpret_cast<const std::byte*>(felt_[i].touch),
                        is_world ? sizeof(WorldTouch) : kLaw);
  }
}

const ContactWorld* SceneTouch::world() const noexcept {
  return world_ ? &world_->world() : nullptr;
}

}  // namespace thimble::render
