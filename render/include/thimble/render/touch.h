#pragma once

#include <tuple>
#include <utility>

#include "thimble/driver/device_state.h"
#include "thimble/driver/force_law.h"
#include "thimble/render/contact_state.h"
#include "thimble/render/effect/live_settings.h"
#include "thimble/render/surface/surface_response.h"

namespace thimble::render {

/// The force law of an object: just the stages the scene names, joined at compile time, so that
/// a stage that is not named costs nothing.
///
/// `Contact` finds what the tip touches: `const ContactState& update(const DeviceState&) noexcept`.
/// The surface stages say how that feels, one after the other (surface_response.h). Real-time: safe
/// if its stages are.
template <class Contact, SurfaceStage... Stages>
class Touch {
 public:
  Touch(Contact contact, Stages... stages)
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

}  // namespace thimble::render
