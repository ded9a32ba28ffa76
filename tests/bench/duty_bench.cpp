// Cost of the driver's own code per tick for each arm: decode, kinematics, velocity, gate,
// currents, encode. The wire is in memory, so that no kernel call is measured.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <span>
#include <vector>

#include "arms/falcon/falcon_arm.h"
#include "arms/hfab/hfab_line.h"
#include "arms/hfab/hfab_models.h"
#include "arms/hfab/hfab_report.h"
#include "arms/hfab/hfab_wire.h"
#include "arms/woody/woody_report.h"
#include "arms/woody/woody_wire.h"
#include "support/vintage_arm.h"
#include "thimble/driver/device.h"
#include "thimble/driver/wire_link.h"

namespace thimble {
namespace {

using Report = std::vector<std::byte>;

/// Wire that returns the next of a list of reports on each read and discards writes.
class LoopedWire final : public driver::Transport {
 public:
  explicit LoopedWire(std::vector<Report> reports) : reports_(std::move(reports)) {}

  driver::TransportRead read_latest(std::span<std::byte> buffer, std::int64_t) noexcept override {
    const Report& report = reports_[next_];
    next_ = next_ + 1 == reports_.size() ? 0 : next_ + 1;
    std::copy(report.begin(), report.end(), buffer.begin());
    return {.status = driver::TransportStatus::kOk, .size = report.size(), .skipped = 0};
  }
  driver::TransportStatus write(std::span<const std::byte> report) noexcept override {
    benchmark::DoNotOptimize(report.data());
    benchmark::ClobberMemory();
    return driver::TransportStatus::kOk;
  }

 private:
  std::vector<Report> reports_;
  std::size_t next_ = 0;
};

template <class Bytes>
Report report_of(const Bytes& bytes) {
  return {std::begin(bytes), std::end(bytes)};
}

/// Encodes a thousand reports of a tip that circles near `p_BT`; `encode` makes a report from the
/// counts and its number.
template <class Geometry, class Encode>
std::vector<Report> round_trip(const driver::JointModel<Geometry>& model,
                               const Eigen::Vector3d& p_BT, Encode&& encode) {
  std::vector<Report> reports;
  for (int i = 0; i < 1000; ++i) {
    const double angle = 0.002 * std::numbers::pi * i;
    const auto q =
        model.geometry.inverse(p_BT + 0.01 * Eigen::Vector3d(0, std::cos(angle), std::sin(angle)));
    if (!q) return {};
    const Eigen::Vector3d exact = model.exact_counts(*q);
    std::array<std::int16_t, 3> counts{};
    for (std::size_t k = 0; k < 3; ++k) {
      counts[k] = static_cast<std::int16_t>(std::lround(exact[static_cast<Eigen::Index>(k)]));
    }
    reports.push_back(encode(counts, i));
  }
  return reports;
}

void ticks(benchmark::State& state, std::vector<Report> reports,
           std::unique_ptr<const driver::Arm> arm) {
  if (reports.empty()) return state.SkipWithError("the arm does not reach the path");
  driver::DeviceSettings settings = support::vintage_settings();
  settings.velocity_corner_frequency = 100;
  auto device =
      driver::Device::open(std::make_unique<driver::WireLink>(
                               std::make_unique<LoopedWire>(std::move(reports)), std::move(arm)),
                           settings, 0);
  if (!device || !(*device)->activate()) return state.SkipWithError("the device does not open");
  std::int64_t now_ns = 0;
  driver::ForceCommand command;
  command.f_T_W = {0.3, -0.5, 0.7};
  for (auto _ : state) {
    now_ns += 1'000'000;
    benchmark::DoNotOptimize((*device)->read(now_ns, now_ns));
    (*device)->write(command);
  }
  if ((*device)->fault() != driver::Fault::kNone) state.SkipWithError("the device has a fault");
  const auto& wire = (*device)->wire_counters();
  const bool started = now_ns > 1'000'000'000;  // force rises slowly, as on every arm
  if (wire.rejected + wire.missing > 0 || (started && !((*device)->f_sent_W().norm() > 0.8))) {
    state.SkipWithError("not every tick had a report and its force");
  }
}

void duty_woodenhaptics(benchmark::State& state) {
  const auto model = driver::hfab::woody_model();
  ticks(state,
        round_trip(model, {0.22, 0, 0.08},
                   [](const auto& counts, int number) {
                     return report_of(driver::woody::encode_input(
                         {.counts = counts, .counter = static_cast<std::uint16_t>(number)}));
                   }),
        std::make_unique<driver::woody::WoodyArm>(model));
}
BENCHMARK(duty_woodenhaptics);

Report hfab_report(const std::array<std::int16_t, 3>& counts) {
  driver::hfab::InputReport input;
  std::copy(counts.begin(), counts.end(), input.counts.begin());
  return report_of(driver::hfab::encode_input(input));
}

void duty_polhem(benchmark::State& state) {
  const auto model = driver::hfab::polhem_model();
  ticks(state,
        round_trip(model, {0.2045, 0, 0.0325},
                   [](const auto& counts, int) { return hfab_report(counts); }),
        std::make_unique<driver::WireArm<driver::hfab::ReportWire, driver::LinkageArm>>(model));
}
BENCHMARK(duty_polhem);

void duty_vintage(benchmark::State& state) {
  const auto model = driver::hfab::vintage_model();
  ticks(state,
        round_trip(model, {0.138, 0, -0.112},
                   [](const auto& counts, int) { return hfab_report(counts); }),
        std::make_unique<driver::WireArm<driver::hfab::ReportWire, driver::SerialArm>>(model));
}
BENCHMARK(duty_vintage);

void duty_polhem_text(benchmark::State& state) {
  const auto model = driver::hfab::polhem_model();
  ticks(state,
        round_trip(model, {0.2045, 0, 0.0325},
                   [](const auto& counts, int) {
                     driver::hfab::ArmLine line;
                     line.model = 1;
                     std::copy(counts.begin(), counts.end(), line.counts.begin());
                     std::array<std::byte, driver::hfab::kLineCapacity> bytes{};
                     const std::size_t size = driver::hfab::encode_arm_line(line, bytes);
                     return Report(bytes.begin(),
                                   bytes.begin() + static_cast<std::ptrdiff_t>(size) - 1);
                   }),
        std::make_unique<driver::WireArm<driver::hfab::LineWire, driver::LinkageArm>>(model));
}
BENCHMARK(duty_polhem_text);

void duty_falcon(benchmark::State& state) {
  state.counters["goal_below_ns"] = 400;
  const auto model = driver::falcon::falcon_model();
  ticks(state,
        round_trip(model, model.geometry.p_BM,
                   [](const auto& counts, int) {
                     driver::falcon::ArmPacket packet;
                     packet.counts = counts;
                     packet.homed = driver::falcon::kAllHomed;
                     return report_of(driver::falcon::encode_arm_packet(packet));
                   }),
        std::make_unique<driver::falcon::FalconArm>(model));
}
BENCHMARK(duty_falcon);

}  // namespace
}  // namespace thimble
