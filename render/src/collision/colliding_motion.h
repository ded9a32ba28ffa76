#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <utility>

#include "collision/collision_world.h"

namespace thimble::render {

/// One hand's side of a body of a CollisionWorld, as a BodyMotion. `gain_at` assumes that every
/// hand pushes at the same point, as SharedMotion. All of it is Real-time: safe.
class CollidingMotion {
 public:
  /// Keeps the world. Real-time: never from the servo thread.
  CollidingMotion(std::shared_ptr<CollisionWorld> world, std::size_t body, std::size_t hand)
      : world_(std::move(world)), body_(body), hand_(hand) {}

  Eigen::Matrix3d R_WB() const noexcept { return motion().R_WB(); }
  Eigen::Vector3d p_WB() const noexcept { return motion().p_WB(); }
  BodyFrame frame_after(double time) const noexcept { return motion().frame_after(time); }
  Eigen::Vector3d velocity_at(const Eigen::Vector3d& p_W) const noexcept {
    return motion().velocity_at(p_W);
  }
  Eigen::Vector3d gain_at(const Eigen::Vector3d& p_W,
                          const Eigen::Vector3d& impulse) const noexcept {
    return static_cast<double>(world_->hands()) * world_->gain_at(body_, p_W, impulse);
  }
  void push(const Eigen::Vector3d& f_W, const Eigen::Vector3d& p_W) noexcept {
    world_->push(hand_, body_, f_W, p_W);
  }
  /// Returns the energy of all bodies for the first body, and 0 for the others: the energies of the
  /// objects of a hand are added.
  double energy() const noexcept { return body_ == 0 ? world_->energy_for(hand_) : 0; }
  void step(double step) noexcept { world_->end_of_body(step); }

 private:
  const RigidMotion& motion() const noexcept { return std::as_const(*world_).motion(body_); }

  std::shared_ptr<CollisionWorld> world_;
  std::size_t body_;
  std::size_t hand_;
};

}  // namespace thimble::render
