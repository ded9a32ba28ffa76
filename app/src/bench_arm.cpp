#include "bench_arm.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "real_arm.h"
#include "thimble/device_sim/sim_transport.h"

namespace thimble::app {
namespace {

constexpr std::int64_t kPeriod_ns = 1'000'000;

}  // namespace

driver::Result<std::unique_ptr<BenchArm>> BenchArm::open(
    const ArmFile& file, const std::optional<driver::FoundArm>& real_arm,
    const std::filesystem::path& firmware,
    const std::vector<std::pair<double, Eigen::Vector3d>>& hand_W, double force_max) {
  std::unique_ptr<BenchArm> bench(new BenchArm);
  std::unique_ptr<driver::Transport> wire;
  std::unique_ptr<const driver::Arm> protocol;
  if (real_arm) {
    bench->clock_ = std::make_unique<driver::WallClock>();
    auto opened = open_wire(*real_arm, file, firmware, *bench->clock_);
    if (!opened) return opened.error();
    wire = std::move(opened).value();
    protocol = make_arm(file, real_arm->kind);
  } else {
    if (!file.can_simulate) {
      return driver::Error{"The arm " + file.name +
                           " cannot be simulated inside the program; plug it in."};
    }
    bench->clock_ = std::make_unique<driver::VirtualClock>();
    std::vector<device_sim::HandPath::Point> points;
    for (const auto& [time, p_WH] : hand_W) {
      points.push_back({.time = time, .p_BH = file.R_WB.transpose() * (p_WH - file.p_WB)});
    }
    try {
      bench->arm_ = std::make_unique<device_sim::SimulatedArm>(
          file.model, file.simulated, device_sim::HandPath(std::move(points)));
    } catch (const std::invalid_argument& wrong) {
      return driver::Error{file.name + ": " + wrong.what()};
    }
    wire = std::make_unique<device_sim::SimTransport>(*bench->clock_, *bench->arm_);
    protocol = std::make_unique<driver::hfab::HfabArm>(file.model);
  }
  driver::GateLimits limits = file.limits;
  limits.force_max = std::min(limits.force_max, force_max);
  auto device = driver::Device::open(std::move(wire), std::move(protocol),
                                     {.R_WB = file.R_WB,
                                      .p_WB = file.p_WB,
                                      .limits = limits,
                                      .velocity_corner_frequency = file.velocity_corner_frequency},
                                     bench->clock_->now_ns());
  if (!device) return device.error();
  bench->device_ = std::move(device).value();
  return bench;
}

bool BenchArm::run(double duration, const Law& law, const std::atomic<bool>& stop, bool silent) {
  std::int64_t due_ns = clock_->now_ns();
  const std::int64_t end_ns = due_ns + std::llround(duration * 1e9);
  for (; due_ns < end_ns; due_ns += kPeriod_ns) {
    if (stop.load(std::memory_order_relaxed)) return false;
    clock_->sleep_until_ns(due_ns);
    const std::int64_t now_ns = clock_->now_ns();
    const Eigen::Vector3d f_T_W = law(device_->read(now_ns, now_ns));
    if (!silent) device_->write({.f_T_W = f_T_W, .touch = {}});
    if (device_->fault() != driver::Fault::kNone) return false;
  }
  return true;
}

bool BenchArm::hold(const std::function<bool()>& done, const std::atomic<bool>& stop) {
  const auto rest = [](const driver::DeviceState&) { return Eigen::Vector3d(0, 0, 0); };
  while (!done()) {
    if (!run(0.02, rest, stop)) return false;
  }
  return true;
}

}  // namespace thimble::app
