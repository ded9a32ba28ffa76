#pragma once

#include <Eigen/Core>
#include <utility>

#include "thimble/driver/device_state.h"
#include "thimble/driver/force_command.h"
#include "thimble/render/body/body_patch.h"
#include "thimble/render/contact/contact_mesh.h"

namespace thimble::render {

/// Is the force law of one object of a scene, whatever stages it is made of: one indirect call per
/// tick stands for all of them (see object_touch_of).
class ObjectTouch {
 public:
  ObjectTouch() = default;
  ObjectTouch(const ObjectTouch&) = delete;
  ObjectTouch& operator=(const ObjectTouch&) = delete;
  virtual ~ObjectTouch() = default;

  /// Finds the force of this object on the hand. Real-time: safe.
  virtual driver::ForceCommand update(const driver::DeviceState& state) noexcept = 0;

  /// Tells whether a point (W, m) lies inside the object; for checks beside the servo.
  /// Real-time: safe unless the object is on the disk; one question to its search.
  virtual bool inside(const Eigen::Vector3d& p_W) const noexcept = 0;

  /// Gives the mesh whose triangles TouchInfo::feature names, if there is one in full.
  virtual const ContactMesh* mesh() const noexcept { return nullptr; }

  /// Draws what of the object has left its place (body_patch.h); false, and `patch` is left alone,
  /// if the object is stiff. Real-time: safe; for the rate of a picture.
  virtual bool draw(BodyPatch& /*patch*/) noexcept { return false; }
};

/// Is an ObjectTouch made of a Touch with its stages known at compile time. `Stages` is callable
/// like Touch and has a `contact()` with `search()`.
template <class Stages>
class ObjectTouchOf final : public ObjectTouch {
 public:
  explicit ObjectTouchOf(Stages stages) : stages_(std::move(stages)) {}

  driver::ForceCommand update(const driver::DeviceState& state) noexcept override {
    return stages_(state);
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

  const Stages& stages() const noexcept { return stages_; }

 private:
  Stages stages_;
};

}  // namespace thimble::render
