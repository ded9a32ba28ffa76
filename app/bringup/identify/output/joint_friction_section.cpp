#include "bringup/identify/output/joint_friction_section.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace thimble::bringup {
namespace {

/// A friction joint by joint. None is negative; one that was not seen is zero, with its detection
/// limit as interval.
std::array<Estimate, 3> written(const Identified& found, bool seen, bool dry) {
  std::array<Estimate, 3> all;
  for (std::size_t i = 0; i < 3; ++i) {
    const Estimate one = dry ? found.joint_coulomb(i) : found.joint_viscous(i);
    const JointFrictionFit& rubbing = found.rubbing;
    all[i] = seen ? Estimate{std::max(0.0, one.value), one.plus_minus}
                  : Estimate{0, found.constants.gain[i].value *
                                    (dry ? rubbing.coulomb_below : rubbing.viscous_below)[i]};
  }
  return all;
}

}  // namespace

std::vector<TrainKey> joint_friction_keys(const YAML::Node& train, const Identified& found,
                                          const IdentifiedMark& mark) {
  const JointFrictionFit& rubbing = found.rubbing;
  std::vector<TrainKey> keys;
  if (!rubbing.searched) return keys;
  const auto has = [&train](const char* key) { return train && train[key]; };
  if (rubbing.seen || has("coulomb")) {
    keys.push_back(
        TrainKey::of("coulomb", "N m at the joints", written(found, rubbing.seen, true), mark));
  }
  if (rubbing.seen || has("viscous")) {
    keys.push_back(TrainKey::of("viscous", "N m s/rad at the joints",
                                written(found, rubbing.seen, false), mark));
  }
  return keys;
}

bool reads_joint_friction(const device_sim::DriveTrainSettings& read, const Identified& found) {
  const JointFrictionFit& rubbing = found.rubbing;
  if (!rubbing.searched) return true;
  const auto dry = written(found, rubbing.seen, true);
  const auto viscous = written(found, rubbing.seen, false);
  const auto near = [](double value, double wanted) {
    return std::abs(value - wanted) <= 1e-4 * wanted + 1e-12;
  };
  for (std::size_t i = 0; i < 3; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    if (!near(read.coulomb[k], dry[i].value) || !near(read.viscous[k], viscous[i].value)) {
      return false;
    }
  }
  return true;
}

}  // namespace thimble::bringup
