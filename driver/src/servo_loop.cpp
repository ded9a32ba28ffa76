#include "thimble/driver/servo_loop.h"

namespace thimble::driver {
namespace {

/// A measured suspension up to this is none, ns: the difference of two clocks that are not read at
/// the same instant.
constexpr std::int64_t kAwake_ns = 1'000'000;
/// A tick this late may have been missed in a suspension, ns [chosen: less than any board waits for
/// a message; a computer takes longer to suspend].
constexpr std::int64_t kLate_ns = 10'000'000;

std::array<double, 3> plain(const Eigen::Vector3d& v) noexcept {
  return {v.x(), v.y(), v.z()};
}

}  // namespace

TickRecord record_of(const DeviceState& state, const ForceCommand& command) noexcept {
  TickRecord record;
  record.tick = state.tick;
  record.time_ns = record.due_ns = state.time_ns;
  record.counts = state.counts;
  record.q = plain(state.q);
  record.p_WT = plain(state.p_WT);
  record.v_WT = plain(state.v_WT);
  record.p_WP = plain(command.touch.p_WP);
  record.n_W = plain(command.touch.n_W);
  record.f_wanted_W = plain(command.f_T_W);
  record.depth = command.touch.depth;
  record.feature = command.touch.feature;
  record.object = command.touch.object;
  record.hops = command.touch.hops;
  if (state.has_orientation) {
    record.q_WT = state.q_WT;
    record.gimbal = state.gimbal;
  }
  if (state.has_gripper) {
    record.has_gripper = true;
    record.gripper = state.gripper;
  }
  record.buttons = state.buttons;
  record.in_contact = command.touch.in_contact;
  record.fresh = state.fresh;
  return record;
}

std::string_view name(ServoEnd end) noexcept {
  switch (end) {
    case ServoEnd::kDone:
      return "done";
    case ServoEnd::kStopped:
      return "stopped";
    case ServoEnd::kFault:
      return "fault";
  }
  return "unknown";
}

ServoLoop::ServoLoop(Device& device, Clock& clock, ForceLaw law, TickSink sink,
                     const ServoSettings& settings) noexcept
    : device_(device),
      clock_(clock),
      law_(law),
      sink_(sink),
      settings_(settings),
      due_ns_(clock.now_ns()),
      end_ns_(due_ns_ + static_cast<std::int64_t>(settings.ticks) * settings.period_ns),
      asleep_ns_(clock.asleep_ns()) {}

std::optional<ServoEnd> ServoLoop::tick(const std::atomic<bool>& stop) noexcept {
  if (end_) return end_;
  if (settings_.ticks != 0 && due_ns_ >= end_ns_) return end_with(ServoEnd::kDone);
  if (settings_.prepare_ns > 0) prepare();
  clock_.sleep_until_ns(due_ns_);
  if (stop.load(std::memory_order_relaxed)) return end_with(ServoEnd::kStopped);
  const std::int64_t now_ns = clock_.now_ns();
  if (now_ns - due_ns_ >= kLate_ns) detect_suspend();
  const DeviceState& state = device_.read(now_ns, now_ns);
  const ForceCommand command = law_(state);
  device_.write(command);

  TickRecord record = record_of(state, command);
  record.f_sent_W = plain(device_.f_sent_W());
  if (device_.heat().named()) record.heat = device_.heat().heat();
  record.stage = device_.stage();
  record.fault = device_.fault();
  record.link = device_.link_state();
  record.home_needed = device_.home_needed();
  record.due_ns = due_ns_;
  record.work_ns = clock_.now_ns() - now_ns;
  sink_(record);
  if (device_.fault() != Fault::kNone && !settings_.continue_after_faults) {
    return end_with(ServoEnd::kFault);
  }
  due_ns_ += settings_.period_ns;
  const std::int64_t late_ns = now_ns - due_ns_;
  if (late_ns >= 0) due_ns_ += (late_ns / settings_.period_ns + 1) * settings_.period_ns;
  return std::nullopt;
}

void ServoLoop::detect_suspend() noexcept {
  const std::int64_t asleep_ns = clock_.asleep_ns();
  if (asleep_ns - asleep_ns_ >= kAwake_ns) device_.wake_from_sleep();
  asleep_ns_ = asleep_ns;
}

// The tip is extrapolated with its present velocity.
void ServoLoop::prepare() noexcept {
  clock_.sleep_until_ns(due_ns_ - settings_.prepare_ns);
  if (clock_.now_ns() >= due_ns_) return;
  DeviceState expected = device_.state();
  expected.dt = 1e-9 * static_cast<double>(settings_.period_ns);
  expected.p_WT += expected.dt * expected.v_WT;
  law_.prepare(expected);
}

std::optional<ServoEnd> ServoLoop::end_with(ServoEnd end) noexcept {
  device_.deactivate();
  if (!device_.zero_assured() && !device_.lost()) device_.insist_on_zero(clock_);
  return end_ = end;
}

ServoEnd run_servo(Device& device, Clock& clock, ForceLaw law, TickSink sink,
                   const ServoSettings& settings, const std::atomic<bool>& stop) noexcept {
  ServoLoop loop(device, clock, law, sink, settings);
  for (;;) {
    if (const auto end = loop.tick(stop)) return *end;
  }
}

}  // namespace thimble::driver
