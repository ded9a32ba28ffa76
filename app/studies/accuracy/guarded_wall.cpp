#include "studies/accuracy/guarded_wall.h"

namespace thimble::studies {
namespace {

using driver::EnergyStage;
using Eigen::Vector3d;

driver::SafetyGate gate_of(const WallGuard& guard) {
  const driver::GateLimits limits{.force_max = 100,
                                  .speed_max = 100,
                                  .rise_max = 1e9,
                                  .soft_start = 1e-9,
                                  .stall_ns = 1'000'000'000,
                                  .watchdog_ns = 2'000'000'000};
  driver::EnergyGuardSettings settings;
  settings.stage = guard.stage;
  settings.mass = GuardedArm::kMass;
  settings.allowance = guard.allowance;
  settings.reservoir = 0.01;  // J
  settings.onset = guard.onset;
  settings.slope = 2 * GuardedArm::kViscous / GuardedArm::kTick;  // passive [PHYSICS 1.6]
  return driver::SafetyGate(limits, settings);
}

}  // namespace

GuardedWall::GuardedWall(const WallGuard& guard, double stiffness)
    : gate_(gate_of(guard)), guard_(guard), stiffness_(stiffness) {
  gate_.restart();
  if (!(guard.counted_on > 0)) return;
  spring_ = 2 * guard.counted_on / GuardedArm::kTick / 1.1;
  damper_ = (guard.counted_on - spring_ * GuardedArm::kTick / 2) / 1.2;
}

double GuardedWall::force(double depth) noexcept {
  const double sent = guard_.counted_on > 0 ? coupled(depth) : gated(depth);
  last_depth_ = depth;
  begun_ = true;
  return sent;
}

double GuardedWall::gated(double depth) noexcept {
  const Vector3d move(0, 0, begun_ ? last_depth_ - depth : 0);
  const Vector3d wanted(0, 0, depth > 0 ? stiffness_ * depth : 0);
  const double dt = begun_ ? GuardedArm::kTick : 0;
  const Vector3d v = move / GuardedArm::kTick;
  sent_ = guard_.stage == EnergyStage::kNone
              ? gate_.pass(wanted, v, dt).f_T_W()
              : gate_
                    .pass_guarded(wanted, v, dt,
                                  {.work = sent_.dot(move), .move_W = move, .f_sent_W = sent_})
                    .f_T_W();
  return sent_.z();
}

double GuardedWall::coupled(double depth) noexcept {
  const double moved = begun_ ? depth - last_depth_ : 0;
  const double rate = damper_ / GuardedArm::kTick;
  const double pull = spring_ * depth + rate * (moved + last_point_);
  // The point without the wall, and with it.
  double point = pull / (spring_ + rate);
  double sent = 0;
  if (point > 0) {
    point = pull / (spring_ + rate + stiffness_);
    sent = stiffness_ * point;
  }
  last_point_ = point;
  return sent;
}

}  // namespace thimble::studies
