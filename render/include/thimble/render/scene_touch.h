#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "thimble/driver/device_state.h"
#include "thimble/driver/export.h"
#include "thimble/driver/force_law.h"
#include "thimble/render/object_touch.h"

namespace thimble::render {

class ContactWorld;

/// Whether the solids of a scene share one proxy.
enum class SharedProxy {
  kNo,   ///< Each object has its own, and the forces are added.
  kYes,  ///< The tip feels the union of all solids (render/src/world). Not used by scene files yet.
};

/// Force law of a scene. The forces of its objects are added, unless its solids share one proxy.
/// The contact information is that of the object in which the tip is deepest.
class THIMBLE_EXPORT SceneTouch {
 public:
  /// Constructs the law from the objects in the scene's order. TouchInfo::object is the index of an
  /// object in this order, from 0.
  explicit SceneTouch(std::vector<std::unique_ptr<ObjectTouch>> objects,
                      SharedProxy shared = SharedProxy::kNo);
  SceneTouch(SceneTouch&&) noexcept;             ///< Moves all objects.
  SceneTouch& operator=(SceneTouch&&) noexcept;  ///< Moves all objects.
  ~SceneTouch();

  /// Returns the force of the scene on the hand. Real-time: safe.
  [[gnu::always_inline]] driver::ForceCommand operator()(
      const driver::DeviceState& state) noexcept {
    if (world_) [[unlikely]]
      return in_world(state);
    driver::ForceCommand sum;
    for (std::size_t i = 0; i < objects_.size(); ++i) add(i, state, sum);
    return sum;
  }

  /// Prefetches the memory of all objects that a tick with about the state `expected` will read
  /// (ForceLaw::prepare). Real-time: safe.
  void prepare(const driver::DeviceState& expected) const noexcept {
    if (world_) [[unlikely]]
      return prepare_world(expected);
    for (const auto& object : objects_) object->prepare(expected);
  }

  /// Returns whether a point (W, m) is inside an object that has neither moved nor deformed. For
  /// checks outside of the servo loop. Real-time: safe unless an object is paged from disk; the
  /// time grows with the size of the objects.
  bool inside(const Eigen::Vector3d& p_W) const noexcept {
    for (const auto& object : objects_) {
      if (object->is_static() && object->inside(p_W)) return true;
    }
    return false;
  }

  /// Writes the dent of the first dented object to `patch` for drawing. Returns false and leaves
  /// `patch` unchanged if no object can dent. Real-time: safe; intended to be called once per
  /// display frame.
  bool draw(BodyPatch& patch) noexcept {
    bool any = false;
    for (std::size_t i = 0; i < objects_.size(); ++i) {
      if (!objects_[i]->draw(patch)) continue;
      any = true;
      if (patch.triangle_count == 0) continue;
      patch.object = static_cast<std::int16_t>(i);
      break;
    }
    return any;
  }

  /// Returns how many contacts ended with the tip inside an object that had moved or deformed.
  /// Real-time: safe.
  std::uint64_t lost_contacts() const noexcept {
    std::uint64_t lost = 0;
    for (const auto& object : objects_) lost += object->lost_contacts();
    return lost;
  }

  /// Returns the number of objects.
  std::size_t size() const noexcept { return objects_.size(); }
  /// Returns the object with index `i` in the scene's order; `i` must be below `size()`.
  const ObjectTouch& object(std::size_t i) const noexcept { return *objects_[i]; }
  /// Overload for a scene that is not const.
  ObjectTouch& object(std::size_t i) noexcept { return *objects_[i]; }
  /// Returns the world of the scene's solids; null if they share no proxy or are fewer than two.
  /// Real-time: safe.
  const ContactWorld* world() const noexcept { return world_.get(); }

 private:
  [[gnu::always_inline]] void add(std::size_t i, const driver::DeviceState& state,
                                  driver::ForceCommand& sum) noexcept {
    const driver::ForceCommand one = objects_[i]->update(state);
    sum.f_T_W += one.f_T_W;
    sum.stored += one.stored;
    sum.f_program_W += one.f_program_W;
    // A contact of depth 0, over the groove of a texture, counts too.
    if (one.touch.in_contact && !(sum.touch.in_contact && one.touch.depth <= sum.touch.depth)) {
      sum.touch = one.touch;
      sum.touch.object = static_cast<std::int16_t>(i);
    }
  }
  driver::ForceCommand in_world(const driver::DeviceState& state) noexcept;
  void prepare_world(const driver::DeviceState& expected) const noexcept;

  std::vector<std::unique_ptr<ObjectTouch>> objects_;
  std::vector<std::size_t> apart_;  // With a world: objects whose forces are added.
  std::unique_ptr<ContactWorld> world_;
};

}  // namespace thimble::render
