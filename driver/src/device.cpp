#include "thimble/driver/device.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "thimble/driver/wire_arm.h"

namespace thimble::driver {
namespace {

// Beyond these a limit protects nobody.
/// Shortest soft start, s [chosen: below 50 ms a hand feels no ramp but a knock; it reacts to a
/// push after 100 ms and more].
constexpr double kSoftStartLeast = 0.05;
/// Fastest rise, N/s [chosen: 100 N in a tick of 1 ms, beyond what any arm here can push at all],
constexpr double kRiseMost = 1e5;
/// or shortest time to the whole force, s, for a force so large that only a bench asks for it
/// [chosen: a tick of the fastest loop here, 20 kHz].
constexpr double kRiseTimeLeast = 5e-5;
/// Longest gap that is no fault, ns [chosen: twice the longest watchdog of a board, 0.5 s of the
/// mbed one (woody_report.h)].
constexpr std::int64_t kWatchdogMost_ns = 1'000'000'000;

/// Time between two tries to have the zero force taken, ns: a frame of a full-speed bus.
constexpr std::int64_t kZeroAgain_ns = 1'000'000;

bool is_limit(double value) noexcept {
  return value > 0 && value < HUGE_VAL;
}

Result<void> check(const DeviceSettings& settings) {
  const GateLimits& limits = settings.limits;
  const auto wrong = [](const char* what, const char* least = "above zero") {
    return Error{std::string("The arm's ") + what + " must be a finite number " + least +
                 "; set it in the arm file."};
  };
  const auto loose = [](const char* what, const char* bound) {
    return Error{std::string("The arm's ") + what + " protects nobody as it is set: it must be " +
                 bound + "; set it in the arm file."};
  };
  if (!is_limit(limits.force_max)) return wrong("force_max");
  if (!is_limit(limits.speed_max)) return wrong("speed_max");
  if (!is_limit(limits.rise_max)) return wrong("rise_max");
  if (!is_limit(limits.soft_start)) return wrong("soft_start");
  if (!is_limit(limits.reopen)) return wrong("reopen time");
  if (limits.soft_start < kSoftStartLeast) return loose("soft_start", "at least 0.05 s");
  if (limits.rise_max > std::max(kRiseMost, limits.force_max / kRiseTimeLeast))
    return loose("rise_max", "at most 100,000 N/s");
  if (limits.stall_ns <= 0) return wrong("stall time");
  if (limits.watchdog_ns <= 0) return wrong("watchdog time");
  if (limits.watchdog_ns > kWatchdogMost_ns) return loose("watchdog time", "at most 1 s");
  if (settings.silence_limit_ns <= 0) return wrong("silence limit");
  if (!is_limit(settings.motion.hold_most)) return wrong("hold_unchanged time");
  for (std::size_t i = 0; settings.heat.named() && i < 3; ++i) {
    if (!is_limit(settings.heat.continuous_current[i])) return wrong("continuous_current");
    if (!is_limit(settings.heat.time_constant[i])) return wrong("thermal_time_constant");
  }
  const EnergyGuardSettings& energy = settings.energy;
  if (energy.stage == EnergyStage::kPassivity) {
    if (!is_limit(energy.mass)) return wrong("tip mass, which its passivity stage needs,");
    if (!is_limit(energy.reservoir)) return wrong("energy reservoir");
    if (!(energy.allowance >= 0)) return wrong("energy allowance", "of zero or more");
    if (!(energy.speed_floor >= 0 && energy.speed_floor < HUGE_VAL)) {
      return wrong("speed floor", "of zero or more");
    }
  }
  if (energy.stage == EnergyStage::kBounding && !is_limit(energy.slope)) {
    return wrong("slope of the energy bound");
  }
  if (energy.delay_ticks < 0 || energy.delay_ticks > EnergyGuardSettings::kDelayMost) {
    return Error{"The energy stage of the gate knows delays of 0 to 15 ticks; the loop's is " +
                 std::to_string(energy.delay_ticks) + "."};
  }
  return {};
}

}  // namespace

Device::Device(std::unique_ptr<Transport> transport, std::unique_ptr<const Arm> arm,
               const DeviceSettings& settings) noexcept
    : transport_(std::move(transport)),
      arm_(std::move(arm)),
      settings_(settings),
      gate_(settings.limits, settings.energy),
      motion_(settings.motion),
      heat_(settings.heat, arm_->drives(), 1e-9 * static_cast<double>(settings.limits.watchdog_ns)),
      velocity_(settings.velocity_corner_frequency) {}

Device::~Device() {
  deactivate();
  if (!insisted_ && !f_sent_W_.isZero(0)) {
    WallClock clock(0);
    insist_on_zero(clock);
  }
  delete offered_.exchange(nullptr);
  delete retired_.exchange(nullptr);
}

Result<std::unique_ptr<Device>> Device::open(std::unique_ptr<Transport> transport,
                                             std::unique_ptr<const Arm> arm,
                                             const DeviceSettings& settings,
                                             std::int64_t clock_now_ns, std::int64_t timeout_ns) {
  if (auto checked = check(settings); !checked) return checked.error();
  std::unique_ptr<Device> device(new Device(std::move(transport), std::move(arm), settings));
  // Whatever was in flight before, the motors start from zero. An arm that speaks only when spoken
  // to may miss the first message while it starts up, so zero is said again with each wait.
  constexpr int kGreetings = 10;
  constexpr int kAttempts = 100;  // reports of a form nobody knows, before giving up
  int attempt = 0;
  for (int greeting = 1; greeting <= kGreetings && !device->lost_; ++greeting) {
    device->send_zero();
    const std::int64_t deadline_ns = clock_now_ns + timeout_ns * greeting / kGreetings;
    for (; attempt < kAttempts && !device->lost_; ++attempt) {
      const std::uint64_t rejected = device->wire_.rejected;
      if (device->take_report(clock_now_ns, deadline_ns)) return device;
      if (device->wire_.rejected == rejected) break;
    }
  }
  if (device->lost_) return Error{std::string(describe(Fault::kTransportLost))};
  if (device->wire_.rejected > 0) {
    return Error{"The arm sends reports of a form that its driver does not know (" +
                 std::to_string(device->wire_.rejected) +
                 " rejected). Check that the arm file is the one of this arm."};
  }
  return Error{"The arm sent no report within " + std::to_string(timeout_ns / 1'000'000) +
               " ms. Check its power and cable, and that no other program uses it."};
}

Result<void> Device::activate() {
  if (lost_) return Error{std::string(describe(Fault::kTransportLost))};
  begin_activity();
  return {};
}

void Device::begin_activity() noexcept {
  gate_.restart();
  motion_.restart();
  velocity_.reset();
  refused_in_a_row_ = 0;
  active_ = true;
  insisted_ = false;
  started_ = false;
  booked_ = false;
  tau_sent_.fill(Eigen::Vector3d::Zero());
  choose_way();
}

void Device::choose_way() noexcept {
  plain_ = active_ && !lost_ && gate_.energy_stage() == EnergyStage::kNone && !heat_.named();
}

void Device::offer(std::unique_ptr<Transport> transport) {
  delete retired_.exchange(nullptr, std::memory_order_acq_rel);
  delete offered_.exchange(transport.release(), std::memory_order_acq_rel);
}

void Device::take_offer(std::int64_t now_ns) noexcept {
  // The old wire may free memory when it goes, so it waits for the next offer or the end. Without
  // a free place for it the offer is left for a later tick.
  if (retired_.load(std::memory_order_acquire) != nullptr) return;
  Transport* const fresh = offered_.exchange(nullptr, std::memory_order_acq_rel);
  if (fresh == nullptr) return;
  retired_.store(transport_.release(), std::memory_order_release);
  transport_.reset(fresh);
  ++wire_.replugged;
  lost_ = false;
  reported_ = numbered_ = false;
  number_.reset();
  active_ = false;
  choose_way();
  refused_in_a_row_ = 0;
  last_report_ns_ = now_ns;
  velocity_.reset();
  known_to_stand_ = insisted_ = false;  // of this wire nothing is known
  send_zero();
}

void Device::deactivate() noexcept {
  active_ = false;
  choose_way();
  send_zero();
  // A converter tells of the message before, so that the next one may well go through.
  if (!zero_assured()) send_zero();
}

bool Device::insist_on_zero(Clock& clock) noexcept {
  insisted_ = true;
  const std::int64_t begin_ns = clock.now_ns();
  // Counted, so that it ends with any clock.
  const std::int64_t tries = settings_.limits.watchdog_ns / kZeroAgain_ns + 1;
  for (std::int64_t i = 0; i < tries && !zero_assured() && !lost_; ++i) {
    if (clock.now_ns() - begin_ns > settings_.limits.watchdog_ns) break;
    clock.sleep_until_ns(clock.now_ns() + kZeroAgain_ns);
    send_zero();
  }
  if (!zero_assured()) gate_.trip(Fault::kRefused);
  return zero_assured();
}

DeviceStage Device::stage() const noexcept {
  if (gate_.fault() != Fault::kNone) return DeviceStage::kFault;
  return active_ ? DeviceStage::kActive : DeviceStage::kIdle;
}

const DeviceState& Device::read(std::int64_t now_ns, std::int64_t deadline_ns) noexcept {
  if (lost_) take_offer(now_ns);
  if (activation_asked_.exchange(false, std::memory_order_acq_rel) && !lost_ && reported_) {
    begin_activity();
  }
  if (started_) {
    // What would follow is a force that grows the wrong way, and a silence that nobody notices.
    if (now_ns < state_.time_ns) gate_.trip(Fault::kTimeNotMonotonic);
    state_.dt = static_cast<double>(now_ns - state_.time_ns) * 1e-9;
    ++state_.tick;
  } else {
    started_ = true;
    state_.dt = 0;
    last_report_ns_ = now_ns;
  }
  state_.time_ns = now_ns;
  state_.fresh = take_report(now_ns, deadline_ns);
  if (!state_.fresh) {
    ++wire_.missing;
    if (now_ns - last_report_ns_ > settings_.silence_limit_ns) gate_.trip(Fault::kNoReports);
  }
  return state_;
}

const DeviceState& Device::idle(std::int64_t now_ns, std::int64_t deadline_ns) noexcept {
  started_ = false;  // the next tick is the first one again
  state_.time_ns = now_ns;
  state_.fresh = take_report(now_ns, deadline_ns);
  send_zero();
  return state_;
}

bool Device::take_report(std::int64_t now_ns, std::int64_t deadline_ns) noexcept {
  std::array<std::byte, kReportCapacity> buffer;
  const TransportRead read = transport_->read_latest(buffer, deadline_ns);
  wire_.skipped += read.skipped;
  if (read.status == TransportStatus::kLost) {
    lost_ = true;
    choose_way();
    gate_.trip(Fault::kTransportLost);
  }
  if (read.status != TransportStatus::kOk) return false;

  ArmReading reading;
  if (!arm_->decode(std::span<const std::byte>(buffer).first(read.size), reading)) {
    ++wire_.rejected;
    return false;
  }
  if (came_before(reading)) {
    ++wire_.repeated;
    return false;
  }
  const ArmPose pose = arm_->pose(reading);
  const double since_last = static_cast<double>(now_ns - last_report_ns_) * 1e-9;
  const Eigen::Vector3d p_WT = settings_.p_WB + settings_.R_WB * pose.p_BT;
  if (jumped(p_WT, since_last)) return false;
  ++wire_.reports;
  reported_ = true;
  pose_ = pose;
  state_.counts = reading.counts;
  state_.buttons = reading.buttons;
  state_.q = pose_.q;
  state_.p_WT = p_WT;
  state_.v_WT = velocity_.update(state_.p_WT, since_last);
  if (!(state_.p_WT.squaredNorm() < HUGE_VAL)) gate_.trip(Fault::kStateNotFinite);
  last_report_ns_ = now_ns;
  return true;
}

bool Device::jumped(const Eigen::Vector3d& p_WT, double since_last) noexcept {
  // 100 times gravity; impacts of a hand-held tip on a surface stay below 10 of them (5 N on 50 g).
  constexpr double kAcceleration = 1000;  // m/s^2
  // Reports come in frames of 1 ms; a loop that is late sees them closer together than they are.
  constexpr double kLeast = 1e-3, kMost = 5e-3;  // s
  const bool known = active_ && velocity_.primed() && !jumped_ && since_last < kMost;
  const double time = since_last > kLeast ? since_last : kLeast;
  const Eigen::Vector3d off = p_WT - state_.p_WT - state_.v_WT * since_last;
  const double most = kAcceleration * time * time;
  jumped_ = known && off.squaredNorm() > most * most;
  if (jumped_) ++wire_.jumped;
  return jumped_;
}

bool Device::came_before(const ArmReading& reading) noexcept {
  if (!reading.number) return false;
  const bool same = number_ == reading.number;
  // A board that leaves the number alone says nothing by it.
  if (number_ && !same) numbered_ = true;
  number_ = reading.number;
  return same && numbered_;
}

void Device::write(const ForceCommand& command) noexcept {
  if (!plain_) return write_otherwise(command);
  watch();
  const GatedForce force = gate_.pass(command.f_T_W, state_.v_WT, state_.dt);
  const MotorCurrents currents(force, settings_.R_WB, pose_.J_BT, arm_->drives());
  if (!send(currents)) return keep_standing();
  f_sent_W_ = currents.scale() * force.f_T_W();
}

void Device::watch() noexcept {
  if (!motion_.take(state_, f_sent_W_)) return;
  const Fault fault = motion_.judge(state_, settings_.R_WB, pose_.J_BT, numbered_);
  if (fault != Fault::kNone) gate_.trip(fault);
}

void Device::write_otherwise(const ForceCommand& command) noexcept {
  if (heat_.named()) heat_.advance(state_.dt);
  if (active_ && !lost_) return write_guarded(command);
  send_zero();
}

void Device::send_zero() noexcept {
  if (!send(MotorCurrents())) return keep_standing();
  f_sent_W_.setZero();
  if (heat_.named()) heat_.sent({}, false);
  known_to_stand_ = true;
  insisted_ = false;
}

void Device::keep_standing() noexcept {
  if (lost_ && !f_sent_W_.isZero(0)) {
    // An arm that is gone is the business of its own watchdog, and gets nothing from us any more.
    f_sent_W_.setZero();
    known_to_stand_ = false;
    if (heat_.named()) heat_.sent({}, false);
  }
  gate_.resume_from(f_sent_W_);
}

// Work is booked at the joints, tau . dq, with the torques as the message holds them: exact for
// motors that hold their torque, where f . dx would take the Jacobian of one end of the way.
void Device::write_guarded(const ForceCommand& command) noexcept {
  watch();
  EnergyFlow flow;
  const auto delay = static_cast<std::size_t>(settings_.energy.delay_ticks);
  if (booked_) {
    flow = {.work = tau_sent_[delay].dot(pose_.q - q_booked_),
            .move_W = state_.p_WT - p_booked_W_,
            .f_sent_W = f_sent_W_,
            // Of a linear spring; what the gate cuts off a force holds no more than this.
            .held = 0.5 * command.f_T_W.norm() * command.touch.depth};
  }
  booked_ = true;
  q_booked_ = pose_.q;
  p_booked_W_ = state_.p_WT;
  const GatedForce force = gate_.pass_guarded(command.f_T_W, state_.v_WT, state_.dt, flow);
  const MotorCurrents currents(force, settings_.R_WB, pose_.J_BT,
                               heat_.named() ? heat_.drives() : arm_->drives());
  const bool taken = send(currents);
  for (std::size_t i = delay; i > 0; --i) tau_sent_[i] = tau_sent_[i - 1];
  // Torques that were not taken move nothing: those before stand.
  if (!taken) return keep_standing();
  tau_sent_[0] = torque_of(currents);
  if (heat_.named()) heat_.sent(whole_mA(currents), currents.scale() < 1);
  f_sent_W_ = currents.scale() * force.f_T_W();
}

Eigen::Vector3d Device::torque_of(const MotorCurrents& currents) const noexcept {
  const std::array<std::int16_t, 3> mA = whole_mA(currents);
  Eigen::Vector3d tau;
  for (std::size_t i = 0; i < 3; ++i) {
    const MotorDrive& drive = arm_->drives()[i];
    tau[static_cast<Eigen::Index>(i)] =
        drive.sign * drive.ratio * drive.torque_constant * 1e-3 * mA[i];
  }
  return tau;
}

bool Device::send(const MotorCurrents& currents) noexcept {
  if (lost_) return false;
  std::array<std::byte, kReportCapacity> report;
  const std::size_t size = arm_->encode(currents, report);
  const auto status = transport_->write(std::span<const std::byte>(report).first(size));
  if (status == TransportStatus::kLost) {
    lost_ = true;
    choose_way();
    gate_.trip(Fault::kTransportLost);
  }
  if (status != TransportStatus::kRefused) {
    refused_in_a_row_ = 0;
    return status == TransportStatus::kOk;
  }
  ++wire_.refused;
  if (refused_in_a_row_++ == 0) refused_since_ns_ = state_.time_ns;
  if (state_.time_ns - refused_since_ns_ > settings_.silence_limit_ns) gate_.trip(Fault::kRefused);
  return false;
}

}  // namespace thimble::driver
