#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "thimble/driver/device_state.h"
#include "thimble/driver/export.h"
#include "thimble/driver/force_law.h"
#include "thimble/render/body_patch.h"
#include "thimble/render/body_pose.h"
#include "thimble/render/contact_state.h"
#include "thimble/render/effect/live_settings.h"
#include "thimble/render/surface/surface_response.h"

namespace thimble::render {

class BodyShape;
class ContactMesh;

/// The force law of one object of a scene, whatever stages it is made of: one indirect call per
/// tick stands for all of them (see ObjectTouchAdapter).
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

/// The force of one contact, through the surface stages that a scene names, joined at compile time:
/// a stage that is not named costs nothing. The force law of an object, without the interface of
/// ObjectTouch.
///
/// `Contact` finds what the tip touches: `const ContactState& update(const DeviceState&) noexcept`.
/// The surface stages say how that feels, one after the other (surface_response.h). Real-time: safe
/// if its stages are.
template <class Contact, SurfaceStage... Stages>
class ContactForceLaw {
 public:
  ContactForceLaw(Contact contact, Stages... stages)
      : contact_(std::move(contact)), stages_(std::move(stages)...) {}

  /// Finds the force of the object on the hand in this tick. Real-time: safe.
  driver::ForceCommand operator()(const driver::DeviceState& state) noexcept {
    driver::ForceCommand command;
    const ContactState& contact = contact_.update(state);
    // Written so that a NaN depth means no contact and no force.
    if (contact.touching && contact.depth > 0) {
      SurfaceResponse response{.contact = contact};
      feel(state, response);
      command.f_T_W = response.f_T_W;
      command.touch = {.in_contact = true,
                       .object = 0,
                       .feature = contact.triangle,
                       .depth = response.contact.depth,
                       .p_WP = response.contact.p_WP,
                       .n_W = response.contact.n_W,
                       .hops = contact.hops};
      touching_ = true;
    } else if (touching_) {
      std::apply([](auto&... stage) { (stage.leave(), ...); }, stages_);
      touching_ = false;
    }
    return command;
  }

  /// Reads what the contact will need in a tick like this (ForceLaw::prepare). Real-time: safe.
  void prepare(const driver::DeviceState& expected) const noexcept {
    if constexpr (requires { contact_.prepare(expected); }) contact_.prepare(expected);
  }

  /// Lists the stages' settings that can be changed between two ticks. Real-time: never from the
  /// servo thread.
  void list_settings(LiveSettings& settings) {
    std::apply([&](auto&... stage) { (list_settings_of(stage, settings), ...); }, stages_);
  }

  const Contact& contact() const noexcept { return contact_; }
  /// Returns the contact stage, for who moves its surface. Real-time: safe.
  Contact& contact() noexcept { return contact_; }

 private:
  void feel(const driver::DeviceState& state, SurfaceResponse& response) noexcept {
    if constexpr ((FootStage<Stages> || ...)) {
      const SurfaceFoot foot = foot_of(contact_, state.p_WT);
      const auto run = [&](auto& stage) {
        if constexpr (requires { stage.touch_at(foot, state, response); }) {
          stage.touch_at(foot, state, response);
        } else {
          stage.touch(state, response);
        }
      };
      std::apply([&](auto&... stage) { (run(stage), ...); }, stages_);
    } else {
      std::apply([&](auto&... stage) { (stage.touch(state, response), ...); }, stages_);
    }
  }

  Contact contact_;
  [[no_unique_address]] std::tuple<Stages...> stages_;
  bool touching_ = false;
};

/// The ObjectTouch of a force law that is known at compile time. `Law` is callable like
/// ContactForceLaw and has a `contact()` with `search()`.
template <class Law>
class ObjectTouchAdapter final : public ObjectTouch {
 public:
  explicit ObjectTouchAdapter(Law law) : law_(std::move(law)) {}

  driver::ForceCommand update(const driver::DeviceState& state) noexcept override {
    return law_(state);
  }
  void prepare(const driver::DeviceState& expected) const noexcept override {
    if constexpr (requires { law_.prepare(expected); }) law_.prepare(expected);
  }
  bool inside(const Eigen::Vector3d& p_W) const noexcept override {
    return law_.contact().search().inside(p_W);
  }
  const ContactMesh* mesh() const noexcept override {
    if constexpr (requires { law_.contact().mesh(); }) {
      return &law_.contact().mesh();
    } else {
      return nullptr;
    }
  }

  void list_settings(LiveSettings& settings) override { list_settings_of(law_, settings); }

  const Law& law() const noexcept { return law_; }

 private:
  Law law_;
};

/// The former name of ContactForceLaw.
template <class Contact, SurfaceStage... Stages>
using Touch [[deprecated("renamed to ContactForceLaw")]] = ContactForceLaw<Contact, Stages...>;

/// The former name of ObjectTouchAdapter.
template <class Law>
using ObjectTouchOf [[deprecated("renamed to ObjectTouchAdapter")]] = ObjectTouchAdapter<Law>;

}  // namespace thimble::render
