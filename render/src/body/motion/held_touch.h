#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "body/motion/moving_touch.h"
#include "thimble/driver/device_state.h"
#include "thimble/driver/force_law.h"
#include "thimble/render/body/motion_choice.h"
#include "thimble/render/object_touch.h"

namespace thimble::render {

/// The force law of an object that the hand holds from the first tick on. A spring and a damper
/// join the tip to the point of the body that was there in the first tick. The hand feels the
/// body's weight, swing and contacts through them. The surface is not touched until the body has
/// slipped out.
///
/// A hand that goes where the body cannot follow, beyond its reach or under its floor, feels at
/// most `force_max` and then nothing. Real-time: safe.
template <BodyMotion Motion>
class HeldTouch final : public ObjectTouch {
 public:
  /// Takes the object that moves without being held, and the loop's period (s). Real-time: never
  /// from the servo thread.
  HeldTouch(std::unique_ptr<MovingTouch<Motion>> object, const Grip& grip, double step)
      : object_(std::move(object)), grip_(grip), step_(step) {}

  driver::ForceCommand update(const driver::DeviceState& state) noexcept override {
    if (slipped_) return object_->update(state);
    Motion& motion = object_->motion();
    driver::ForceCommand command;
    // Written so that NaN means no force.
    const bool known = state.p_WT.squaredNorm() < kFarSquared && state.v_WT.allFinite();
    if (known && !held_) {
      p_BG_ = motion.R_WB().transpose() * (state.p_WT - motion.p_WB());
      held_ = true;
    }
    if (known) command = pull(motion, state);
    command.stored = motion.energy();
    motion.step(step_);
    return command;
  }

  bool inside(const Eigen::Vector3d& p_W) const noexcept override { return object_->inside(p_W); }
  const ContactMesh* mesh() const noexcept override { return object_->mesh(); }
  bool draw(BodyPatch& patch) noexcept override { return object_->draw(patch); }
  bool is_static() const noexcept override { return false; }
  bool stands_still() const noexcept override { return is_static(); }  // deprecated
  std::uint64_t lost_contacts() const noexcept override { return object_->lost_contacts(); }
  BodyPose pose() const noexcept override { return object_->pose(); }
  const BodyShape* shape() const noexcept override { return object_->shape(); }
  void place_now(std::span<Eigen::Vector3d> vertices) const noexcept override {
    object_->place_now(vertices);
  }
  void mesh_now(std::vector<Eigen::Vector3d>& vertices,
                std::vector<std::array<std::int32_t, 3>>& triangles) const override {
    object_->mesh_now(vertices, triangles);
  }

  void list_settings(LiveSettings& settings) override { object_->list_settings(settings); }

  bool slipped() const noexcept { return slipped_; }  ///< Returns whether the hand lost the body.

 private:
  static constexpr double kFarSquared = 1e6;  // m^2; no arm reaches there

  driver::ForceCommand pull(Motion& motion, const driver::DeviceState& state) noexcept {
    driver::ForceCommand command;
    // The held point at the end of the tick: the whole implicit step (body_coupling.h).
    const auto [R_WB, p_WB] = motion.frame_after(step_);
    const Eigen::Vector3d p_WG = p_WB + R_WB * p_BG_;
    const Eigen::Vector3d f_W = grip_.stiffness * (p_WG - state.p_WT) +
                                grip_.damping * (motion.velocity_at(p_WG) - state.v_WT);
    const double size = f_W.norm();
    if (!(size > 0)) return command;
    const Eigen::Vector3d u = f_W / size;
    const BodyCoupling coupling{grip_.stiffness, grip_.damping, step_};
    const Eigen::Vector3d f_T_W = shared_force(coupling, u, motion.gain_at(state.p_WT, u)) * f_W;
    slipped_ = !(f_T_W.squaredNorm() <= grip_.force_max * grip_.force_max);
    if (slipped_) return command;
    motion.push(-f_T_W, state.p_WT);
    command.f_T_W = f_T_W;
    command.touch = {.in_contact = true,
                     .object = 0,
                     .feature = -1,
                     .depth = (p_WG - state.p_WT).norm(),
                     .p_WP = p_WG,
                     .n_W = u,
                     .hops = 0};
    return command;
  }

  std::unique_ptr<MovingTouch<Motion>> object_;
  Grip grip_;
  double step_;
  Eigen::Vector3d p_BG_{0, 0, 0};  // the held point
  bool held_ = false;
  bool slipped_ = false;
};

/// Returns the force law of an object that moves, held by the hand if the choice says so.
/// Real-time: never from the servo thread.
template <BodyMotion Motion>
std::unique_ptr<ObjectTouch> moving_touch(std::unique_ptr<ObjectTouch> surface,
                                          const Motion& motion, const MotionChoice& choice,
                                          const BodyCoupling& coupling) {
  auto object = std::make_unique<MovingTouch<Motion>>(std::move(surface), motion, coupling);
  if (!choice.grip) return object;
  return std::make_unique<HeldTouch<Motion>>(std::move(object), *choice.grip, coupling.step);
}

}  // namespace thimble::render
