#include "bringup/identify/new_file/waves_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace thimble::app {
namespace {

/// One key of the section: a value for each motor.
struct WaveKey {
  const char* name;
  const char* unit;
  std::array<Estimate, 3> values;

  std::string value() const {
    return fmt::format("[{:.5g}, {:.5g}, {:.5g}]", values[0].value, values[1].value,
                       values[2].value);
  }
  std::string remark(const IdentifiedMark& mark) const {
    return fmt::format("{} [I {}, {}, +- {:.2g}, {:.2g}, {:.2g}]", unit, mark.date, mark.arm,
                       values[0].plus_minus, values[1].plus_minus, values[2].plus_minus);
  }
};

/// What the keys say; a wave that was not seen is none, and its interval what would have been.
std::vector<WaveKey> keys_of(const Identified& found) {
  const MotorWaves& waves = found.waves;
  std::vector<WaveKey> keys{{"cogging", "N m at the motor", {}},
                            {"cogging_phase", "rad where the joint's angle is zero", {}},
                            {"ripple", "of the torque constant", {}},
                            {"ripple_phase", "rad where the joint's angle is zero", {}}};
  for (std::size_t i = 0; i < 3; ++i) {
    const Estimate& gain = found.constants.gain[i];
    const double at_motor = gain.value / waves.ratio[static_cast<Eigen::Index>(i)];
    const MotorWave &cogging = waves.cogging[i], &ripple = waves.ripple[i];
    keys[0].values[i] = cogging.seen ? cogging_at_motor(waves, i, gain)
                                     : Estimate{0, at_motor * cogging.below_of_any};
    if (cogging.seen) keys[1].values[i] = cogging.phase;
    keys[2].values[i] = ripple.seen ? ripple.amplitude : Estimate{0, ripple.below_of_any};
    if (ripple.seen) keys[3].values[i] = ripple.phase;
  }
  return keys;
}

bool is_written(const Identified& found, const YAML::Node& train) {
  const MotorWaves& waves = found.waves;
  if (waves.told()) return true;
  return waves.searched && !waves.seen() && train && (train["cogging"] || train["ripple"]);
}

std::string periods_text(const Identified& found) {
  return fmt::format("{:g}", found.waves.periods);
}

}  // namespace

bool put_waves(const YAML::Node& simulation, const Identified& found, const IdentifiedMark& mark,
               FileLines& lines) {
  const YAML::Node train = simulation["drive_train"];
  if (!is_written(found, train)) return true;
  const std::string in_turn = fmt::format("in a turn of the motor [I {}, {}]", mark.date, mark.arm);
  const bool seen = found.waves.told();
  if (train && train.Style() == YAML::EmitterStyle::Flow) {
    YAML::Node changed = YAML::Clone(train);
    std::string marks;
    for (const WaveKey& key : keys_of(found)) {
      changed[key.name] = YAML::Load(key.value());
      marks += fmt::format("{}{}: {}", marks.empty() ? "" : "; ", key.name, key.remark(mark));
    }
    if (seen) {
      changed["periods_per_turn"] = periods_text(found);
      marks += "; periods_per_turn: " + in_turn;
    }
    changed.SetStyle(YAML::EmitterStyle::Flow);
    return lines.exchange(train, YAML::Dump(changed) + "  # " + marks);
  }
  std::vector<std::string> section;
  const auto put = [&](const char* name, const std::string& text) {
    if (train && train[name]) return lines.exchange(train[name], text);
    section.push_back(fmt::format("{}: {}", name, text));
    return true;
  };
  bool done = true;
  for (const WaveKey& key : keys_of(found)) {
    done = done && put(key.name, key.value() + "  # " + key.remark(mark));
  }
  if (seen) done = done && put("periods_per_turn", periods_text(found) + "  # " + in_turn);
  if (!done || section.empty()) return done;
  if (train) return train.size() > 0 && lines.add_before(train.begin()->first, section);
  for (std::string& line : section) line = "  " + line;
  section.insert(section.begin(), "drive_train:");
  for (const auto& entry : simulation) {
    if (entry.first.as<std::string>() == "tip") return lines.add_before(entry.first, section);
  }
  return false;
}

bool reads_waves(const device_sim::DriveTrainSettings& read, const Identified& found) {
  if (!found.waves.told()) {
    return !found.waves.searched || found.waves.seen() ||
           (read.cogging.isZero(0) && read.ripple.isZero(0));
  }
  const auto near = [](double value, double wanted) {
    return std::abs(value - wanted) <= 1e-4 * std::abs(wanted) + 1e-12;
  };
  const std::vector<WaveKey> keys = keys_of(found);
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

}  // namespace thimble::app
