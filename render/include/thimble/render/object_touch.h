#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
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
class WorldSolid;

/// Force law of one object of a scene, with any stages. One indirect call per tick runs all of them
/// (see ObjectTouchAdapter).
class THIMBLE_EXPORT ObjectTouch {
 public:
  ObjectTouch() = default;
  ObjectTouch(const ObjectTouch&) = delete;
  ObjectTouch& operator=(const ObjectTouch&) = delete;
  virtual ~ObjectTouch() = default;

  /// Returns the force of this object on the hand. Real-time: safe.
  virtual driver::ForceCommand update(const driver::DeviceState& state) noexcept = 0;

  /// Prefetches the memory that a tick with about this state will read; changes nothing
  /// (ForceLaw::prepare). Real-time: safe; takes about as long as the contact of a tick.
  virtual void prepare(const driver::DeviceState& /*expected*/) const noexcept {}

  /// Returns whether a point (W, m) is inside the object; for checks outside of the servo loop.
  /// Real-time: safe unless the object is paged from disk; one query of its search.
  virtual bool inside(const Eigen::Vector3d& p_W) const noexcept = 0;

  /// Returns the solids of this object that share one proxy with those of the other objects
  /// (render/src/world). If there are none, as for a force field, the force of `update` is added to
  /// that of the others. Real-time: never from the servo thread.
  virtual std::span<WorldSolid* const> solids() noexcept { return {}; }

  /// Returns the mesh whose triangles TouchInfo::feature identifies; null if no complete mesh is in
  /// memory.
  virtual const ContactMesh* mesh() const noexcept { return nullptr; }

  /// Writes the deformed part of the object to `patch` for drawing (body_patch.h). Returns false
  /// and leaves `patch` unchanged if the object is stiff. Real-time: safe; intended for the frame
  /// rate of a display.
  virtual bool draw(BodyPatch& /*patch*/) noexcept { return false; }

  /// Adds the settings that can be changed between two ticks, on the servo's thread. Real-time:
  /// never from the servo thread.
  virtual void list_settings(LiveSettings&) {}

  // The following functions are for observers; bodies (render/src/body) override them.

  /// Returns whether the surface is at its initial place: neither moved nor deformed.
  virtual bool is_static() const noexcept;
  /// Former name of `is_static`, which calls it: programs may still override it.
  [[deprecated("renamed to is_static")]] virtual bool stands_still() const noexcept { return true; }
  /// Returns the number of contacts that ended with the tip inside; 0 for an object at rest, whose
  /// lost contacts can be found afterwards. Real-time: safe.
  virtual std::uint64_t lost_contacts() const noexcept { return 0; }
  /// Returns the pose to which the object has moved. Real-time: safe.
  virtual BodyPose pose() const noexcept { return {}; }
  /// Returns the shape of an object whose base points deform; nullptr for others.
  virtual const BodyShape* shape() const noexcept { return nullptr; }
  /// Moves the given vertices of the object's mesh (W, m) to their current positions. Real-time:
  /// safe; time grows with the mesh.
  virtual void place_now(std::span<Eigen::Vector3d>) const noexcept {}
  /// Updates the given mesh of the object (W, m) to its current state: positions of vertices, and
  /// triangles after splitting. Real-time: never from the servo thread.
  virtual void mesh_now(std::vector<Eigen::Vector3d>& vertices,
                        std::vector<std::array<std::int32_t, 3>>& /*triangles*/) const {
    place_now(vertices);
  }
};

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wdeprecated-declarations"
inline bool ObjectTouch::is_static() const noexcept {
  return stands_still();
}
#pragma GCC diagnostic pop

/// Force law of one contact with the surface stages of a scene, combined at compile time: an unused
/// stage costs nothing. It has no virtual interface, unlike ObjectTouch.
///
/// `Contact` finds the contact of the tip: `const ContactState& update(const DeviceState&)
/// noexcept`. The surface stages then compute the force, one after the other (surface_response.h).
/// Real-time: safe if its stages are.
template <class Contact, SurfaceStage... Stages>
class ContactForceLaw {
 public:
  ContactForceLaw(Contact contact, Stages... stages)
      : contact_(std::move(contact)), stages_(std::move(stages)...) {}

  /// Returns the force of the object on the hand in this tick. Real-time: safe.
  driver::ForceCommand operator()(const driver::DeviceState& state) noexcept {
    return command_of(state, contact_.update(state), contact_);
  }

  /// Returns the force of a contact that was found at `state.p_WT`. `source` is the contact stage
  /// that provides its surface point. Real-time: safe.
  template <class Source>
  driver::ForceCommand respond(const driver::DeviceState& state, const ContactState& contact,
                               const Source& source) noexcept {
    return command_of(state, contact, source);
  }

  /// Returns the stiffness of the surface's spring, N/m; 0 if no stage is a spring. Real-time:
  /// safe.
  double spring_stiffness() const noexcept {
    const auto of = [](const auto& stage) {
      if constexpr (requires { stage.spring_stiffness(); }) return stage.spring_stiffness();
      return 0.0;
    };
    return std::apply([&](const auto&... stage) { return (0.0 + ... + of(stage)); }, stages_);
  }

  /// Prefetches the memory for the contact of a tick with about this state (ForceLaw::prepare).
  /// Real-time: safe.
  void prepare(const driver::DeviceState& expected) const noexcept {
    if constexpr (requires { contact_.prepare(expected); }) contact_.prepare(expected);
  }

  /// Adds the stages' settings that can be changed between two ticks. Real-time: never from the
  /// servo thread.
  void list_settings(LiveSettings& settings) {
    std::apply([&](auto&... stage) { (list_settings_of(stage, settings), ...); }, stages_);
  }

  const Contact& contact() const noexcept { return contact_; }
  /// Returns the contact stage, for callers that deform the surface. Real-time: safe.
  Contact& contact() noexcept { return contact_; }

 private:
  // Inlined in the tick of one object and in that of a solid, so that neither pays for the other.
  template <class Source>
  [[gnu::always_inline]] driver::ForceCommand command_of(const driver::DeviceState& state,
                                                         const ContactState& contact,
                                                         const Source& source) noexcept {
    driver::ForceCommand command;
    // Written so that a NaN depth means no contact and no force.
    if (contact.touching && contact.depth > 0) {
      SurfaceResponse response{.contact = contact};
      feel(state, source, response);
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

  template <class Source>
  void feel(const driver::DeviceState& state, const Source& source,
            SurfaceResponse& response) noexcept {
    if constexpr ((ClosestPointStage<Stages> || ...)) {
      const ClosestSurfacePoint closest = closest_point_of(source, state.p_WT);
      const auto run = [&](auto& stage) {
        if constexpr (requires { stage.touch_at(closest, state, response); }) {
          stage.touch_at(closest, state, response);
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

/// ObjectTouch that wraps a force law known at compile time. `Law` is callable like ContactForceLaw
/// and has a `contact()` with `search()`.
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
  std::span<WorldSolid* const> solids() noexcept override {
    return {&solid_pointer_, solid_ ? std::size_t{1} : std::size_t{0}};
  }

  const Law& law() const noexcept { return law_; }
  Law& law() noexcept { return law_; }  ///< Returns the law, for the solid over it.
  /// Sets the solid over `law()` that `solids` returns. Real-time: never from the servo thread.
  void set_solid(std::shared_ptr<WorldSolid> solid) noexcept {
    solid_ = std::move(solid);
    solid_pointer_ = solid_.get();
  }

 private:
  Law law_;
  std::shared_ptr<WorldSolid> solid_;
  WorldSolid* solid_pointer_ = nullptr;
};

/// Former name of ContactForceLaw.
template <class Contact, SurfaceStage... Stages>
using Touch [[deprecated("renamed to ContactForceLaw")]] = ContactForceLaw<Contact, Stages...>;

/// Former name of ObjectTouchAdapter.
template <class Law>
using ObjectTouchOf [[deprecated("renamed to ObjectTouchAdapter")]] = ObjectTouchAdapter<Law>;

}  // namespace thimble::render
