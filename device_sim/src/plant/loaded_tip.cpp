#include "plant/loaded_tip.h"

namespace thimble::device_sim {

driver::Result<LoadedTip> LoadedTip::make(const PlantSettings& bare, const HandSettings& hand,
                                          const Eigen::Vector3d& weight_B) {
  const auto free = AxisDynamics::make(bare, {});
  if (!free) return free.error();
  LoadedTip tip(bare, *free, *free, weight_B);
  if (auto taken = tip.take_hand(hand); !taken) return taken.error();
  return tip;
}

driver::Result<void> LoadedTip::fix_mass(double mass, const Eigen::Vector3d& gravity_B) {
  // Written so that NaN is rejected.
  if (!(mass >= 0) || !gravity_B.allFinite()) {
    return driver::Error{"The mass fixed to the tip must be finite and at least 0 kg."};
  }
  PlantSettings loaded = loaded_;
  loaded.mass = bare_mass_ + mass;
  const auto held = AxisDynamics::make(loaded, hand_);
  if (!held) return held.error();
  const auto free = AxisDynamics::make(loaded, {});
  if (!free) return free.error();
  loaded_ = loaded;
  held_ = *held;
  free_ = *free;
  pull_B_ = weight_B_ + mass * gravity_B;
  return {};
}

driver::Result<void> LoadedTip::take_hand(const HandSettings& hand) {
  const auto held = AxisDynamics::make(loaded_, hand);
  if (!held) return held.error();
  hand_ = hand;
  held_ = *held;
  return {};
}

}  // namespace thimble::device_sim
