#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "thimble/driver/device_state.h"
#include "thimble/driver/export.h"
#include "thimble/driver/force_law.h"
#include "thimble/render/body_patch.h"
#include "thimble/render/body_pose.h"
#include "thimble/render/effect/live_settings.h"

namespace thimble::render {

class BodyShape;
class ContactMesh;

/// The force law of one object of a scene, whatever stages it is made of: one indirect call per
/// tick stands for all of them (see object_touch_of).
class THIMBLE_EXPORT ObjectTouch {
 public:
  ObjectTouch() = default;
  ObjectTouch(const ObjectTouch&) = delete;
  ObjectTouch& operator=(const ObjectTouch&) = delete;
  virtual ~ObjectTouch() = default;

  /// Finds the force of this object on the hand. Real-time: safe.
  virtual driver::ForceCommand update(const driver::DeviceState& state) noexcept = 0;

  /// Reads what a tick like this will read of the object, so that the tick waits for no memory, and
  /// changes nothing (ForceLaw::prepare). Real-time: safe; about as long as the tick's contact.
  virtual void prepare(const driver::DeviceState& /*expected*/) const noexcept {}

  /// Returns whether a point (W, m) lies inside the object; for checks beside the servo.
  /// Real-time: safe unless the object is on the disk; one question to its search.
  virtual bool inside(const Eigen::Vector3d& p_W) const noexcept = 0;

  /// Returns the mesh whose triangles TouchInfo::feature names, if there is one in full.
  virtual const ContactMesh* mesh() const noexcept { return nullptr; }

  /// Draws what of the object has left its place (body_patch.h); false, and `patch` is left alone,
  /// if the object is stiff. Real-time: safe; for the rate of a picture.
  virtual bool draw(BodyPatch& /*patch*/) noexcept { return false; }

  /// Lists the settings that can be changed between two ticks, on the servo's thread.
  /// Real-time: never from the servo thread.
  virtual void list_settings(LiveSettings&) {}

  // The following are for readers beside the servo, and for bodies (render/src/body) to answer.

  /// Returns whether the surface is where it was before the first tick: neither moved nor bent.
  virtual bool stands_still() const noexcept { return true; }
  /// Counts contacts that ended with the tip inside; 0 for what stands still, where they can be
  /// found afterwards. Real-time: safe.
  virtual std::uint64_t lost_contacts() const noexcept { return 0; }
  /// Returns where the object has moved to. Real-time: safe.
  virtual BodyPose pose() const noexcept { return {}; }
  /// Returns the shape of an object whose base points move by themselves; nullptr for others.
  virtual const BodyShape* shape() const noexcept { return nullptr; }
  /// Puts the vertices of the object's mesh, as it was given (W, m), where they are now.
  /// Real-time: safe; time grows with the mesh.
  virtual void place_now(std::span<Eigen::Vector3d>) const noexcept {}
  /// Makes of the object's mesh, as it was given (W, m), what it is now: vertices where they are,
  /// and the triangles that it has been split into. Real-time: never from the servo thread.
  virtual void mesh_now(std::vector<Eigen::Vector3d>& vertices,
                        std::vector<std::array<std::int32_t, 3>>& /*triangles*/) const {
    place_now(vertices);
  }
};

/// An ObjectTouch made of a Touch with its stages known at compile time. `Stages` is callable
/// like Touch and has a `contact()` with `search()`.
template <class Stages>
class ObjectTouchOf final : public ObjectTouch {
 public:
  explicit ObjectTouchOf(Stages stages) : stages_(std::move(stages)) {}

  driver::ForceCommand update(const driver::DeviceState& state) noexcept override {
    return stages_(state);
  }
  void prepare(const driver::DeviceState& expected) const noexcept override {
    if constexpr (requires { stages_.prepare(expected); }) stages_.prepare(expected);
  }
  bool inside(const Eigen::Vector3d& p_W) const noexcept override {
    return stages_.contact().search().inside(p_W);
  }
  const ContactMesh* mesh() const noexcept override {
    if constexpr (requires { stages_.contact().mesh(); }) {
      return &stages_.contact().mesh();
    } else {
      return nullptr;
    }
  }

  void list_settings(LiveSettings& settings) override { list_settings_of(stages_, settings); }

  const Stages& stages() const noexcept { return stages_; }

 private:
  Stages stages_;
};

}  // namespace thimble::render
