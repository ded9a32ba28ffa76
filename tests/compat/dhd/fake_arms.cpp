#include "compat/dhd/fake_arms.h"

#include <Eigen/LU>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <mutex>
#include <thread>

namespace thimble::compat {
namespace {

constexpr double kPeriod = 1e-3;  // s
constexpr double kMass = 0.1;     // kg
constexpr double kHand = 2;       // N s/m
constexpr double kForceMax = 5;   // N, of the gate
constexpr std::int64_t kStall_ns = 20'000'000;

struct FakeArm {
  bool open = false, enabled = false, regulated = false;
  ArmFacts facts;
  ArmReading reading;
  ForceRequest asked;
  double force_limit = 0, speed_limit = 0;
  std::int64_t watchdog_ns = 0, asked_ns = 0;
  driver::SafetyGate gate{{.force_max = kForceMax,
                           .speed_max = 3,
                           .rise_max = 1e5,
                           .soft_start = 0.05,
                           .stall_ns = kStall_ns,
                           .watchdog_ns = 100'000'000}};
};

std::mutex mutex;
fake::Setup made;
bool over = false;
std::array<FakeArm, kArmsMax> all;
std::vector<std::string> wrong;

Eigen::Map<Eigen::Vector3d> map(std::array<double, 3>& v) {
  return Eigen::Map<Eigen::Vector3d>(v.data());
}

FakeArm* opened(int arm) {
  if (arm < 0 || arm >= made.arms || !all[static_cast<std::size_t>(arm)].open) return nullptr;
  return &all[static_cast<std::size_t>(arm)];
}

// Runs one tick: the requested force goes through the gate and moves the mass.
void tick(FakeArm& arm) {
  ArmReading& now = arm.reading;
  ++now.tick;
  now.time_ns += static_cast<std::int64_t>(1e9 * kPeriod);
  const std::int64_t watchdog =
      arm.watchdog_ns > 0 ? std::min(arm.watchdog_ns, kStall_ns) : kStall_ns;
  now.stalled = now.time_ns - arm.asked_ns > watchdog;
  now.f_client_W = arm.asked.f_W;
  if (now.stalled || !arm.enabled) now.f_client_W = {0, 0, 0};
  Eigen::Vector3d f_W = map(now.f_client_W);
  if (arm.force_limit > 0 && f_W.norm() > arm.force_limit) f_W *= arm.force_limit / f_W.norm();
  now.f_asked_W = {f_W.x(), f_W.y(), f_W.z()};
  if (arm.speed_limit > 0 && !(map(now.v_WT).norm() <= arm.speed_limit)) {
    arm.gate.trip(driver::Fault::kOverSpeed);
  }
  const Eigen::Vector3d sent = arm.gate.pass(f_W, map(now.v_WT), kPeriod).f_T_W();
  now.f_sent_W = {sent.x(), sent.y(), sent.z()};
  now.fault = arm.gate.fault();
  now.stage = now.fault == driver::Fault::kNone ? driver::DeviceStage::kActive
                                                : driver::DeviceStage::kFault;
  if (made.held) return;
  map(now.v_WT) += kPeriod / kMass * (sent - kHand * map(now.v_WT));
  map(now.p_WT) += kPeriod * map(now.v_WT);
  map(now.q) = fake::jacobian().inverse() * map(now.p_WT);
}

}  // namespace

namespace fake {

Eigen::Matrix3d jacobian() {
  return (Eigen::Matrix3d() << 0.1, 0.02, 0, -0.01, 0.12, 0.03, 0.02, 0, 0.09).finished();
}

void reset(const Setup& setup) {
  for (int arm = 0; arm < kArmsMax; ++arm) {
    while (arms::close(arm)) {
    }
  }
  const std::lock_guard lock(mutex);
  made = setup;
  over = false;
  wrong.clear();
  for (int i = 0; i < kArmsMax; ++i) {
    FakeArm& arm = all[static_cast<std::size_t>(i)];
    arm = {};
    std::strcpy(arm.facts.name.data(), i == 1 ? "falcon" : "vintage_phantom");
    arm.facts.has_orientation = arm.facts.has_gimbal = setup.has_orientation;
    arm.facts.has_gripper = setup.has_gripper;
    arm.facts.has_joints = setup.has_joints;
    arm.facts.simulated = setup.simulated;
    arm.facts.force_max = kForceMax;
    arm.facts.stiffness_max = 800;
    arm.facts.damping_max = 8;
    arm.facts.speed_max = 3;
    arm.facts.stall_ns = kStall_ns;
    arm.facts.workspace_min = {-0.1, -0.1, -0.1};
    arm.facts.workspace_max = {0.1, 0.1, 0.1};
    const Eigen::Matrix3d J = jacobian();
    for (Eigen::Index k = 0; k < 9; ++k)
      arm.reading.J_WT[static_cast<std::size_t>(k)] = J(k / 3, k % 3);
  }
}

void change(int arm, const std::function<void(ArmReading&)>& how) {
  const std::lock_guard lock(mutex);
  how(all[static_cast<std::size_t>(arm)].reading);
}

void pass(int arm, double seconds) {
  const std::lock_guard lock(mutex);
  for (double time = 0; time < seconds; time += kPeriod) tick(all[static_cast<std::size_t>(arm)]);
}

Eigen::Vector3d f_sent_W(int arm) {
  const std::lock_guard lock(mutex);
  return map(all[static_cast<std::size_t>(arm)].reading.f_sent_W);
}

ForceRequest asked(int arm) {
  const std::lock_guard lock(mutex);
  return all[static_cast<std::size_t>(arm)].asked;
}

driver::Fault fault(int arm) {
  const std::lock_guard lock(mutex);
  return all[static_cast<std::size_t>(arm)].gate.fault();
}

bool regulated(int arm) {
  const std::lock_guard lock(mutex);
  return all[static_cast<std::size_t>(arm)].regulated;
}

void end_run() {
  const std::lock_guard lock(mutex);
  over = true;
}

std::vector<std::string> wrong_calls() {
  const std::lock_guard lock(mutex);
  return wrong;
}

}  // namespace fake

namespace arms {

int count() noexcept {
  return made.arms;
}

int listed(const char*) noexcept {
  return count();
}

bool is_taken(int arm) noexcept {
  const std::lock_guard lock(mutex);
  return arm == made.taken;
}

std::string open(int arm, const char*) {
  const std::lock_guard lock(mutex);
  if (arm < 0 || arm >= made.arms) return "there is no such arm";
  if (arm == made.taken) return "another program has it";
  all[static_cast<std::size_t>(arm)].open = true;
  return {};
}

bool close(int arm) noexcept {
  const std::lock_guard lock(mutex);
  FakeArm* found = opened(arm);
  if (!found) return false;
  found->open = found->enabled = false;
  found->asked = {};
  return true;
}

bool is_open(int arm) noexcept {
  const std::lock_guard lock(mutex);
  return opened(arm) != nullptr;
}

bool is_running(int arm) noexcept {
  const std::lock_guard lock(mutex);
  return opened(arm) && !over;
}

ArmFacts facts(int arm) noexcept {
  static const ArmFacts kNone;
  return arm >= 0 && arm < made.arms ? all[static_cast<std::size_t>(arm)].facts : kNone;
}

std::string name(int arm) {
  return facts(arm).name.data();
}

bool read(int arm, ArmReading& reading) noexcept {
  const std::lock_guard lock(mutex);
  const FakeArm* found = opened(arm);
  if (found) reading = found->reading;
  return found;
}

// As if the Jacobian grew with the first joint; no joint exceeds a right angle.
bool jacobian_at(int arm, const std::array<double, 3>& q, std::array<double, 9>& J_WT) noexcept {
  const std::lock_guard lock(mutex);
  if (!opened(arm) || !made.has_joints) return false;
  for (const double angle : q) {
    if (!(std::abs(angle) < 1.57)) return false;
  }
  const Eigen::Matrix3d J = (1 + q[0]) * fake::jacobian();
  for (Eigen::Index k = 0; k < 9; ++k) J_WT[static_cast<std::size_t>(k)] = J(k / 3, k % 3);
  return true;
}

bool wait_for_tick(int arm, std::uint64_t after) noexcept {
  // If a thread requests forces, only that thread advances the time.
  for (int i = 0; i < 20'000; ++i) {
    {
      const std::lock_guard lock(mutex);
      const FakeArm* found = opened(arm);
      if (!found || over) return false;
      if (found->reading.tick > after) return true;
    }
    std::this_thread::yield();
  }
  const std::lock_guard lock(mutex);
  FakeArm* found = opened(arm);
  if (!found || over) return false;
  tick(*found);
  return true;
}

bool ask_force(int arm, const ForceRequest& asked) noexcept {
  const std::lock_guard lock(mutex);
  FakeArm* found = opened(arm);
  if (!found || over) return false;
  found->asked = asked;
  found->asked_ns = found->reading.time_ns;
  return true;
}

bool wait_until_taken(int arm) noexcept {
  {
    const std::lock_guard lock(mutex);
    FakeArm* found = opened(arm);
    if (!found || over) return false;
    tick(*found);
  }
  std::this_thread::yield();  // other threads check each tick
  return true;
}

// Programs use wall-clock time here.
std::int64_t now_ns() noexcept {
  return std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void sleep_ns(std::int64_t duration_ns) noexcept {
  std::this_thread::sleep_for(std::chrono::nanoseconds(duration_ns));
}

void lead(int, bool) noexcept {}

bool enable_force(int arm, bool enabled) noexcept {
  const std::lock_guard lock(mutex);
  FakeArm* found = opened(arm);
  if (!found || over) return false;
  if (enabled && (!found->enabled || found->gate.fault() != driver::Fault::kNone))
    found->gate.restart();
  found->enabled = enabled;
  return true;
}

bool force_enabled(int arm) noexcept {
  const std::lock_guard lock(mutex);
  const FakeArm* found = opened(arm);
  return found && found->enabled;
}

bool set_watchdog(int arm, std::int64_t watchdog_ns) noexcept {
  const std::lock_guard lock(mutex);
  FakeArm* found = opened(arm);
  if (found) found->watchdog_ns = watchdog_ns;
  return found;
}

bool set_speed_limit(int arm, double speed) noexcept {
  const std::lock_guard lock(mutex);
  FakeArm* found = opened(arm);
  if (found) found->speed_limit = speed;
  return found;
}

bool set_force_limit(int arm, double force) noexcept {
  const std::lock_guard lock(mutex);
  FakeArm* found = opened(arm);
  if (found) found->force_limit = force;
  return found;
}

bool set_regulated(int arm, bool regulated) noexcept {
  const std::lock_guard lock(mutex);
  FakeArm* found = opened(arm);
  if (found) found->regulated = regulated;
  return found;
}

void wrong_call(const char* function, const char*) noexcept {
  const std::lock_guard lock(mutex);
  wrong.emplace_back(function);
}

}  // namespace arms
}  // namespace thimble::compat
