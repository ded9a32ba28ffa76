#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "thimble/driver/device_state.h"
#include "thimble/driver/force_law.h"
#include "thimble/render/object_touch.h"

namespace thimble::render {

/// The force law of a whole scene: several separate objects, each closed by itself. Their forces
/// add; what is told of the touch is that of the object the tip is deepest in.
class SceneTouch {
 public:
  /// Takes the objects in the scene's order; TouchInfo::object counts them from 0.
  explicit SceneTouch(std::vector<std::unique_ptr<ObjectTouch>> objects)
      : objects_(std::move(objects)) {}

  /// Finds the force of the scene on the hand. Real-time: safe.
  driver::ForceCommand operator()(const driver::DeviceState& state) noexcept {
    driver::ForceCommand sum;
    for (std::size_t i = 0; i < objects_.size(); ++i) {
      const driver::ForceCommand one = objects_[i]->update(state);
      sum.f_T_W += one.f_T_W;
      sum.stored += one.stored;
      sum.f_program_W += one.f_program_W;
      // A contact of depth 0, over the groove of a texture, is one as well.
      if (one.touch.in_contact && !(sum.touch.in_contact && one.touch.depth <= sum.touch.depth)) {
        sum.touch = one.touch;
        sum.touch.object = static_cast<std::int16_t>(i);
      }
    }
    return sum;
  }

  /// Reads what the objects will need in a tick like this (ForceLaw::prepare). Real-time: safe.
  void prepare(const driver::DeviceState& expected) const noexcept {
    for (const auto& object : objects_) object->prepare(expected);
  }

  /// Returns whether a point (W, m) lies inside any object that stands still; for checks beside the
  /// servo. Real-time: safe; time grows with the objects' size.
  bool inside(const Eigen::Vector3d& p_W) const noexcept {
    for (const auto& object : objects_) {
      if (object->stands_still() && object->inside(p_W)) return true;
    }
    return false;
  }

  /// Draws the dent of the first object that has one; false, and `patch` is left alone, if no
  /// object can dent. Real-time: safe; for the rate of a picture.
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

  /// Counts the contacts that objects which do not stand still have lost. Real-time: safe.
  std::uint64_t lost_contacts() const noexcept {
    std::uint64_t lost = 0;
    for (const auto& object : objects_) lost += object->lost_contacts();
    return lost;
  }

  std::size_t size() const noexcept { return objects_.size(); }  ///< Returns how many there are.
  const ObjectTouch& object(std::size_t i) const noexcept { return *objects_[i]; }  ///< Shows one.
  ObjectTouch& object(std::size_t i) noexcept { return *objects_[i]; }              ///< Gives one.

 private:
  std::vector<std::unique_ptr<ObjectTouch>> objects_;
};

}  // namespace thimble::render
