#include "bringup/bench_arm.h"

#include <algorithm>
#include <cmath>

#include "log/logger.h"
#include "thimble/scene/device_settings.h"
#include "thimble/scene/real_arm.h"

namespace thimble::app {
namespace {

constexpr std::int64_t kPeriod_ns = 1'000'000;
constexpr std::int64_t kWait_ns = 5'000'000;  // for a report, before zero is said again
constexpr std::int64_t kLook_ns = 20'000;
constexpr std::int64_t kSleptThrough_ns = 10 * kPeriod_ns;  // as in a servo loop

}  // namespace

driver::Result<std::unique_ptr<BenchArm>> BenchArm::open(
    const scene::ArmFile& file, const std::optional<driver::FoundArm>& real_arm,
    const std::filesystem::path& firmware,
    const std::vector<std::pair<double, Eigen::Vector3d>>& hand_W, double force_max) {
  std::unique_ptr<BenchArm> bench(new BenchArm);
  std::unique_ptr<driver::ArmLink> link;
  if (real_arm) {
    bench->awake_ = std::make_unique<scene::SleepLock>();
    if (!bench->awake_->held()) scene::logger().warn("{}", bench->awake_->note());
    bench->clock_ = std::make_unique<driver::WallClock>();
    auto opened = scene::open_link(*real_arm, file, firmware, *bench->clock_);
    if (!opened) return opened.error();
    link = std::move(opened).value();
  } else {
    bench->clock_ = std::make_unique<driver::VirtualClock>();
    auto simulation = scene::ArmSimulation::make(file, hand_W, firmware);
    if (!simulation) return simulation.error();
    bench->simulation_ = std::move(simulation).value();
    link = bench->simulation_->link(*bench->clock_);
  }
  // Without the energy stage: what is tried here must be felt as it is sent.
  driver::DeviceSettings settings =
      scene::device_settings(file, 1e9 / kPeriod_ns, driver::EnergyStage::kNone);
  settings.limits.force_max = std::min(settings.limits.force_max, force_max);
  driver::HeatSettings& heat = settings.heat;
  if (real_arm && heat.named())
    heat.at_start = scene::load_heat(real_arm->name(), heat, scene::world_time()).heat;
  auto device = driver::Device::open(std::move(link), settings, bench->clock_->now_ns());
  if (!device) return device.error();
  bench->device_ = std::move(device).value();
  if (real_arm && heat.named()) {
    bench->heat_keeper_ = std::make_unique<scene::HeatKeeper>(real_arm->name(), *bench->device_);
  }
  return bench;
}

bool BenchArm::run(double duration, const Law& law, const std::atomic<bool>& stop, bool silent) {
  const bool active = device_->stage() == driver::DeviceStage::kActive;
  std::int64_t due_ns = clock_->now_ns();
  const std::int64_t end_ns = due_ns + std::llround(duration * 1e9);
  const std::int64_t asleep_ns = clock_->asleep_ns();
  for (; due_ns < end_ns; due_ns += kPeriod_ns) {
    if (stop.load(std::memory_order_relaxed)) return false;
    clock_->sleep_until_ns(due_ns);
    const std::int64_t now_ns = clock_->now_ns();
    if (now_ns - due_ns >= kSleptThrough_ns && clock_->asleep_ns() - asleep_ns >= kPeriod_ns) {
      device_->wake_from_sleep();
    }
    const Eigen::Vector3d f_T_W = law(device_->read(now_ns, now_ns));
    if (!silent) device_->write({.f_T_W = f_T_W, .touch = {}});
    if (!silent && sink_) tell(due_ns, now_ns, f_T_W);
    if (simulation_) true_force_max_ = std::max(true_force_max_, simulation_->f_T_W().norm());
    const bool seen_only = !active && device_->fault() == driver::Fault::kStateNotFinite;
    if (device_->fault() != driver::Fault::kNone && !seen_only) return false;
  }
  return true;
}

void BenchArm::listen(double duration, const std::function<void(double)>& heard,
                      const std::atomic<bool>& stop) {
  const std::int64_t end_ns = clock_->now_ns() + std::llround(duration * 1e9);
  while (clock_->now_ns() < end_ns && !stop.load(std::memory_order_relaxed) && !device_->lost()) {
    const std::int64_t now_ns = clock_->now_ns();
    if (device_->idle(now_ns, std::min(end_ns, now_ns + kWait_ns)).fresh) heard(now());
    // A link that does not wait for its deadline is asked again later.
    if (clock_->now_ns() == now_ns) clock_->sleep_until_ns(now_ns + kLook_ns);
  }
}

void BenchArm::tell(std::int64_t due_ns, std::int64_t now_ns, const Eigen::Vector3d& f_T_W) {
  driver::TickRecord record = driver::record_of(device_->state(), {.f_T_W = f_T_W, .touch = {}});
  record.tick = tick_++;
  record.time_ns = now_ns;
  record.due_ns = due_ns;
  record.f_sent_W = {device_->f_sent_W().x(), device_->f_sent_W().y(), device_->f_sent_W().z()};
  record.stage = device_->stage();
  record.fault = device_->fault();
  record.link = device_->link_state();
  record.home_needed = device_->home_needed();
  sink_(record);
}

bool BenchArm::hold(const std::function<bool()>& done, const std::atomic<bool>& stop) {
  const auto rest = [](const driver::DeviceState&) { return Eigen::Vector3d(0, 0, 0); };
  while (!done()) {
    if (!run(0.02, rest, stop)) return false;
  }
  return true;
}

}  // namespace thimble::app
