#include "bringup/bench_arm.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "arm/report_timeout.h"
#include "log/logger.h"
#include "thimble/driver/device.h"
#include "thimble/scene/arm_file.h"
#include "thimble/scene/real_arm.h"

namespace thimble::bringup {
namespace {

constexpr std::int64_t kPeriod_ns = 1'000'000;
// Max. wait for a report before zero force is sent again
constexpr std::int64_t kWait_ns = 5'000'000;
constexpr std::int64_t kLook_ns = 20'000;
// Delay of a tick from which the computer may have slept, as in a servo loop
constexpr std::int64_t kSleptThrough_ns = 10 * kPeriod_ns;
constexpr double kAlign_s = 0.25;            // s, duration of timing reports before the first tick
constexpr double kEven = 1e-6;               // s, below which reports have the same phase
constexpr double kAlignedMax = 0.8;          // of a period; above it, phases are not used
constexpr std::int64_t kFollow_ns = 50'000;  // shift of the ticks to follow reports that drift

/// Returns the mean of phases; 0 for none.
double phases_middle(const std::vector<double>& phases) {
  double sum = 0;
  for (const double phase : phases) sum += phase;
  return phases.empty() ? 0 : sum / static_cast<double>(phases.size());
}

}  // namespace

driver::Result<std::unique_ptr<BenchArm>> BenchArm::open(
    const scene::ArmFile& file, const std::optional<driver::FoundArm>& real_arm,
    const std::filesystem::path& firmware,
    const std::vector<std::pair<double, Eigen::Vector3d>>& hand_W, double force_max,
    std::unique_ptr<driver::Clock> clock) {
  std::unique_ptr<BenchArm> bench(new BenchArm);
  std::unique_ptr<driver::ArmLink> link;
  if (real_arm) {
    bench->awake_ = std::make_unique<scene::SleepLock>();
    if (!bench->awake_->held()) scene::logger().warn("{}", bench->awake_->note());
    bench->clock_ = std::make_unique<driver::WallClock>();
    bench->latency_ = std::make_unique<driver::CpuLatencyRequest>();
    auto opened = scene::open_link(*real_arm, file, firmware, *bench->clock_);
    if (!opened) return opened.error();
    link = std::move(opened).value();
  } else {
    bench->clock_ = clock ? std::move(clock) : std::make_unique<driver::VirtualClock>();
    auto simulation = scene::ArmSimulation::make(file, hand_W, firmware);
    if (!simulation) return simulation.error();
    bench->simulation_ = std::move(simulation).value();
    link = bench->simulation_->link(*bench->clock_);
  }
  if (auto opened = bench->open_device(file, std::move(link), force_max, real_arm); !opened) {
    return opened.error();
  }
  if (real_arm || file.simulated.wire.jitter_ns > 0) bench->align();
  return bench;
}

driver::Result<std::unique_ptr<BenchArm>> BenchArm::open_link(const scene::ArmFile& file,
                                                              std::unique_ptr<driver::ArmLink> link,
                                                              std::unique_ptr<driver::Clock> clock,
                                                              double force_max) {
  std::unique_ptr<BenchArm> bench(new BenchArm);
  bench->clock_ = std::move(clock);
  if (auto opened = bench->open_device(file, std::move(link), force_max, {}); !opened) {
    return opened.error();
  }
  return bench;
}

driver::Result<void> BenchArm::open_device(const scene::ArmFile& file,
                                           std::unique_ptr<driver::ArmLink> link, double force_max,
                                           const std::optional<driver::FoundArm>& real_arm) {
  real_ = real_arm.has_value();
  // Without the energy stage: forces must act as they are sent.
  driver::DeviceSettings settings =
      scene::device_settings(file, 1e9 / kPeriod_ns, driver::EnergyStage::kNone);
  settings.limits.force_max = std::min(settings.limits.force_max, force_max);
  driver::HeatSettings& heat = settings.heat;
  if (real_arm && heat.named()) {
    heat.at_start = scene::load_heat(real_arm->name(), heat, scene::world_time()).heat;
  }
  auto device =
      driver::Device::open(std::move(link), settings, clock_->now_ns(),
                           real_arm ? scene::kReportTimeout_ns : scene::report_timeout_ns(file));
  if (!device) return device.error();
  device_ = std::move(device).value();
  if (real_arm && heat.named()) {
    heat_keeper_ = std::make_unique<scene::HeatKeeper>(real_arm->name(), *device_);
  }
  return {};
}

bool BenchArm::run(double duration, const Law& law, const std::atomic<bool>& stop, bool silent) {
  const LoopPriority priority(!simulated());
  const bool active = device_->stage() == driver::DeviceStage::kActive;
  std::int64_t due_ns = first_due_ns();
  std::int64_t end_ns = due_ns + std::llround(duration * 1e9);
  const std::int64_t first_ns = due_ns;
  const std::int64_t asleep_ns = clock_->asleep_ns();
  for (; due_ns < end_ns; due_ns += kPeriod_ns) {
    if (stop.load(std::memory_order_relaxed)) return false;
    clock_->sleep_until_ns(due_ns);
    const std::int64_t now_ns = clock_->now_ns();
    late_.count(1e-9 * static_cast<double>(now_ns - due_ns), 1e-9 * kPeriod_ns);
    if (now_ns - due_ns >= kSleptThrough_ns && clock_->asleep_ns() - asleep_ns >= kPeriod_ns) {
      device_->wake_from_sleep();
    }
    const driver::DeviceState& state = device_->read(now_ns, now_ns);
    // A report came just after its tick, because the clocks of board and host drift apart. The
    // first tick may be at the time of the last one of an earlier run, which has taken the report.
    if (phase_ns_ && !silent && !state.fresh && due_ns != first_ns) {
      due_ns += kFollow_ns;
      end_ns += kFollow_ns;
      *phase_ns_ += kFollow_ns;
    }
    const Eigen::Vector3d f_T_W = law(state);
    if (!silent) device_->write({.f_T_W = f_T_W, .touch = {}});
    if (!silent && sink_) report_tick(due_ns, now_ns, f_T_W);
    if (simulation_) true_force_max_ = std::max(true_force_max_, simulation_->f_T_W().norm());
    const bool seen_only = !active && device_->fault() == driver::Fault::kStateNotFinite;
    if (device_->fault() != driver::Fault::kNone && !seen_only) return false;
  }
  return true;
}

/// Places the ticks after the reports of an idle arm, whose phases in the period vary. Otherwise
/// some ticks would have no report, and the next ones two.
void BenchArm::align() {
  const std::atomic<bool> never{false};
  std::vector<double> phases;  // s after the first, modulo the period
  const std::int64_t first_ns = clock_->now_ns();
  constexpr double kPeriod = 1e-9 * kPeriod_ns;
  const auto heard = [&](double time) {
    // Shifted by whole periods to the nearest of the earlier phases, so that phases around the wrap
    // of a period stay together.
    const double middle = phases_middle(phases);
    const double since = time - 1e-9 * static_cast<double>(first_ns);
    phases.push_back(middle + std::remainder(since - middle, kPeriod));
  };
  listen(kAlign_s, heard, never);
  if (phases.size() < 50) return;
  const auto [earliest, latest] = std::minmax_element(phases.begin(), phases.end());
  const double spread = *latest - *earliest;
  // The phase is random if reports have another period, or if the arm sends only when asked.
  if (spread < kEven || spread > kAlignedMax * kPeriod) return;
  const double behind = *latest + 0.1 * spread;
  read_late_ = behind - phases_middle(phases);
  phase_ns_ = first_ns + std::llround(1e9 * behind);
}

std::int64_t BenchArm::first_due_ns() const {
  const std::int64_t now_ns = clock_->now_ns();
  if (!phase_ns_) return now_ns;
  const std::int64_t since_ns = (now_ns - *phase_ns_) % kPeriod_ns;
  if (since_ns == 0) return now_ns;
  return now_ns + (since_ns > 0 ? kPeriod_ns - since_ns : -since_ns);
}

void BenchArm::listen(double duration, const std::function<void(double)>& heard,
                      const std::atomic<bool>& stop) {
  const LoopPriority priority(!simulated());
  const std::int64_t end_ns = clock_->now_ns() + std::llround(duration * 1e9);
  while (clock_->now_ns() < end_ns && !stop.load(std::memory_order_relaxed) && !device_->lost()) {
    const std::int64_t now_ns = clock_->now_ns();
    if (device_->idle(now_ns, std::min(end_ns, now_ns + kWait_ns)).fresh) heard(now());
    // A link that returned before its deadline is read again later.
    if (clock_->now_ns() == now_ns) clock_->sleep_until_ns(now_ns + kLook_ns);
  }
}

void BenchArm::report_tick(std::int64_t due_ns, std::int64_t now_ns, const Eigen::Vector3d& f_T_W) {
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

void BenchArm::stay_silent(double duration, const std::atomic<bool>& stop) {
  constexpr std::int64_t kStep_ns = 10'000'000;
  const std::int64_t end_ns = clock_->now_ns() + std::llround(duration * 1e9);
  while (clock_->now_ns() < end_ns && !stop.load(std::memory_order_relaxed)) {
    clock_->sleep_until_ns(std::min(end_ns, clock_->now_ns() + kStep_ns));
  }
  // Nothing else advances a simulated arm during this time; frames in flight stay in flight.
  if (simulation_) simulation_->settle(clock_->now_ns() - kStep_ns);
}

void BenchArm::ask(int times) {
  for (int i = 0; i < times; ++i) {
    const std::int64_t now_ns = clock_->now_ns();
    device_->idle(now_ns, now_ns);
    clock_->sleep_until_ns(now_ns + kPeriod_ns);
  }
}

bool BenchArm::hold(const std::function<bool()>& done, const std::atomic<bool>& stop) {
  const auto rest = [](const driver::DeviceState&) { return Eigen::Vector3d(0, 0, 0); };
  while (!done()) {
    if (!run(0.02, rest, stop)) return false;
  }
  return true;
}

}  // namespace thimble::bringup
