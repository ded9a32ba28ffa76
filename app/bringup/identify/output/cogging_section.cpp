#include "bringup/identify/output/cogging_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace thimble::bringup {
namespace {

/// One key of the section: a value for each motor.
struct CoggingKey {
  const char* name;
  const char* unit;
  std::array<Estimate, 3> values;
};

/// The values of the keys; a wave that was not seen is zero, with its detection limit as interval.
std::vector<CoggingKey> keys_of(const Identified& found) {
  const MotorCogging& waves = found.waves;
  std::vector<CoggingKey> keys{{"cogging", "N m at the motor", {}},
                               {"cogging_phase", "rad where the joint's angle is zero", {}},
                               {"ripple", "of the torque constant", {}},
                               {"ripple_phase", "rad where the joint's angle is zero", {}}};
  for (std::size_t i = 0; i < 3; ++i) {
    const Estimate& gain = found.constants.gain[i];
    const double at_motor = gain.value / waves.ratio[static_cast<Eigen::Index>(i)];
    const TorqueVariation &cogging = waves.cogging[i], &ripple = waves.ripple[i];
    keys[0].values[i] = cogging.seen ? cogging_at_motor(waves, i, gain)
                                     : Estimate{0, at_motor * cogging.below_of_any};
    if (cogging.seen) keys[1].values[i] = cogging.phase;
    keys[2].values[i] = ripple.seen ? ripple.amplitude : Estimate{0, ripple.below_of_any};
    if (ripple.seen) keys[3].values[i] = ripple.phase;
  }
  return keys;
}

bool is_written(const Identified& found, const YAML::Node& train) {
  const MotorCogging& waves = found.waves;
  if (waves.is_reported()) return true;
  return waves.searched && !waves.seen() && train && (train["cogging"] || train["ripple"]);
}

}  // namespace

std::vector<TrainKey> cogging_keys(const YAML::Node& train, const Identified& found,
                                   const IdentifiedMark& mark) {
  std::vector<TrainKey> keys;
  if (!is_written(found, train)) return keys;
  for (const CoggingKey& key : keys_of(found)) {
    keys.push_back(TrainKey::of(key.name, key.unit, key.values, mark));
  }
  if (found.waves.is_reported()) {
    keys.push_back(
        {.name = "periods_per_turn",
         .value = fmt::format("{:g}", found.waves.periods),
         .remark = fmt::format("in a turn of the motor [I {}, {}]", mark.date, mark.arm)});
  }
  return keys;
}

bool reads_cogging(const device_sim::DriveTrainSettings& read, const Identified& found) {
  if (!found.waves.is_reported()) {
    return !found.waves.searched || found.waves.seen() ||
           (read.cogging.isZero(0) && read.ripple.isZero(0));
  }
  const auto near = [](double value, double wanted) {
    return std::abs(value - wanted) <= 1e-4 * std::abs(wanted) + 1e-12;
  };
  const std::vector<CoggingKey> keys = keys_of(found);
  bool right = near(read.periods_per_turn, found.waves.periods);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    right = right && near(read.cogging[k], keys[0].values[i].value) &&
            near(read.cogging_phase[k], keys[1].values[i].value) &&
            near(read.ripple[k], keys[2].values[i].value) &&
            near(read.ripple_phase[k], keys[3].values[i].value);
  }
  return right;
}

}  // namespace thimble::bringup
