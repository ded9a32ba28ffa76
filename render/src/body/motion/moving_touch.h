#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "body/motion/body_coupling.h"
#include "body/motion/body_frame.h"
#include "body/motion/moving_solid.h"
#include "thimble/driver/device_state.h"
#include "thimble/driver/force_law.h"
#include "thimble/render/body_pose.h"
#include "thimble/render/object_touch.h"

namespace thimble::render {

/// Motion of all base points of an object together [BP 4.3]. All of it is Real-time: safe.
///
/// `R_WB` and `p_WB` are the present frame B of the mesh (W before the first tick). `frame_after`
/// is the frame to which the present velocity leads within a time (s). `velocity_at` is the
/// velocity of a point of the body (m/s, our time). `gain_at` is the velocity that the point gains
/// per impulse given there (our time, m/s per N s). `push` takes a force for the next step. `step`
/// advances by s of our time. `energy` is that of its motion and height (J); it changes by the work
/// of pushes, and falls by losses.
template <class Motion>
concept BodyMotion = requires(Motion motion, const Motion& now, const Eigen::Vector3d& v) {
  { now.R_WB() }
  noexcept->std::convertible_to<Eigen::Matrix3d>;
  { now.p_WB() }
  noexcept->std::convertible_to<Eigen::Vector3d>;
  { now.frame_after(1e-3) }
  noexcept->std::same_as<BodyFrame>;
  { now.velocity_at(v) }
  noexcept->std::convertible_to<Eigen::Vector3d>;
  { now.gain_at(v, v) }
  noexcept->std::convertible_to<Eigen::Vector3d>;
  { motion.push(v, v) }
  noexcept;
  { motion.step(1e-3) }
  noexcept;
  { now.energy() }
  noexcept->std::same_as<double>;
};

/// The force law of an object that moves. The tip is transformed into the frame B of the object's
/// mesh and touches the resting mesh there; the force is transformed back. The opposite force acts
/// on the body at the tip, in the same tick and bit-identical.
///
/// Contact, texture, friction and dent use the motion of the tip relative to the surface, whichever
/// of the two moves. A path of the tip in B includes the body's path since the last tick, so a body
/// cannot pass through a resting tip. They use the body's place at the end of the tick according to
/// its velocity, and the force is scaled by shared_force(). Together this is the whole implicit
/// step, which is stable for any mass and creates no energy, with and without damping
/// (body_coupling.h). The body advances by the loop's period in every tick, so it waits for a loop
/// that stalls, and every run is repeatable.
template <BodyMotion Motion>
class MovingTouch final : public ObjectTouch {
 public:
  /// Wraps an object's force law, made for the mesh at its first place. Real-time: never from the
  /// servo thread.
  MovingTouch(std::unique_ptr<ObjectTouch> surface, Motion motion, const BodyCoupling& coupling)
      : surface_(std::move(surface)), motion_(std::move(motion)), coupling_(coupling) {
    if (const auto solids = surface_->solids(); solids.size() == 1) {
      solid_.emplace(*this, *solids.front());
      solid_pointer_ = &*solid_;
    }
  }

  driver::ForceCommand update(const driver::DeviceState& state) noexcept override {
    const auto [R_WB, p_WB] = motion_.frame_after(coupling_.step);
    driver::DeviceState in_B = state;
    in_B.p_WT = R_WB.transpose() * (state.p_WT - p_WB);
    in_B.v_WT = R_WB.transpose() * (state.v_WT - motion_.velocity_at(state.p_WT));
    driver::ForceCommand command = surface_->update(in_B);
    count_lost(command.touch.in_contact, in_B.p_WT);
    command.f_T_W = share(R_WB * command.f_T_W, state.p_WT);
    command.stored += motion_.energy();
    if (command.touch.in_contact) {
      command.touch.p_WP = p_WB + R_WB * command.touch.p_WP;
      command.touch.n_W = R_WB * command.touch.n_W;
    }
    motion_.step(coupling_.step);
    return command;
  }

  bool inside(const Eigen::Vector3d& p_W) const noexcept override {
    return surface_->inside(motion_.R_WB().transpose() * (p_W - motion_.p_WB()));
  }
  std::span<WorldSolid* const> solids() noexcept override {
    return {&solid_pointer_, solid_ ? std::size_t{1} : std::size_t{0}};
  }
  bool is_static() const noexcept override { return false; }
  bool stands_still() const noexcept override { return is_static(); }  // deprecated
  std::uint64_t lost_contacts() const noexcept override { return lost_; }
  BodyPose pose() const noexcept override {
    const Eigen::Quaterniond q(motion_.R_WB());
    const Eigen::Vector3d p = motion_.p_WB();
    return {.p_WB = {p.x(), p.y(), p.z()}, .q_WB = {q.w(), q.x(), q.y(), q.z()}};
  }
  const ContactMesh* mesh() const noexcept override { return surface_->mesh(); }
  /// Draws in B; the caller moves the drawing to `pose`.
  bool draw(BodyPatch& patch) noexcept override { return surface_->draw(patch); }
  const BodyShape* shape() const noexcept override { return surface_->shape(); }
  void place_now(std::span<Eigen::Vector3d> vertices) const noexcept override {
    surface_->place_now(vertices);
    for (Eigen::Vector3d& p : vertices) p = motion_.p_WB() + motion_.R_WB() * p;
  }
  void mesh_now(std::vector<Eigen::Vector3d>& vertices,
                std::vector<std::array<std::int32_t, 3>>& triangles) const override {
    surface_->mesh_now(vertices, triangles);
    for (Eigen::Vector3d& p : vertices) p = motion_.p_WB() + motion_.R_WB() * p;
  }

  /// The coupling assumes a surface no stiffer than when it was built.
  void list_settings(LiveSettings& settings) override {
    LiveSettings own(0, 0);
    surface_->list_settings(own);
    settings.take(own);
  }

  const Motion& motion() const noexcept { return motion_; }
  /// Returns the motion, for callers that hold the body by other means than its surface. Real-time:
  /// safe.
  Motion& motion() noexcept { return motion_; }
  const ObjectTouch& surface() const noexcept { return *surface_; }

 private:
  friend class MovingSolid<MovingTouch>;

  // The parts of `update`, for a world of several solids.
  BodyFrame frame_of_tick() const noexcept { return motion_.frame_after(coupling_.step); }
  Eigen::Vector3d velocity_in_B(const BodyFrame& frame,
                                const driver::DeviceState& state) const noexcept {
    return frame.R_WB.transpose() * (state.v_WT - motion_.velocity_at(state.p_WT));
  }
  double end_tick(bool touching, const Eigen::Vector3d& p_B) noexcept {
    count_lost(touching, p_B);
    const double stored = motion_.energy();
    motion_.step(coupling_.step);
    return stored;
  }

  // Returns the hand's share of the surface's force and pushes the body with the opposite.
  Eigen::Vector3d share(const Eigen::Vector3d& f_W, const Eigen::Vector3d& p_WT) noexcept {
    const double size = f_W.norm();
    // Written so that NaN means no force.
    if (!(size > 0)) return Eigen::Vector3d::Zero();
    const Eigen::Vector3d u = f_W / size;
    Eigen::Vector3d shared = shared_force(coupling_, u, motion_.gain_at(p_WT, u)) * f_W;
    if (!shared.allFinite()) return Eigen::Vector3d::Zero();
    motion_.push(-shared, p_WT);
    return shared;
  }

  // A contact that ends while the tip is inside has been lost.
  void count_lost(bool touching, const Eigen::Vector3d& p_BT) noexcept {
    if (was_touching_ && !touching && surface_->inside(p_BT)) ++lost_;
    was_touching_ = touching;
  }

  std::unique_ptr<ObjectTouch> surface_;
  Motion motion_;
  BodyCoupling coupling_;
  bool was_touching_ = false;
  std::uint64_t lost_ = 0;
  std::optional<MovingSolid<MovingTouch>> solid_;
  WorldSolid* solid_pointer_ = nullptr;
};

}  // namespace thimble::render
