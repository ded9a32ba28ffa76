#include "thimble/scene/simulated_device.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>
#include <utility>

#include "arm/report_timeout.h"
#include "thimble/driver/device.h"
#include "thimble/scene/arm_file.h"

namespace thimble::scene {

using Opened = driver::Result<std::unique_ptr<SimulatedDevice>>;

Opened SimulatedDevice::open(const ArmFile& arm, const HandRoute& hand_W,
                             const SimulatedDeviceOptions& options) {
  // Written so that NaN is rejected.
  if (!(options.rate >= 10 && options.rate <= 1e5)) {
    return driver::Error{"rate: expected 10 to 100000 Hz, found " + std::to_string(options.rate) +
                         "."};
  }
  if (auto reach = check_reach(arm, hand_W); !reach) return reach.error();
  auto simulation = ArmSimulation::make(arm, hand_W, options.firmware, options.seed);
  if (!simulation) return simulation.error();
  std::unique_ptr<SimulatedDevice> opened(new SimulatedDevice(arm));
  opened->period_ns_ = std::llround(1e9 / options.rate);
  opened->simulation_ = std::move(simulation).value();
  auto device = driver::Device::open(opened->simulation_->link(opened->clock_),
                                     device_settings(arm, options.rate), opened->clock_.now_ns(),
                                     report_timeout_ns(arm));
  if (!device) return device.error();
  opened->device_ = std::move(device).value();
  return opened;
}

Opened SimulatedDevice::open(const std::filesystem::path& arm, const HandRoute& hand_W,
                             const SimulatedDeviceOptions& options) {
  const auto file = load_arm(arm);
  if (!file) return file.error();
  return open(*file, hand_W, options);
}

driver::ServoEnd SimulatedDevice::run_loop(double seconds, driver::ForceLaw law,
                                           driver::TickSink sink) noexcept {
  // Written so that NaN counts as no time; with 0 ticks the loop would run without end.
  if (!(seconds > 0)) return driver::ServoEnd::kDone;
  constexpr double kLongest = 1e9;  // s; 30 years, within the range of 64-bit nanoseconds
  const double ticks =
      std::ceil(std::min(seconds, kLongest) * 1e9 / static_cast<double>(period_ns_));
  const std::atomic<bool> never{false};
  return driver::run_servo(*device_, clock_, law, sink,
                           {.period_ns = period_ns_, .ticks = static_cast<std::uint64_t>(ticks)},
                           never);
}

}  // namespace thimble::scene
