#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "thimble/driver/device_state.h"
#include "thimble/driver/export.h"
#include "thimble/driver/force_law.h"
#include "thimble/render/object_touch.h"

namespace thimble::render {

class ContactWorld;

/// Returns the number by which a touch names object `i` of a scene: -1, unnamed, from the 32,768th
/// object on. Real-time: safe.
constexpr std::int16_t object_number(std::size_t i) noexcept {
  return i <= std::numeric_limits<std::int16_t>::max() ? static_cast<std::int16_t>(i)
                                                       : std::int16_t{-1};
}

/// Force law of a scene. The tip feels the union of all solids of its objects (render/src/world);
/// the forces of the other objects, such as fields, are added. The contact information is that of
/// the object in which the tip is deepest.
class THIMBLE_EXPORT SceneTouch {
 public:
  /// Constructs the law from the objects in the scene's order. TouchInfo::object is the index of an
  /// object in this order, from 0.
  explicit SceneTouch(std::vector<std::unique_ptr<ObjectTouch>> objects);
  SceneTouch(SceneTouch&&) noexcept;             ///< Moves all objects.
  SceneTouch& operator=(SceneTouch&&) noexcept;  ///< Moves all objects.
  ~SceneTouch();

  /// Returns the force of the scene on the hand. Real-time: safe.
  driver::ForceCommand operator()(const driver::DeviceState& state) noexcept {
    driver::ForceCommand sum;
    for (const Felt& felt : felt_) {
      const driver::ForceCommand one = felt.touch->update(state);
      sum.f_T_W += one.f_T_W;
      sum.stored += one.stored;
      sum.f_program_W += one.f_program_W;
      // A contact of depth 0, over the groove of a texture, counts too.
      if (one.touch.in_contact && !(sum.touch.in_contact && one.touch.depth <= sum.touch.depth)) {
        sum.touch = one.touch;
        sum.touch.object = static_cast<std::int16_t>(felt.object + one.touch.object);
      }
    }
    return sum;
  }

  /// Prefetches the memory of all objects that a tick with about the state `expected` will read
  /// (ForceLaw::prepare). Real-time: safe.
  void prepare(const driver::DeviceState& expected) const noexcept {
    for (const Felt& felt : felt_) felt.touch->prepare(expected);
  }

  /// Appends the memory of the force law that each tick uses, as far as it belongs to this scene
  /// alone, so that a caller with many scenes can prefetch it; of at most four objects. Real-time:
  /// never from the servo thread.
  void list_memory(std::vector<std::span<const std::byte>>& memory) const;

  /// Returns whether a point (W, m) is inside an object that has neither moved nor deformed. For
  /// checks outside of the servo loop. Real-time: safe unless an object is paged from disk; the
  /// time grows with the size of the objects at this point.
  bool inside(const Eigen::Vector3d& p_W) const noexcept;

  /// Writes the dent of the first dented object to `patch` for drawing. Returns false and leaves
  /// `patch` unchanged if no object can dent. Real-time: safe; intended to be called once per
  /// display frame.
  bool draw(BodyPatch& patch) noexcept {
    bool any = false;
    for (std::size_t i = 0; i < objects_.size(); ++i) {
      if (!objects_[i]->draw(patch)) continue;
      any = true;
      if (patch.triangle_count == 0) continue;
      patch.object = object_number(i);
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
  /// Returns the world of the scene's solids; null if they are fewer than two. Real-time: safe.
  const ContactWorld* world() const noexcept;

 private:
  class WorldTouch;
  // What runs in each tick: one object, whose touch has the number 0, or the
  // world, whose touch has the number of the object.
  struct Felt {
    ObjectTouch* touch = nullptr;
    std::int16_t object = 0;
  };

  std::vector<std::unique_ptr<ObjectTouch>> objects_;
  std::unique_ptr<WorldTouch> world_;
  std::vector<Felt> felt_;
};

}  // namespace thimble::render
