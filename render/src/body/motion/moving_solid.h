#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "body/motion/body_frame.h"
#include "thimble/driver/device_state.h"
#include "thimble/driver/force_law.h"
#include "thimble/render/contact_state.h"
#include "world_solid.h"

namespace thimble::render {

/// WorldSolid over the one of an object at rest that moves as a whole. `Owner` is a MovingTouch: it
/// takes the force of the surface and moves the body. The proxy is touched in the frame B of the
/// mesh; B is that of the end of the tick, as in MovingTouch.
template <class Owner>
class MovingSolid final : public WorldSolid {
 public:
  /// Keeps references. Real-time: never from the servo thread.
  MovingSolid(Owner& owner, WorldSolid& surface) noexcept
      : owner_(owner),
        surface_(surface),
        keeps_shape_(!surface.changes()),
        p_B_centre_((surface.box().min + surface.box().max) / 2) {
    if (keeps_shape_ && !surface.moves()) {
      radius_ = kMargin * (surface.box().max - p_B_centre_).norm() + surface.rounding();
    }
  }

  SolidBox box() const noexcept override { return surface_.box(); }
  double rounding() const noexcept override { return surface_.rounding(); }
  double stiffness() const noexcept override { return surface_.stiffness(); }
  bool changes() const noexcept override { return true; }
  bool moves() const noexcept override { return true; }
  bool follows_closely() const noexcept override { return surface_.follows_closely(); }
  void prepare_fallback() override { surface_.prepare_fallback(); }
  bool inside(const Eigen::Vector3d& p_W) const noexcept override {
    return surface_.inside(to_B(p_W));
  }

  SolidMove begin_tick(const driver::DeviceState& state, const Eigen::Vector3d& p_WP,
                       bool touching) noexcept override {
    const BodyFrame before = frame_;
    frame_ = owner_.frame_of_tick();
    p_WT_ = state.p_WT;
    const Eigen::Vector3d p_BP = to_B(p_WP);
    SolidMove move;
    if (!keeps_shape_) {
      driver::DeviceState in_B = state;
      in_B.p_WT = to_B(state.p_WT);
      in_B.v_WT = owner_.velocity_in_B(frame_, state);
      move = surface_.begin_tick(in_B, p_BP, touching);
    }
    if (moved_) {
      const Eigen::Vector3d p_BP_before = before.R_WB.transpose() * (p_WP - before.p_WB);
      const double path = (p_BP - p_BP_before).norm();
      move.path += path;
      // Written so that an infinite radius is near.
      const bool far = (p_BP - p_B_centre_).norm() > radius_ + kMargin * path;
      if (!touching && move.swept_over < 0 && !far) {
        const SolidEntry entry = surface_.first_entry(p_BP_before, p_BP);
        move.swept_over = entry.triangle;
        move.p_WP = p_BP_before + entry.parameter * (p_BP - p_BP_before);
      }
    }
    moved_ = true;
    move.p_WP = to_W(move.p_WP);
    move.p_centre = to_W(p_B_centre_);
    move.radius = radius_;
    return move;
  }
  double end_tick(const Eigen::Vector3d& p_WP, bool touching) noexcept override {
    const double stored = keeps_shape_ ? 0 : surface_.end_tick(to_B(p_WP), touching);
    return stored + owner_.end_tick(touching, p_B_followed_);
  }

  SolidEntry first_entry(const Eigen::Vector3d& p_from,
                         const Eigen::Vector3d& p_to) noexcept override {
    return surface_.first_entry(to_B(p_from), to_B(p_to));
  }
  const ContactState& begin(std::int32_t triangle, const Eigen::Vector3d& p_WP) noexcept override {
    return in_W(surface_.begin(triangle, to_B(p_WP)));
  }
  void revive(const Eigen::Vector3d& p_WP) noexcept override { surface_.revive(to_B(p_WP)); }
  const ContactState& follow(const Eigen::Vector3d& p_W) noexcept override {
    p_B_followed_ = to_B(p_W);
    return in_W(surface_.follow(p_B_followed_));
  }
  const ContactState& follow_closely(const ContactState& last,
                                     const Eigen::Vector3d& p_W) noexcept override {
    p_B_followed_ = to_B(p_W);
    return in_W(surface_.follow_closely(in_B(last), p_B_followed_));
  }
  std::size_t holding_faces(std::array<Eigen::Vector3d, 3>& n_W) const noexcept override {
    const std::size_t count = surface_.holding_faces(n_W);
    for (std::size_t i = 0; i < count; ++i) n_W[i] = frame_.R_WB * n_W[i];
    return count;
  }
  driver::ForceCommand feel(const driver::DeviceState& state,
                            const ContactState& contact) noexcept override {
    driver::DeviceState there = state;
    there.p_WT = to_B(state.p_WT);
    there.v_WT = owner_.velocity_in_B(frame_, state);
    driver::ForceCommand command = surface_.feel(there, in_B(contact));
    // The body is pushed at the tip, so that angular momentum is kept.
    command.f_T_W = owner_.share(frame_.R_WB * command.f_T_W, p_WT_);
    if (command.touch.in_contact) {
      command.touch.p_WP = to_W(command.touch.p_WP);
      command.touch.n_W = frame_.R_WB * command.touch.n_W;
    }
    return command;
  }
  void leave() noexcept override { surface_.leave(); }

 private:
  Eigen::Vector3d to_B(const Eigen::Vector3d& p_W) const noexcept {
    return frame_.R_WB.transpose() * (p_W - frame_.p_WB);
  }
  Eigen::Vector3d to_W(const Eigen::Vector3d& p_B) const noexcept {
    return frame_.p_WB + frame_.R_WB * p_B;
  }
  ContactState in_B(const ContactState& contact) const noexcept {
    ContactState turned = contact;
    turned.n_W = frame_.R_WB.transpose() * contact.n_W;
    turned.p_WP = to_B(contact.p_WP);
    return turned;
  }
  const ContactState& in_W(const ContactState& contact_B) noexcept {
    found_ = contact_B;
    found_.n_W = frame_.R_WB * contact_B.n_W;
    found_.p_WP = to_W(contact_B.p_WP);
    return found_;
  }

  static constexpr double kMargin = 1 + 0x1p-20;  // covers the rounding of lengths

  Owner& owner_;
  WorldSolid& surface_;
  bool keeps_shape_;  // whether `surface_` need not be called in each tick
  // Ball around the solid in B, m.
  Eigen::Vector3d p_B_centre_;
  double radius_ = std::numeric_limits<double>::infinity();
  BodyFrame frame_;  // at the end of this tick
  bool moved_ = false;
  Eigen::Vector3d p_WT_{0, 0, 0};
  Eigen::Vector3d p_B_followed_{0, 0, 0};
  ContactState found_;  // W
};

}  // namespace thimble::render
