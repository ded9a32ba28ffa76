#include "firmware.h"
#include "arms/hfab/hfab_report.h"

#include <cmath>
#include <cstdlib>

namespace thimble::device_sim {
namespace {

constexpr double kFraction = 65536;  // HfabModel::fractional_counts: parts of a count

// Counters far beyond their 16 bits wrap as the real ones do; beyond this they are cut, so that the
// conversion to an integer is defined for any number.
constexpr double kCounterMax = 1e15;

std::int64_t rounded(double counts) noexcept {
  if (!(std::abs(counts) <= kCounterMax)) return 0;
  return static_cast<std::int64_t>(std::floor(counts + 0.5));
}

std::int16_t low_word(std::int64_t value) noexcept {
  return static_cast<std::int16_t>(static_cast<std::uint16_t>(value & 0xffff));
}

}  // namespace

driver::Result<Firmware> Firmware::make(const driver::hfab::HfabModel& model,
                                        const FirmwareSettings& settings) {
  if (auto wired = settings.wiring.check(); !wired) return wired.error();
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
    const double step = model.step(joint);
    if (step > 0 && step < HUGE_VAL) continue;
    return driver::Error{
        "The simulated arm's encoders need counts and ratios above zero; set them in the arm "
        "file."};
  }
  return Firmware(model, settings);
}

Firmware::Firmware(const driver::hfab::HfabModel& model, const FirmwareSettings& settings) noexcept
    : settings_(settings), fractional_counts_(model.fractional_counts) {
  for (int joint = 0; joint < 3; ++joint) {
    const driver::hfab::JointEncoder& encoder = model.encoders[static_cast<std::size_t>(joint)];
    counts_per_radian_[joint] = encoder.sign / model.step(joint);
    home_counts_[joint] = encoder.home_counts;
  }
}

Eigen::Vector3d Firmware::counts_at(const Eigen::Vector3d& q) const noexcept {
  return settings_.wiring.inputs(q.cwiseProduct(counts_per_radian_) - home_counts_);
}

std::array<std::byte, driver::hfab::kReportSize> Firmware::sample(
    const Eigen::Vector3d& q) const noexcept {
  const Eigen::Vector3d counts = counts_at(q) + preset_counts_;
  driver::hfab::InputReport report;
  for (std::size_t i = 0; i < 3; ++i) {
    const double count = counts[static_cast<int>(i)];
    if (fractional_counts_) {
      const std::int64_t parts = rounded(count * kFraction);
      report.counts[i] = low_word(parts >> 16);
      report.counts[3 + i] = low_word(parts);
    } else {
      report.counts[i] = low_word(rounded(count));
      report.counts[3 + i] = gimbal_counts_[i];
    }
  }
  report.info = button_ ? 1 : 0;
  return driver::hfab::encode_input(report);
}

void Firmware::receive(std::span<const std::byte> message, std::int64_t time_ns,
                       const Eigen::Vector3d& q) noexcept {
  const auto decoded = driver::hfab::decode_output(message);
  if (!decoded) {
    ++counters_.malformed;
    return;
  }
  ++counters_.messages;
  watchdog_due_ns_ = time_ns + settings_.watchdog_ns;
  if (decoded->command == static_cast<std::int16_t>(driver::hfab::Command::kPreset)) {
    preset(*decoded, q);
    return;
  }
  Eigen::Vector3d outputs;
  for (std::size_t i = 0; i < 3; ++i) {
    const int mA = decoded->current_mA[i];
    const bool in_range = std::abs(mA) <= settings_.current_range_mA;
    if (!in_range) ++counters_.over_range;
    outputs[static_cast<int>(i)] = in_range ? mA * 1e-3 : 0;
  }
  amperes_ = settings_.wiring.motors(outputs);
}

void Firmware::preset(const driver::hfab::OutputReport& message,
                      const Eigen::Vector3d& q) noexcept {
  ++counters_.presets;
  button_ = false;
  amperes_.setZero();
  gimbal_counts_ = message.current_mA;
  const Eigen::Vector3d counts = counts_at(q);
  for (int i = 0; i < 3; ++i) {
    // A preset moves the counter by whole counts: where the edges of the encoder's slots lie is
    // given by its disc. An ideal encoder has no slots.
    const double now = fractional_counts_ ? counts[i] : std::floor(counts[i] + 0.5);
    preset_counts_[i] = message.attributes[static_cast<std::size_t>(i)] - now;
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
