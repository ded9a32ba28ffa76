#include "board/firmware.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <utility>

#include "board/board_wire.h"
#include "wires/wire_table.h"

namespace thimble::device_sim {
namespace {

constexpr int kFine = 65536;  // ideal encoders: parts of a count

// Counters beyond 16 bits wrap like the real ones. Beyond this bound they are clamped, so that the
// conversion to an integer is defined for any number.
constexpr double kCounterMax = 1e15;

std::int64_t rounded(double counts) noexcept {
  if (!(std::abs(counts) <= kCounterMax)) return 0;
  const double above = counts + 0.5;
  const auto whole = static_cast<std::int64_t>(above);
  return whole - (static_cast<double>(whole) > above ? 1 : 0);
}

// Counts below kCountable are exact to 2^-20 after a few operations. If one is farther than
// kCountRounding from the next half, only the error of the angle can change it.
constexpr double kCountable = 0x1p31, kCountRounding = 0x1p-10;

bool rounds_surely(double counts, double error) noexcept {
  if (!(std::abs(counts) < kCountable)) return false;
  const double beyond_whole =
      std::abs(counts - static_cast<double>(static_cast<std::int64_t>(counts)));
  return std::abs(beyond_whole - 0.5) > error + kCountRounding;
}

/// Returns the time of the firmware's clock.
std::uint32_t micros(std::int64_t time_ns) noexcept {
  return static_cast<std::uint32_t>(time_ns / 1000);
}

}  // namespace

driver::Result<Firmware> Firmware::make(const driver::ArmModel& real,
                                        const FirmwareSettings& settings) {
  driver::ArmModel model = settings.ideal_encoders ? with_fine_counts(real, kFine) : real;
  if (settings.ideal_encoders) model.gimbal.reset();
  if (auto wired = settings.wiring.check(); !wired) return wired.error();
  if (settings.protocol == driver::ArmKind::kFalcon ||
      settings.protocol == driver::ArmKind::kUnsupported) {
    return driver::Error{
        "The simulated firmware supports only wires on which a board sends by itself: 14-byte "
        "reports, 8-byte reports or text lines."};
  }
  const bool described = settings.protocol == driver::ArmKind::kDescribed;
  if (described != (settings.described != nullptr)) {
    return driver::Error{
        "The simulated firmware needs the protocol 'described' and a described wire together."};
  }
  if (described && settings.ideal_encoders) {
    return driver::Error{
        "The simulated firmware cannot have ideal encoders on a described wire. Use quantised "
        "ones."};
  }
  if (!(settings.missed_edges >= 0 && settings.missed_edges <= 1)) {
    return driver::Error{
        "The simulated firmware's missed_edges must be a probability from 0 to 1."};
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
        "The simulated arm's encoders need counts and ratios above zero. Set them in the arm "
        "file."};
  }
  if (settings.reference && settings.ideal_encoders) {
    return driver::Error{
        "A simulated board with the reference firmware cannot have ideal encoders. Use quantised "
        "ones."};
  }
  constexpr std::int64_t kPeriodMin_ns = 100'000, kPeriodMax_ns = 100'000'000;
  if (settings.reference &&
      !(settings.report_period_ns >= kPeriodMin_ns && settings.report_period_ns <= kPeriodMax_ns)) {
    return driver::Error{"The reference firmware's report period must be from 0.1 to 100 ms."};
  }
  if (!described) return Firmware(model, settings);
  // Motor values may be torques, which need the constants of the motors.
  FirmwareSettings with_motors = settings;
  auto wire = std::make_shared<driver::WireTable>(*settings.described);
  wire->use_motors(model.drives);
  with_motors.described = std::move(wire);
  return Firmware(model, with_motors);
}

Firmware::Firmware(const driver::ArmModel& model, const FirmwareSettings& settings) noexcept
    : settings_(settings), gimbal_(model.gimbal) {
  for (int joint = 0; joint < 3; ++joint) {
    const driver::JointEncoder& encoder = model.encoders[static_cast<std::size_t>(joint)];
    counts_per_radian_[joint] = encoder.sign / model.step(static_cast<std::size_t>(joint));
    home_counts_[joint] = static_cast<double>(encoder.home_counts);
  }
  max_counts_per_radian_ = counts_per_radian_.cwiseAbs().maxCoeff();
  countable_ = countable();
  if (settings_.reference && settings_.program == nullptr) {
    own_program_.emplace(reference_config(model, settings_));
  }
}

Eigen::Vector3d Firmware::counts_at(const Eigen::Vector3d& q) const noexcept {
  return settings_.wiring.inputs(q.cwiseProduct(counts_per_radian_) - home_counts_);
}

void Firmware::miss_edges(const Eigen::Vector3d& q, SplitMix& chance) noexcept {
  for (std::size_t i = 0; i < 3; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const std::int64_t now = rounded(q[k] * counts_per_radian_[k]);
    const std::int64_t passed = looked_ ? now - edges_[i] : 0;
    edges_[i] = now;
    const double step = passed > 0 ? 1 : -1;
    for (std::int64_t edge = std::min(std::abs(passed), kEdgesMax); edge > 0; --edge) {
      if (!(chance.uniform() < settings_.missed_edges)) continue;
      home_counts_[k] += step;
      ++counters_.missed_edges;
    }
  }
  looked_ = true;
}

Eigen::Vector3d Firmware::gimbal_counts_at(const Eigen::Vector3d& gimbal) const noexcept {
  return gimbal_ ? gimbal_->exact_counts(gimbal) : Eigen::Vector3d(0, 0, 0);
}

BoardBytes Firmware::sample(const Eigen::Vector3d& q, const Eigen::Vector3d& gimbal,
                            std::uint16_t number) const noexcept {
  BoardBytes bytes;
  report(counts_at(q) + preset_counts_, gimbal, number, bytes);
  return bytes;
}

bool Firmware::sample_about(const Eigen::Vector3d& q, double error, const Eigen::Vector3d& gimbal,
                            std::uint16_t number, BoardBytes& bytes) const noexcept {
  const Eigen::Vector3d counts = counts_at(q) + preset_counts_;
  const double counts_error = error * max_counts_per_radian_;
  const bool sure = countable_ && rounds_surely(counts[0], counts_error) &&
                    rounds_surely(counts[1], counts_error) &&
                    rounds_surely(counts[2], counts_error);
  if (sure) report(counts, gimbal, number, bytes);
  return sure;
}

void Firmware::report(const Eigen::Vector3d& counts, const Eigen::Vector3d& gimbal,
                      std::uint16_t number, BoardBytes& bytes) const noexcept {
  BoardReport report{.counts = {}, .gimbal = {}, .number = number, .button = button_};
  for (std::size_t i = 0; i < 3; ++i) report.counts[i] = rounded(counts[static_cast<int>(i)]);
  // Without a gimbal, its counters keep the values of the last preset.
  if (gimbal_ || counters_.presets > 0) {
    const Eigen::Vector3d turns = gimbal_counts_at(gimbal) + preset_gimbal_;
    for (std::size_t i = 0; i < 3; ++i) report.gimbal[i] = rounded(turns[static_cast<int>(i)]);
  }
  bytes.size = encode_report(report, settings_, bytes.bytes);
}

std::optional<BoardCounters> Firmware::receive(std::span<const std::byte> message,
                                               std::int64_t time_ns) noexcept {
  if (has_program()) {
    ++counters_.messages;
    program().receive({reinterpret_cast<const std::uint8_t*>(message.data()), message.size()},
                      micros(time_ns));
    take_outputs(time_ns);
    return {};
  }
  BoardMessage decoded;
  if (!decode_message(message, settings_, decoded)) {
    ++counters_.malformed;
    return {};
  }
  ++counters_.messages;
  watchdog_due_ns_ = time_ns + settings_.watchdog_ns;
  if (decoded.counters) {
    amperes_.setZero();
    return decoded.counters;
  }
  Eigen::Vector3d outputs;
  for (std::size_t i = 0; i < 3; ++i) {
    const int mA = decoded.current_mA[i];
    const bool in_range = std::abs(mA) <= settings_.current_range_mA;
    if (!in_range) ++counters_.over_range;
    outputs[static_cast<int>(i)] = in_range ? mA * 1e-3 : 0;
  }
  amperes_ = settings_.wiring.motors(outputs);
  return {};
}

void Firmware::preset(const BoardCounters& counters, const Eigen::Vector3d& q,
                      const Eigen::Vector3d& gimbal) noexcept {
  ++counters_.presets;
  button_ = false;
  set_counters(counters, q, gimbal);
}

void Firmware::restart(const Eigen::Vector3d& q, const Eigen::Vector3d& gimbal) noexcept {
  button_ = false;
  amperes_.setZero();
  watchdog_due_ns_ = kNever_ns;
  if (has_program()) program().restart();
  set_counters({}, q, gimbal);
}

void Firmware::set_counters(const BoardCounters& counters, const Eigen::Vector3d& q,
                            const Eigen::Vector3d& gimbal) noexcept {
  const Eigen::Vector3d counts = counts_at(q), turns = gimbal_counts_at(gimbal);
  const double parts = settings_.ideal_encoders ? kFine : 1;
  for (int i = 0; i < 3; ++i) {
    // A preset changes the counter by an integer, because the disc of the encoder determines the
    // positions of the edges.
    const auto k = static_cast<std::size_t>(i);
    preset_counts_[i] = parts * counters[k] - std::floor(counts[i] + 0.5);
    preset_gimbal_[i] = counters[3 + k] - std::floor(turns[i] + 0.5);
  }
  countable_ = countable();
}

bool Firmware::countable() const noexcept {
  // Written so that NaN is not countable.
  return !misses_edges() && (settings_.wiring.encoder_gain.array().abs() <= 1).all() &&
         (home_counts_.array().abs() < kCountable).all() &&
         (preset_counts_.array().abs() < kCountable).all();
}

void Firmware::tick(std::int64_t time_ns, BoardBytes& bytes) noexcept {
  firmware::Inputs inputs;
  unpack_inputs(bytes, inputs);
  inputs.supply_mV = health_.supply_mV;
  inputs.temperature_dC = health_.temperature_dC;
  inputs.encoder_error = health_.encoder_error;
  bytes.size = firmware::kHidReportSize;
  std::fill_n(bytes.bytes.begin(), bytes.size, std::byte{0});
  program().tick(inputs, micros(time_ns),
                 std::span<std::uint8_t, firmware::kHidReportSize>(
                     reinterpret_cast<std::uint8_t*>(bytes.bytes.data()), bytes.size));
  take_outputs(time_ns);
}

void Firmware::take_outputs(std::int64_t time_ns) noexcept {
  const firmware::Outputs& outputs = program().outputs();
  amperes_ = settings_.wiring.motors({outputs.amperes[0], outputs.amperes[1], outputs.amperes[2]});
  if (!outputs.motors_on) {
    if (watchdog_due_ns_ <= time_ns) ++counters_.watchdog_fired;
    watchdog_due_ns_ = kNever_ns;
    return;
  }
  // The firmware's clock has whole microseconds.
  const std::int64_t since_us = static_cast<std::uint32_t>(micros(time_ns) - outputs.fed_us);
  watchdog_due_ns_ = (time_ns / 1000 - since_us) * 1000 + settings_.watchdog_ns;
}

void Firmware::watch(std::int64_t time_ns) noexcept {
  if (time_ns < watchdog_due_ns_) return;
  if (watchdog_due_ns_ == kNever_ns) return;
  if (has_program()) {
    program().watch(micros(time_ns));
    take_outputs(time_ns);
    // A program that does not switch off at its time is asked again, not at once.
    if (watchdog_due_ns_ <= time_ns) watchdog_due_ns_ = time_ns + settings_.report_period_ns;
    return;
  }
  ++counters_.watchdog_fired;
  amperes_.setZero();
  watchdog_due_ns_ = kNever_ns;
}

}  // namespace thimble::device_sim
