#include "recording/replayed_law.h"

#include <algorithm>

namespace thimble::session {

ReplayedLaw::ReplayedLaw(const Recording& recording, const scene::Scene& scene,
                         const scene::ArmFile& arm, render::SceneTouch& touch)
    : touch_(touch), weight_(arm.carried_weight) {
  const auto turned = [](const driver::TickRecord& tick) { return tick.setting >= 0; };
  if (std::any_of(recording.ticks.begin(), recording.ticks.end(), turned)) {
    knobs_.emplace(scene, touch);
    wanted_.resize(knobs_->described().size());
  }
  if (arm.carried_moments.isZero(0)) return;
  const scene::LinkGravity links = scene::link_gravity(arm);
  if (links.max_force > 0) links_ = links;
}

Eigen::Vector3d ReplayedLaw::carried(const driver::DeviceState& state) const {
  Eigen::Vector3d carried(0, 0, 0);
  if (links_) carried += links_->carried(state.q);
  if (weight_ > 0) carried += Eigen::Vector3d(0, 0, weight_);
  return carried;
}

driver::ForceCommand ReplayedLaw::operator()(const driver::DeviceState& state,
                                             const driver::TickRecord& then) {
  const auto setting = static_cast<std::size_t>(std::max<std::int16_t>(then.setting, 0));
  if (then.setting >= 0 && setting < wanted_.size()) {
    wanted_[setting] = then.setting_value;
    turning_ = true;
  }
  if (knobs_ && turning_) turning_ = knobs_->step(*this, last_, state.dt);
  driver::ForceCommand command = touch_(state);
  if (then.gain < 1) command.f_T_W *= then.gain;
  // Same order as in the run, so that the sum is bit-identical (RunLaw).
  if (links_) command.f_T_W += links_->carried(state.q);
  if (weight_ > 0) command.f_T_W += Eigen::Vector3d(0, 0, weight_);
  return command;
}

}  // namespace thimble::session
