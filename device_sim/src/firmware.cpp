#include "firmware.h"

#include <cmath>
#include <cstdlib>

#include "board_wire.h"

namespace thimble::device_sim {
namespace {

constexpr int kFine = 65536;  // ideal encoders: parts of a count

// Counters far beyond their 16 bits wrap as the real ones do; beyond this they are cut, so that the
// conversion to an integer is defined for any number.
constexpr double kCounterMax = 1e15;

std::int64_t rounded(double counts) noexcept {
  if (!(std::abs(counts) <= kCounterMax)) return 0;
  return static_cast<std::int64_t>(std::floor(counts + 0.5));
}

}  // namespace

driver::Result<Firmware> Firmware::make(const driver::ArmModel& real,
                                        const FirmwareSettings& settings) {
  driver::ArmModel model = settings.ideal_encoders ? with_fine_counts(real, kFine) : real;
  if (settings.ideal_encoders) model.gimbal.reset();
  if (auto wired = settings.wiring.check(); !wired) return wired.error();
  if (settings.speaks == driver::ArmKind::kFalcon ||
      settings.speaks == driver::ArmKind::kUnsupported) {
    return driver::Error{
        "The simulated firmware speaks what a board says by itself: 14-byte reports, 8-byte "
        "reports "
        "or text lines."};
  }
  if (settings.report_period_ns <= 0) {
    return driver::Error{"The simulated firmware's report period must be above zero (ns)."};
  }
  if (settings.watchdog_ns <= 0) {
    return driver::Error{"The simulated firmware's watchdog must be above zero (ns)."};
  }
  if (settings.current_range_mA < 0) {
    return driver::Error{"The simulated firmware's current range must not be negative (mA)."};
  }
  for (int joint = 0; joint < 3; ++joint) {
    const double step = model.step(static_cast<std::size_t>(joint));
    if (step > 0 && step < HUGE_VAL) continue;
    return driver::Error{
        "The simulated arm's encoders need counts and ratios above zero; set them in the arm "
        "file."};
  }
  return Firmware(model, settings);
}

Firmware::Firmware(const driver::ArmModel& model, const FirmwareSettings& settings) noexcept
    : settings_(settings), gimbal_(model.gimbal) {
  for (int joint = 0; joint < 3; ++joint) {
    const driver::JointEncoder& encoder = model.encoders[static_cast<std::size_t>(joint)];
    counts_per_radian_[joint] = encoder.sign / model.step(static_cast<std::size_t>(joint));
    home_counts_[joint] = static_cast<double>(encoder.home_counts);
  }
}

Eigen::Vector3d Firmware::counts_at(const Eigen::Vector3d& q) const noexcept {
  return settings_.wiring.inputs(q.cwiseProduct(counts_per_radian_) - home_counts_);
}

Eigen::Vector3d Firmware::gimbal_counts_at(const Eigen::Vector3d& gimbal) const noexcept {
  return gimbal_ ? gimbal_->exact_counts(gimbal) : Eigen::Vector3d(0, 0, 0);
}

BoardBytes Firmware::sample(const Eigen::Vector3d& q, const Eigen::Vector3d& gimbal,
                            std::uint16_t number) const noexcept {
  const Eigen::Vector3d counts = counts_at(q) + preset_counts_;
  const Eigen::Vector3d turns = gimbal_counts_at(gimbal) + preset_gimbal_;
  BoardReport report{.counts = {}, .gimbal = {}, .number = number, .button = button_};
  for (std::size_t i = 0; i < 3; ++i) {
    report.counts[i] = rounded(counts[static_cast<int>(i)]);
    report.gimbal[i] = rounded(turns[static_cast<int>(i)]);
  }
  BoardBytes bytes;
  bytes.size = encode_report(report, settings_, bytes.bytes);
  return bytes;
}

void Firmware::receive(std::span<const std::byte> message, std::int64_t time_ns,
                       const Eigen::Vector3d& q, const Eigen::Vector3d& gimbal) noexcept {
  const auto decoded = decode_message(message, settings_);
  if (!decoded) {
    ++counters_.malformed;
    return;
  }
  ++counters_.messages;
  watchdog_due_ns_ = time_ns + settings_.watchdog_ns;
  if (decoded->counters) return preset(*decoded->counters, q, gimbal);
  Eigen::Vector3d outputs;
  for (std::size_t i = 0; i < 3; ++i) {
    const int mA = decoded->current_mA[i];
    const bool in_range = std::abs(mA) <= settings_.current_range_mA;
    if (!in_range) ++counters_.over_range;
    outputs[static_cast<int>(i)] = in_range ? mA * 1e-3 : 0;
  }
  amperes_ = settings_.wiring.motors(outputs);
}

void Firmware::preset(const std::array<std::int32_t, 6>& counters, const Eigen::Vector3d& q,
                      const Eigen::Vector3d& gimbal) noexcept {
  ++counters_.presets;
  button_ = false;
  amperes_.setZero();
  const Eigen::Vector3d counts = counts_at(q), turns = gimbal_counts_at(gimbal);
  const double parts = settings_.ideal_encoders ? kFine : 1;
  for (int i = 0; i < 3; ++i) {
    // A preset moves the counter by whole counts: where the edges of the encoder's slots lie is
    // given by its disc.
    const auto k = static_cast<std::size_t>(i);
    preset_counts_[i] = parts * counters[k] - std::floor(counts[i] + 0.5);
    preset_gimbal_[i] = counters[3 + k] - std::floor(turns[i] + 0.5);
  }
}

void Firmware::watch(std::int64_t time_ns) noexcept {
  if (time_ns < watchdog_due_ns_) return;
  if (watchdog_due_ns_ == kNever_ns) return;
  ++counters_.watchdog_fired;
  amperes_.setZero();
  watchdog_due_ns_ = kNever_ns;
}

}  // namespace thimble::device_sim
