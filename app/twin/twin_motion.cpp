#include "twin/twin_motion.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "read_scene.h"
#include "twin/unseen_constants.h"
#include "yaml/yaml_reader.h"

namespace thimble::twin {
namespace {

constexpr double kSameTip = 0.5e-3;  // m, allowed difference between a tip and its joint angles
constexpr double kShortest = 2;      // s of motion under forces that a comparison needs
constexpr double kForceSeen = 0.05;  // N (rms), below which a recording holds no force

Eigen::Vector3d vector_of(const std::array<double, 3>& numbers) {
  return {numbers[0], numbers[1], numbers[2]};
}

/// The arm's description in the recording: its torque constants convert forces to the sent
/// currents.
driver::Result<scene::ArmFile> arm_of(const session::RecordingInfo& info) {
  auto yaml = scene::YamlFile::parse(info.arm_text, "arm file in the recording");
  if (!yaml) return yaml.error();
  return scene::read_arm(*yaml);
}

driver::Result<void> check_file(const scene::ArmFile& file) {
  if (!file.can_simulate || file.is<driver::DeltaArm>()) {
    return driver::Error{fmt::format(
        "The arm {} has no twin. A twin needs a file of an arm with joint motors, other "
        "than a Falcon, with a section `simulation`.",
        file.name)};
  }
  const auto& wire = file.simulated.wire;
  if (1e-9 * static_cast<double>(wire.delay_in_ns + wire.delay_out_ns) >
      TwinMotion::kLead - 0.003) {
    return driver::Error{
        fmt::format("The delays of the arm file exceed {:g} ms, the maximum for a twin.",
                    1e3 * (TwinMotion::kLead - 0.003))};
  }
  return {};
}

class Reader {
 public:
  Reader(const session::Recording& recording, const scene::ArmFile& file,
         const scene::ArmFile& recorded)
      : recording_(recording), file_(file), recorded_(recorded) {}

  driver::Result<TwinMotion> run(const TwinSpan& span) {
    if (auto regular = find_rate(); !regular) return regular.error();
    motion_.R_WB = file_.R_WB;
    const auto& ticks = recording_.ticks;
    const std::int64_t begin_ns = ticks.front().time_ns;
    for (std::size_t i = 0; i < ticks.size(); ++i) {
      const double time = 1e-9 * static_cast<double>(ticks[i].time_ns - begin_ns);
      if (i > 0 && !follows(ticks[i - 1], ticks[i])) close();
      const bool used =
          time >= span.from && time <= span.until && ticks[i].stage == driver::DeviceStage::kActive;
      if (used && ticks[i].in_contact) {
        if (!touch_) touch_.emplace(time, time);
        touch_->second = time;
      }
      if (!used || !take(ticks[i])) close();
    }
    close();
    return judged();
  }

 private:
  /// The usual time between two ticks; missed ticks are gaps in their numbers.
  driver::Result<void> find_rate() {
    const auto& ticks = recording_.ticks;
    std::vector<std::int64_t> steps;
    for (std::size_t i = 1; i < ticks.size(); ++i) {
      if (ticks[i].tick == ticks[i - 1].tick + 1) {
        steps.push_back(ticks[i].time_ns - ticks[i - 1].time_ns);
      }
    }
    if (steps.size() < 100) return too_short();
    const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
    std::nth_element(steps.begin(), middle, steps.end());
    const double dt = 1e-9 * static_cast<double>(*middle);
    if (!(recording_.info.rate > 0) || std::abs(dt * recording_.info.rate - 1) > 0.1) {
      return driver::Error{
          fmt::format("The recording is damaged: its header gives {:g} ticks per second, but its "
                      "times give {:.4g}.",
                      recording_.info.rate, 1 / dt)};
    }
    motion_.dt = 1 / recording_.info.rate;
    return {};
  }

  static driver::Error too_short() {
    return driver::Error{
        fmt::format("The recording has less than {:g} s of motion under forces, too little for a "
                    "comparison. Record with `thimble identify --record FILE`.",
                    kShortest)};
  }

  /// Returns whether no tick between two ticks was missed, and neither was late.
  bool follows(const driver::TickRecord& before, const driver::TickRecord& tick) const {
    const double step = 1e-9 * static_cast<double>(tick.time_ns - before.time_ns);
    return tick.tick == before.tick + 1 && std::abs(step - motion_.dt) < 0.5 * motion_.dt;
  }

  /// Adds a tick to the present stretch; false if it has no pose.
  bool take(const driver::TickRecord& tick) {
    const Eigen::Vector3d q = vector_of(tick.q);
    const Eigen::Vector3d f_T_B = file_.R_WB.transpose() * vector_of(tick.f_sent_W);
    TwinSample sample;
    Eigen::Matrix3d J;
    std::visit([&](const auto& build) { build.forward(q, sample.p_BT, J); }, file_.model.geometry);
    sample.G = J.inverse();
    sample.fresh = tick.fresh;
    if (!sample.p_BT.allFinite() || !sample.G.allFinite() || !f_T_B.allFinite()) return false;
    const Eigen::Vector3d p_WT = file_.R_WB * sample.p_BT + file_.p_WB;
    const double beside = (p_WT - vector_of(tick.p_WT)).norm();
    off_ = std::max(off_, std::isnan(beside) ? HUGE_VAL : beside);
    const Eigen::Vector3d tau = J.transpose() * f_T_B;
    for (int i = 0; i < 3; ++i) {
      const driver::MotorDrive& drive = recorded_.model.drives[static_cast<std::size_t>(i)];
      sample.amperes[i] = drive.sign * tau[i] / (drive.ratio * drive.torque_constant);
    }
    force_square_ += f_T_B.squaredNorm();
    for (int i = 0; i < 3; ++i) {
      const double step = file_.model.step(static_cast<std::size_t>(i));
      step_square_ += (J.col(i) * step).squaredNorm() / (file_.motors() * 12.0);
    }
    ++taken_;
    stretch_.push_back(sample);
    return true;
  }

  void close() {
    const auto min_samples = static_cast<std::size_t>(2 * TwinMotion::kLead / motion_.dt);
    if (stretch_.size() > min_samples) motion_.stretches.push_back(std::move(stretch_));
    stretch_.clear();
  }

  driver::Result<TwinMotion> judged() {
    if (off_ > kSameTip) {
      return driver::Error{fmt::format(
          "The recording is not from the arm {}: with the geometry of this file its joint angles "
          "put the tip {:.3g} mm from the recorded position. It was made with the arm {}.",
          file_.name, 1e3 * off_, recorded_.name)};
    }
    if (touch_) {
      return driver::Error{
          fmt::format("The tip touches objects between {:.3g} and {:.3g} s of the recording, so a "
                      "hand held the arm; the twin has no hand. Select free motion with --from and "
                      "--until, or use a recording of `thimble identify --record FILE`.",
                      touch_->first, touch_->second)};
    }
    std::size_t left = 0;
    for (const auto& stretch : motion_.stretches) left += stretch.size();
    if (static_cast<double>(left) * motion_.dt < kShortest) return too_short();
    if (std::sqrt(force_square_ / static_cast<double>(taken_)) < kForceSeen) {
      return driver::Error{
          "The recording has no significant force to drive the twin. Record with `thimble identify "
          "--record FILE`."};
    }
    motion_.step_error = std::sqrt(step_square_ / static_cast<double>(taken_));
    for (std::string& sentence : unseen_differences(recorded_, file_)) {
      motion_.messages.push_back(std::move(sentence));
    }
    if (!recording_.complete) {
      motion_.messages.push_back("The recording is truncated; only the existing part is compared.");
    }
    return std::move(motion_);
  }

  const session::Recording& recording_;
  const scene::ArmFile& file_;
  const scene::ArmFile& recorded_;
  TwinMotion motion_;
  std::vector<TwinSample> stretch_;
  std::optional<std::pair<double, double>> touch_;  // first and last second of contact
  double off_ = 0;                                  // m
  double force_square_ = 0, step_square_ = 0;
  std::size_t taken_ = 0;
};

}  // namespace

driver::Result<TwinMotion> twin_motion(const session::Recording& recording,
                                       const scene::ArmFile& file, const TwinSpan& span) {
  if (auto good = check_file(file); !good) return good.error();
  const auto recorded = arm_of(recording.info);
  if (!recorded) {
    return driver::Error{
        "The recording is damaged: the currents are unknown because the arm file in it is not "
        "valid. " +
        recorded.error().message};
  }
  if (recorded->model.geometry.index() != file.model.geometry.index()) {
    return driver::Error{
        fmt::format("The recording is not from the arm {}: it was made with the arm {}, which has "
                    "a different geometry.",
                    file.name, recorded->name)};
  }
  return Reader(recording, file, *recorded).run(span);
}

}  // namespace thimble::twin
