#include "bringup/identify/output/identified_further.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "bringup/identify/output/cogging_section.h"
#include "bringup/identify/output/file_lines.h"
#include "bringup/identify/output/joint_friction_section.h"
#include "math/elementary.h"
#include "read_scene.h"
#include "yaml/yaml_reader.h"

namespace thimble::bringup {
namespace {

// Ratio of width to RMS of a uniform distribution.
const double kWidth = std::sqrt(12.0);
// s, RMS below which nothing is written [chosen: a hundredth of the visible effect in a tick].
constexpr double kJitterMin = 1e-6;

std::int64_t ns(double s) {
  return std::llround(1e9 * s);
}

/// Writes further constants into the lines of one file.
class Further {
 public:
  Further(const YAML::Node& root, const scene::ArmFile& file, const Identified& found,
          const IdentifiedMark& mark, FileLines& lines)
      : simulation_(root["simulation"]),
        exchanged_(root["joints"] && root["joints"]["torque_constant"]),
        file_(file),
        found_(found),
        mark_(mark),
        lines_(lines) {}

  bool put() { return put_link() && put_saturation() && write_friction_comments() && put_train(); }

  /// Returns whether a file that was read back has the written values.
  bool agrees(const scene::ArmFile& read) const {
    const auto& firmware = read.simulated.firmware;
    const auto& wire = read.simulated.wire;
    // Values are written with six digits.
    return std::abs(firmware.report_period_ns - ns(period_)) <= ns(1e-5 * period_) + 1 &&
           std::abs(firmware.watchdog_ns - ns(watchdog_)) <= ns(1e-5 * watchdog_) + 1 &&
           std::abs(wire.jitter_ns - ns(jitter_)) <= ns(1e-5 * jitter_) + 1 &&
           (file_.is<driver::DeltaArm>() ||
            (reads_cogging(read.simulated.drive_train, found_) &&
             reads_joint_friction(read.simulated.drive_train, found_)));
  }

 private:
  bool exchange(const YAML::Node& node, double value, const std::string& unit, double plus_minus) {
    return node && lines_.exchange(node, marked(value, unit, plus_minus, mark_));
  }

  bool put_link() {
    const YAML::Node firmware = simulation_["firmware"], wire = simulation_["wire"];
    period_ = 1e-9 * static_cast<double>(file_.simulated.firmware.report_period_ns);
    watchdog_ = 1e-9 * static_cast<double>(file_.simulated.firmware.watchdog_ns);
    jitter_ = 1e-9 * static_cast<double>(file_.simulated.wire.jitter_ns);
    // The board of a Falcon is code, which no file changes.
    if (file_.is<driver::DeltaArm>()) return true;
    double jitter_error = 0;
    const bool answers = found_.watchdog && found_.watchdog->last.end == WatchdogEnd::kAnswersOnly;
    // The report rate of an arm that sends only when asked depends on the host.
    const bool timed =
        found_.reports && found_.reports->period.value > 0 && !found_.reports->blurred && !answers;
    if (timed) {
      const ReportTiming& reports = *found_.reports;
      period_ = 1e-9 * static_cast<double>(ns(reports.period.value));
      const bool seen = reports.jitter.value > std::max(kJitterMin, reports.jitter.plus_minus);
      jitter_ = seen ? kWidth * reports.jitter.value : 0;
      jitter_error = kWidth * reports.jitter.plus_minus;
      if (!exchange(firmware["report_period"], period_, "s", reports.period.plus_minus)) {
        return false;
      }
    }
    if (found_.watchdog && found_.watchdog->known()) {
      const Estimate& time = found_.watchdog->time;
      watchdog_ = time.value;
      if (!exchange(firmware["watchdog"], watchdog_, "s after the last message", time.plus_minus)) {
        return false;
      }
    }
    return !timed || put_jitter(wire, jitter_error);
  }

  /// The measured delay includes the jitter, so a wire without the key gets a line to add it.
  bool put_jitter(const YAML::Node& wire, double jitter_error) {
    const std::string spread = marked(jitter_, "s, evenly spread", jitter_error, mark_);
    if (wire["jitter"]) {
      // Half of it is in the mean of each direction.
      const Estimate& delay = found_.constants.delay;
      const double in = 1e-9 * static_cast<double>(file_.simulated.wire.delay_in_ns);
      const double out = std::max(0.0, delay.value - std::min(delay.value, in) - jitter_);
      return lines_.exchange(wire["jitter"], spread) &&
             lines_.exchange(wire["delay_out"],
                             marked(1e-9 * static_cast<double>(ns(out)),
                                    "s; the sum of both, with the jitter, is measured",
                                    delay.plus_minus, mark_));
    }
    const double seen = jitter_;
    jitter_ = 0;
    return seen == 0 ||
           lines_.add_behind(wire["delay_out"],
                             "# jitter: " + spread + "; not simulated unless you add it");
  }

  bool put_saturation() {
    std::string all;
    double lowest = HUGE_VAL, error = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const Saturation& one = found_.saturation[i];
      if (!one.seen) continue;
      const driver::MotorDrive drive = asked_with(i);
      const double ampere = 1 / (drive.ratio * drive.torque_constant);
      all += fmt::format("{}motor {}: {:.3g}", all.empty() ? "" : ", ", i + 1,
                         ampere * one.max_torque.value);
      if (ampere * one.max_torque.value < lowest) {
        lowest = ampere * one.max_torque.value, error = ampere * one.max_torque.plus_minus;
      }
    }
    if (all.empty()) return true;
    return exchange(simulation_["motors"]["current_max"], lowest,
                    "A, the lowest saturation of all motors (" + all + ")", error);
  }

  /// Writes cogging, ripple and friction of joints. The drive train of a delta arm is not
  /// simulated, so these are comments.
  bool put_train() {
    if (!file_.is<driver::DeltaArm>()) {
      const YAML::Node train = simulation_["drive_train"];
      std::vector<TrainKey> keys = cogging_keys(train, found_, mark_);
      for (TrainKey& key : joint_friction_keys(train, found_, mark_))
        keys.push_back(std::move(key));
      return put_train_keys(simulation_, keys, lines_);
    }
    for (const TrainKey& key : joint_friction_keys({}, found_, mark_)) {
      if (!lines_.add_behind(simulation_["tip"]["coulomb"], "# " + key.name +
                                                                " of joints: " + key.value + "  " +
                                                                key.remark + ": not simulated")) {
        return false;
      }
    }
    for (std::size_t i = 0; found_.waves.is_reported() && i < 3; ++i) {
      if (!found_.waves.cogging[i].seen) continue;
      const Estimate cogging = cogging_at_motor(found_.waves, i, found_.constants.gain[i]);
      if (!lines_.add_behind(
              simulation_["tip"]["coulomb"],
              fmt::format("# {:.3g} N m cogging of motor {}, {:g} periods in a turn [I {}, {}, +- "
                          "{:.2g}]: not simulated",
                          cogging.value, i + 1, found_.waves.periods, mark_.date, mark_.arm,
                          cogging.plus_minus))) {
        return false;
      }
    }
    return true;
  }

  bool write_friction_comments() {
    const FrictionDirections& friction = found_.friction;
    const auto write_comment = [&](const std::string& where, const Estimate& value) {
      return lines_.add_behind(
          simulation_["tip"]["coulomb"],
          fmt::format("# {:.3g} N along {} of the base [I {}, {}, +- {:.2g}]: not simulated",
                      value.value, where, mark_.date, mark_.arm, value.plus_minus));
    };
    for (std::size_t i = 0; i < 3; ++i) {
      const Estimate &mean = friction.mean[i], &uneven = friction.uneven[i];
      const std::string axis(1, "xyz"[i]);
      if (friction.directions_differ && friction.is_observable(static_cast<int>(i))) {
        const double error = math::hypot(mean.plus_minus, uneven.plus_minus);
        if (!write_comment("+" + axis, {mean.value - uneven.value, error}) ||
            !write_comment("-" + axis, {mean.value + uneven.value, error})) {
          return false;
        }
      } else if (friction.axes_differ || friction.directions_differ) {
        if (!write_comment(axis, mean)) return false;
      }
    }
    return true;
  }

  /// Returns the drive with the constants used for the requested torques: before they were
  /// replaced.
  driver::MotorDrive asked_with(std::size_t i) const {
    driver::MotorDrive drive = file_.model.drives[i];
    if (exchanged_) drive.torque_constant /= found_.constants.gain[i].value;
    return drive;
  }

  YAML::Node simulation_;
  bool exchanged_;  // whether the torque constants were; those of some arms are built in
  const scene::ArmFile& file_;
  const Identified& found_;
  const IdentifiedMark& mark_;
  FileLines& lines_;
  double period_ = 0, watchdog_ = 0, jitter_ = 0;  // s, as written to the file
};

driver::Error bad_form() {
  return driver::Error{
      "The arm file has no sections firmware, wire and motors with values that can be replaced. "
      "Write each key on a separate line, as in app/arms/vintage_phantom.yaml."};
}

}  // namespace

driver::Result<std::string> further_text(const std::string& text, const Identified& found,
                                         const IdentifiedMark& mark) {
  YAML::Node root;
  try {
    root = YAML::Load(text);
  } catch (const YAML::Exception& wrong) {
    return driver::Error{std::string("The arm file is not valid YAML: ") + wrong.what()};
  }
  auto was = scene::YamlFile::parse(text, "arm file");
  if (!was) return was.error();
  const auto before = scene::read_arm(*was);
  if (!before) return before.error();
  const YAML::Node simulation = root["simulation"];
  if (!simulation || !simulation["wire"] || !simulation["firmware"]) return text;
  FileLines lines(text);
  Further further(root, *before, found, mark, lines);
  if (!further.put()) return bad_form();
  const std::string written = lines.text();
  auto yaml = scene::YamlFile::parse(written, "identified arm file");
  if (!yaml) return yaml.error();
  const auto read = scene::read_arm(*yaml);
  if (!read) return read.error();
  if (!further.agrees(*read)) return bad_form();
  return written;
}

}  // namespace thimble::bringup
