#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>

#include "arms/hfab/hfab_report.h"
#include "support/vintage_arm.h"
#include "thimble/driver/device.h"
#include "thimble/driver/wire_link.h"

namespace {

using namespace thimble;

/// Answers each read with a report in which the tip moves back and forth by some counts.
class OscillatingWire final : public driver::Transport {
 public:
  driver::TransportRead read_latest(std::span<std::byte> buffer, std::int64_t) noexcept override {
    ++reads_;
    const int phase = reads_ % 200;
    const auto report = driver::hfab::encode_input(
        {.counts = {0, 0, static_cast<std::int16_t>(phase < 100 ? phase : 200 - phase)}});
    std::memcpy(buffer.data(), report.data(), report.size());
    return {driver::TransportStatus::kOk, report.size(), 0};
  }
  driver::TransportStatus write(std::span<const std::byte>) noexcept override {
    return driver::TransportStatus::kOk;
  }

 private:
  int reads_ = 0;
};

}  // namespace

// Runs ticks of a device whose gate has one energy stage, a heat guard or neither, so that
// callgrind can count their instructions:
//   gate_ticks none|passivity|bounding|heat TICKS
int main(int argc, char** argv) {
  if (argc != 3) return 2;
  driver::DeviceSettings settings = support::vintage_settings();
  if (std::strcmp(argv[1], "passivity") == 0) {
    settings.energy = {.stage = driver::EnergyStage::kPassivity,
                       .mass = 0.075,
                       .allowance = 0.002,
                       .reservoir = 0.02,
                       .delay_ticks = 1};
  } else if (std::strcmp(argv[1], "bounding") == 0) {
    settings.energy = {.stage = driver::EnergyStage::kBounding, .slope = 1e4};
  }
  // The motion watch is always on.
  settings.motion = {.mass = 0.075, .delay_ticks = 1};
  if (std::strcmp(argv[1], "heat") == 0) {
    settings.heat = {.continuous_current = {1, 1, 1}, .time_constant = {60, 60, 60}};
  }
  auto device =
      driver::Device::open(std::make_unique<driver::WireLink>(
                               std::make_unique<OscillatingWire>(),
                               std::make_unique<driver::hfab::HfabArm>(support::vintage_model())),
                           settings, 0);
  if (!device || !(*device)->activate()) return 1;
  double sum = 0;
  for (std::int64_t tick = 0; tick < std::atoll(argv[2]); ++tick) {
    const driver::DeviceState& state = (*device)->read(tick * 1'000'000, tick * 1'000'000);
    driver::ForceCommand command;
    command.f_T_W = {-200 * state.p_WT.x(), 0, 0.5};
    (*device)->write(command);
    sum += (*device)->f_sent_W().norm();
  }
  std::fprintf(stderr, "force summed %g N\n", sum);
  return sum > 0 ? 0 : 1;
}
