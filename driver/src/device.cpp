#include "thimble/driver/device.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include "gate/enabling_input.h"
#include "gate/workspace_walls.h"
#include "thimble/driver/wire_arm.h"
#include "velocity_estimator.h"
#include "work_account.h"

namespace thimble::driver {
namespace {

/// Time between two attempts to send the zero force, ns: a frame of a full-speed bus.
constexpr std::int64_t kZeroAgain_ns = 1'000'000;

/// For an arm without encoder counts: a change of position that counts as a step, m; less than the
/// resolution of any arm here.
constexpr double kPositionStep = 1e-6;

/// A step of the tip during a gap in the reports that no hand motion explains, m. It is measured
/// from the position that the velocity predicts, and equals the max. distance from the home pose
/// when forces are requested (session/start_pose.h explains why a smaller step is harmless).
/// [chosen: within a silence that is no fault yet, it takes a change of the velocity of 1 m/s]
constexpr double kUnseenStep = 0.02;

/// Pole of the slowest velocity that the gate uses, Hz, whatever filter a law requests [chosen:
/// that of the shipped arms, 1.6 ms behind the tip].
constexpr double kGateCorner = 100;

/// Returns the gate's own estimator; null if the one for laws is as fast.
std::unique_ptr<VelocityEstimator> own_estimate(double corner_frequency) {
  if (!(corner_frequency > 0 && corner_frequency < kGateCorner)) return nullptr;
  return std::make_unique<VelocityEstimator>(kGateCorner);
}

/// Returns the projection of a vector in the world to the first `axes` axes of the base.
Eigen::Matrix3d projection(const Eigen::Matrix3d& R_WB, int axes) {
  return R_WB.leftCols(axes) * R_WB.leftCols(axes).transpose();
}

/// Returns the joint torques of the currents in a message, N m.
Eigen::Vector3d torque_of(const std::array<std::int16_t, 3>& mA,
                          const std::array<MotorDrive, 3>& motors) noexcept {
  Eigen::Vector3d tau;
  for (std::size_t i = 0; i < 3; ++i) {
    const MotorDrive& drive = motors[i];
    tau[static_cast<Eigen::Index>(i)] =
        drive.sign * drive.ratio * drive.torque_constant * 1e-3 * mA[i];
  }
  return tau;
}

}  // namespace

Device::Device(std::unique_ptr<ArmLink> link, const DeviceSettings& settings) noexcept
    : link_(std::move(link)),
      traits_(link_->traits()),
      settings_(settings),
      gate_(settings.limits, settings.energy),
      motion_(settings.motion),
      heat_(settings.heat, traits_.motors.value_or(std::array<MotorDrive, 3>{}),
            1e-9 * static_cast<double>(settings.limits.watchdog_ns)),
      work_(std::make_unique<WorkAccount>(settings.energy.delay_ticks)),
      velocity_(std::make_unique<VelocityEstimator>(settings.velocity_corner_frequency)),
      own_velocity_(own_estimate(settings.velocity_corner_frequency)),
      walls_(std::make_unique<WorkspaceWalls>(settings.walls)),
      enabling_(settings.hold.named() ? std::make_unique<EnablingInput>(settings.hold) : nullptr),
      guarded_(settings.energy.stage != EnergyStage::kNone || settings.heat.named()),
      partial_(traits_.axes < 3),
      extras_(traits_.has_velocity || traits_.has_orientation || traits_.has_gimbal ||
              traits_.has_gripper || !traits_.has_counts),
      along_axes_W_(projection(settings.R_WB, traits_.axes)) {
  state_.has_orientation = traits_.has_orientation;
  state_.has_gripper = traits_.has_gripper;
}

Device::~Device() {
  deactivate();
  if (!insisted_ && !zero_assured()) {
    WallClock clock(0);
    insist_on_zero(clock);
  }
  delete offered_.exchange(nullptr);
  delete retired_.exchange(nullptr);
}

Result<std::unique_ptr<Device>> Device::open(std::unique_ptr<ArmLink> link,
                                             const DeviceSettings& settings,
                                             std::int64_t clock_now_ns, std::int64_t timeout_ns) {
  if (auto checked = settings.check(); !checked) return checked.error();
  if (settings.heat.named() && !link->traits().motors) {
    return Error{
        "This arm does not report its motor currents, so motor heat cannot be computed. Remove "
        "continuous_current from its file."};
  }
  std::unique_ptr<Device> device(new Device(std::move(link), settings));
  // The motors start from zero, even if another message was in flight before. An arm that sends
  // only when asked may miss the first message while it starts up, so zero is sent again with each
  // wait.
  constexpr int kGreetings = 10;
  constexpr int kAttempts = 100;  // reports that cannot be decoded, before giving up
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
    return Error{"The arm sends reports in an unknown format (" +
                 std::to_string(device->wire_.rejected) +
                 " rejected). Check that the arm file matches this arm."};
  }
  return Error{"The arm sent no report within " + std::to_string(timeout_ns / 1'000'000) +
               " ms. If it is real, check its power and cable, and close other programs that use "
               "it. If it is simulated, reduce delay_in and loss in its arm file."};
}

Result<void> Device::activate(HomeCheck home) {
  if (lost_) return Error{std::string(describe(Fault::kTransportLost))};
  if (home == HomeCheck::kPassed) home_needed_ = false;
  if (home_needed_) {
    return Error{
        "The arm was silent or its position jumped, so its board may have restarted and its "
        "encoders may count from another pose. Put the arm into its home pose, switch it off and "
        "on there, and restart."};
  }
  begin_activity();
  return {};
}

void Device::begin_activity() noexcept {
  gate_.restart();
  motion_.restart();
  if (enabling_ != nullptr) enabling_->restart();
  waiting_ = enabling_ != nullptr;
  forget_velocity();
  refused_in_a_row_ = 0;
  work_->restart();
  placed_ = programs_ = explained_ = false;
  active_ = true;
  insisted_ = false;
  // The next tick begins with dt = 0 like the first, but no tick number is repeated.
  if (started_) ++state_.tick;
  started_ = false;
}

// Without most of the settings, and without the parts of `motion_` after its state, which only
// faults and the start of a run read.
void Device::list_memory(std::vector<std::span<const std::byte>>& memory) const {
  const auto add = [&](const void* begin, const void* end) {
    memory.emplace_back(static_cast<const std::byte*>(begin), static_cast<const std::byte*>(end));
  };
  constexpr std::size_t kState = 128;  // Bytes of `motion_` that each tick uses [measured].
  add(this, &settings_);
  add(&gate_, reinterpret_cast<const std::byte*>(&motion_) + kState);
  add(&heat_, this + 1);
  add(work_.get(), work_.get() + 1);
  add(velocity_.get(), velocity_.get() + 1);
  if (own_velocity_ != nullptr) add(own_velocity_.get(), own_velocity_.get() + 1);
  add(walls_.get(), walls_.get() + 1);
}

void Device::close_lost_link() noexcept {
  delete retired_.exchange(nullptr, std::memory_order_acq_rel);
  delete offered_.exchange(nullptr, std::memory_order_acq_rel);
}

Result<void> Device::offer(std::unique_ptr<ArmLink> link) {
  if (link->traits() != traits_) {
    return Error{
        "The reconnected arm differs from the one that was disconnected (motors or capabilities). "
        "Plug in the same arm, or start a new run."};
  }
  close_lost_link();
  offered_.store(link.release(), std::memory_order_release);
  return {};
}

/// Passes the lost link to the thread that closes it, because its destructor may free memory and
/// wait. Returns whether the slot of the link is free.
bool Device::retire_link() noexcept {
  if (link_ == nullptr) return true;
  if (retired_.load(std::memory_order_acquire) != nullptr) return false;
  retired_.store(link_.release(), std::memory_order_release);
  return true;
}

void Device::take_offer(std::int64_t now_ns) noexcept {
  // If there is no room for the old link, the offer waits for a later tick.
  if (!retire_link()) return;
  ArmLink* const fresh = offered_.exchange(nullptr, std::memory_order_acq_rel);
  if (fresh == nullptr) return;
  link_.reset(fresh);
  ++wire_.replugged;
  lost_ = reported_ = active_ = silent_ = spoken_ = false;
  refused_in_a_row_ = missed_in_a_row_ = 0;
  last_report_ns_ = quiet_since_ns_ = now_ns;
  forget_velocity();
  require_home_pose();
  force_confirmed_ = insisted_ = false;  // nothing is known about this link
  send_zero();
}

void Device::take_request() noexcept {
  const Asked asked = activation_asked_.exchange(Asked::kNo, std::memory_order_acq_rel);
  if (asked == Asked::kNo || link_state() != LinkState::kConnected) return;
  if (asked == Asked::kAtHome) home_needed_ = false;
  if (!home_needed_) begin_activity();
}

void Device::deactivate() noexcept {
  active_ = false;
  send_zero();
  // A converter reports on the previous message, so the next one may succeed.
  if (!zero_taken()) send_zero();
}

bool Device::zero_assured() const noexcept {
  return zero_taken() && (link_ == nullptr || link_->settled() == LinkStatus::kOk);
}

bool Device::insist_on_zero(Clock& clock) noexcept {
  insisted_ = true;
  const std::int64_t begin_ns = clock.now_ns();
  // Counted, so that the loop ends with any clock.
  const std::int64_t tries = settings_.limits.watchdog_ns / kZeroAgain_ns + 1;
  for (std::int64_t i = 0; i < tries && !zero_assured() && !lost_; ++i) {
    if (clock.now_ns() - begin_ns > settings_.limits.watchdog_ns) break;
    clock.sleep_until_ns(clock.now_ns() + kZeroAgain_ns);
    // Wait for a zero force in flight; send it again if it failed in flight.
    if (zero_taken() && link_->settled() == LinkStatus::kNothing) continue;
    if (!zero_assured()) send_zero();
  }
  if (!zero_assured()) gate_.trip(Fault::kRefused);
  return zero_assured();
}

DeviceStage Device::stage() const noexcept {
  if (gate_.fault() != Fault::kNone) return DeviceStage::kFault;
  if (!active_) return DeviceStage::kIdle;
  return waiting_ ? DeviceStage::kWaiting : DeviceStage::kActive;
}

LinkState Device::link_state() const noexcept {
  if (lost_) return LinkState::kLost;
  return silent_ || !reported_ ? LinkState::kSilent : LinkState::kConnected;
}

const DeviceState& Device::read(std::int64_t now_ns, std::int64_t deadline_ns) noexcept {
  if (lost_) take_offer(now_ns);
  take_request();
  const bool first = !started_;
  if (!first) {
    // Otherwise forces would grow with the wrong sign, and a silence would go unnoticed.
    if (now_ns < state_.time_ns) gate_.trip(Fault::kTimeNotMonotonic);
    state_.dt = static_cast<double>(now_ns - state_.time_ns) * 1e-9;
    ++state_.tick;
  } else {
    started_ = true;
    state_.dt = 0;
    last_report_ns_ = quiet_since_ns_ = now_ns;
    missed_in_a_row_ = 0;
  }
  state_.time_ns = now_ns;
  state_.fresh = take_report(now_ns, deadline_ns);
  if (!state_.fresh) {
    ++wire_.missing;
  }
  if (first) walls_->begin_at(state_.p_WT);
  if (follow_silence(now_ns)) gate_.trip(Fault::kNoReports);
  return state_;
}

/// Returns whether the arm has been silent for too long while reads were made. Its counts are then
/// doubtful, unless the caller sent nothing: an arm that sends only when asked is silent because of
/// the caller.
bool Device::follow_silence(std::int64_t now_ns) noexcept {
  listened_ns_ = now_ns;
  if (state_.fresh) {
    quiet_since_ns_ = now_ns;
    missed_in_a_row_ = 0;
    silent_ = spoken_ = false;
    return false;
  }
  ++missed_in_a_row_;
  if (lost_ || now_ns - quiet_since_ns_ <= settings_.silence_limit_ns) return false;
  silent_ = true;
  if (spoken_) require_home_pose();
  return true;
}

const DeviceState& Device::idle(std::int64_t now_ns, std::int64_t deadline_ns) noexcept {
  if (started_) ++state_.tick;
  started_ = false;  // the next tick is the first one again
  if (now_ns - listened_ns_ > settings_.silence_limit_ns) {
    quiet_since_ns_ = now_ns;  // the caller made no reads
    missed_in_a_row_ = 0;
  }
  state_.time_ns = now_ns;
  state_.fresh = take_report(now_ns, deadline_ns);
  follow_silence(now_ns);
  send_zero();
  return state_;
}

bool Device::take_report(std::int64_t now_ns, std::int64_t deadline_ns) noexcept {
  if (lost_) return false;
  ArmSample& fresh = samples_[1 - newest_];
  const LinkRead read = link_->read(fresh, deadline_ns);
  wire_.skipped += read.skipped;
  if (read.status != LinkStatus::kOk) {
    if (read.status == LinkStatus::kLost) lose();
    if (read.status == LinkStatus::kRejected) ++wire_.rejected;
    if (read.status == LinkStatus::kRepeated) ++wire_.repeated;
    return false;
  }
  const double since_last = static_cast<double>(now_ns - last_report_ns_) * 1e-9;
  const Eigen::Vector3d p_WT = settings_.p_WB + settings_.R_WB * fresh.pose.p_BT;
  if (jumped(p_WT, since_last)) return false;
  if (moved_unseen(p_WT, now_ns)) {
    require_home_pose();
    if (active_) gate_.trip(Fault::kCountsJumped);
    forget_velocity();
  }
  ++wire_.reports;
  reported_ = true;
  newest_ = 1 - newest_;
  state_.counts = fresh.counts;
  state_.buttons = fresh.buttons;
  state_.q = fresh.pose.q;
  state_.p_WT = p_WT;
  state_.v_WT = velocity_->update(state_.p_WT, since_last);
  if (own_velocity_ != nullptr) v_own_W_ = own_velocity_->update(state_.p_WT, since_last);
  if (!(state_.p_WT.squaredNorm() < HUGE_VAL)) gate_.trip(Fault::kStateNotFinite);
  if (extras_) take_extras(fresh);
  last_report_ns_ = now_ns;
  return true;
}

void Device::take_extras(const ArmSample& sample) noexcept {
  if (!traits_.has_counts) {
    for (std::size_t i = 0; i < 3; ++i) {
      const double steps = sample.pose.p_BT[static_cast<Eigen::Index>(i)] / kPositionStep;
      // Written so that NaN counts as zero.
      state_.counts[i] =
          std::abs(steps) < INT32_MAX ? static_cast<std::int32_t>(std::lround(steps)) : 0;
    }
  }
  if (traits_.has_velocity) {
    // A law gets the velocity of the arm; the speed limit also applies to the gate's own estimate.
    if (active_ && !(v_gate_W().norm() <= settings_.limits.speed_max)) {
      gate_.trip(Fault::kOverSpeed);
    }
    state_.v_WT = settings_.R_WB * sample.v_BT;
  }
  if (traits_.has_orientation) {
    const TipQuaternion q_WT = quaternion_of(settings_.R_WB * sample.R_BT);
    if (q_WT == TipQuaternion{}) {
      gate_.trip(Fault::kStateNotFinite);
    } else {
      state_.q_WT = q_WT;
      state_.R_WT = rotation_of(q_WT);
    }
  }
  if (traits_.has_gimbal) {
    for (std::size_t i = 0; i < 3; ++i) {
      state_.gimbal[i] = static_cast<float>(sample.gimbal[static_cast<Eigen::Index>(i)]);
    }
  }
  if (traits_.has_gripper) state_.gripper = static_cast<float>(sample.gripper);
}

bool Device::jumped(const Eigen::Vector3d& p_WT, double since_last) noexcept {
  // 100 times gravity. Impacts of a hand-held tip on a surface stay below 10 times gravity (5 N on
  // 50 g).
  constexpr double kAcceleration = 1000;  // m/s^2
  // Reports come in frames of 1 ms; a late loop reads them at shorter intervals.
  constexpr double kTimeMin = 1e-3, kTimeMax = 5e-3;  // s
  const bool known = active_ && velocity_->primed() && !jumped_ && since_last < kTimeMax;
  const double time = since_last > kTimeMin ? since_last : kTimeMin;
  const Eigen::Vector3d off = p_WT - state_.p_WT - v_gate_W() * since_last;
  const double most = kAcceleration * time * time;
  jumped_ = known && off.squaredNorm() > most * most;
  if (jumped_) ++wire_.jumped;
  return jumped_;
}

bool Device::moved_unseen(const Eigen::Vector3d& p_WT, std::int64_t now_ns) const noexcept {
  const std::int64_t gap_ns = now_ns - last_report_ns_;
  const bool judged = traits_.zero_at_power_on && missed_in_a_row_ > 0 && velocity_->primed() &&
                      gap_ns <= settings_.silence_limit_ns;
  if (!judged) return false;
  const Eigen::Vector3d off =
      p_WT - state_.p_WT - v_gate_W() * (static_cast<double>(gap_ns) * 1e-9);
  return off.squaredNorm() > kUnseenStep * kUnseenStep;
}

/// Passes a command through the gate; `held`: energy that the walls store, J. Always inlined:
/// `write` calls it in every tick.
[[gnu::always_inline]] inline void Device::pass_on(const ForceCommand& command,
                                                   double held) noexcept {
  const bool guarded = guarded_;
  watch();
  if (!guarded && settings_.limits.power_max > 0) book_power();
  programs_ = programs_ || (command.f_program_W.array() != 0).any();
  const GatedForce force = programs_ ? pass_program(command, held)
                           : guarded ? pass_guarded(command, held)
                                     : gate_.pass(command.f_T_W, v_gate_W(), state_.dt);
  const LinkWrite sent = send(force);
  if (guarded || programs_) book(sent, force);
  if (sent.status != LinkStatus::kOk) {
    // The arm may have taken the force nevertheless.
    if (!force.f_T_W().isZero(0)) force_confirmed_ = false;
    return keep_previous_force();
  }
  f_sent_W_ = sent.scale * force.f_T_W();
  force_confirmed_ = true;
}

void Device::write(const ForceCommand& command) noexcept {
  if (guarded_ && heat_.named()) heat_.advance(state_.dt);
  if (!active_ || lost_) return send_zero();
  if (enabling_ != nullptr && wait_for_hold()) return;
  if (partial_) return write_along_axes(command);
  if (walls_->hold(state_.p_WT)) return pass_on(command, 0);
  stop_at_walls(command);
}

/// Returns the part of a force that the motors can exert, and counts the rest.
Eigen::Vector3d Device::along_axes(const Eigen::Vector3d& f_W) noexcept {
  constexpr double kNegligible = 1e-9;  // N; far above rounding errors [chosen]
  const Eigen::Vector3d given = along_axes_W_ * f_W;
  const Eigen::Vector3d missing = f_W - given;
  const double squared = missing.squaredNorm();
  if (squared > kNegligible * kNegligible) {
    ++missing_force_.ticks;
    missing_force_.f_W = missing;
    if (squared > missing_force_.f_strongest_W.squaredNorm()) {
      missing_force_.f_strongest_W = missing;
    }
  }
  return given;
}

/// Writes the part of a force that the motors of an arm with one or two motors can exert. The gate
/// and its stages then see the force that acts.
void Device::write_along_axes(const ForceCommand& command) noexcept {
  ForceCommand given = command;
  given.f_T_W = along_axes(command.f_T_W);
  given.f_program_W = along_axes_W_ * command.f_program_W;
  if (walls_->hold(state_.p_WT)) return pass_on(given, 0);
  stop_at_walls(given);
}

void Device::hold_until(std::int64_t time_ns) noexcept {
  if (enabling_ != nullptr) enabling_->hold_until(time_ns);
}

/// Returns whether the enabling input is open; if so, sends zero force.
bool Device::wait_for_hold() noexcept {
  const bool waited = waiting_;
  waiting_ = !enabling_->held(state_);
  if (!waiting_) {
    if (waited) work_->restart();
    return false;
  }
  gate_.close();
  send_zero();
  return true;
}

void Device::stop_at_walls(const ForceCommand& command) noexcept {
  // Written so that NaN is outside.
  if (!(walls_->depth(state_.p_WT).norm() <= walls_->settings().beyond)) {
    gate_.trip(Fault::kOutsideWorkspace);
  }
  ForceCommand stopped = walls_->stop(command, state_.p_WT, v_gate_W());
  if (partial_) stopped.f_T_W = along_axes_W_ * stopped.f_T_W;
  wall_counters_.f_W = stopped.f_T_W - command.f_T_W;
  ++wall_counters_.pushed;
  if (wall_counters_.f_W.squaredNorm() > wall_counters_.f_strongest_W.squaredNorm()) {
    wall_counters_.f_strongest_W = wall_counters_.f_W;
  }
  stopped.f_program_W.setZero();  // the part that remains of it is unknown, so the gate fades it
  pass_on(stopped, walls_->held(state_.p_WT));
}

/// Accounts the power if no stage keeps an account of work.
void Device::book_power() noexcept {
  if (placed_) gate_.book_power(f_sent_W_.dot(state_.p_WT - p_power_WT_), state_.dt);
  p_power_WT_ = state_.p_WT;
  placed_ = true;
}

/// Passes a force that includes a program's part, which is reduced if it oscillates.
GatedForce Device::pass_program(const ForceCommand& command, double held) noexcept {
  const double share = gate_.program_share(command.f_program_W, state_.p_WT, state_.dt);
  ForceCommand kept = command;
  if (share < 1) {
    kept.f_program_W *= share;
    kept.f_T_W -= command.f_program_W - kept.f_program_W;
  }
  return pass_guarded(kept, held);
}

void Device::forget_velocity() noexcept {
  velocity_->reset();
  if (own_velocity_ != nullptr) own_velocity_->reset();
}

void Device::watch() noexcept {
  if (!motion_.take(state_, f_sent_W_)) return;
  const Fault fault =
      motion_.judge(state_, settings_.R_WB, sample().pose.J_BT, link_->numbers_reports());
  if (fault != Fault::kNone) gate_.trip(fault);
}

void Device::send_zero() noexcept {
  if (lost_ || send(GatedForce()).status != LinkStatus::kOk) return keep_previous_force();
  f_sent_W_.setZero();
  if (heat_.named()) heat_.sent({}, false);
  force_confirmed_ = true;
  insisted_ = false;
}

void Device::keep_previous_force() noexcept {
  if (lost_ && !f_sent_W_.isZero(0)) {
    // A lost arm is stopped by its own watchdog and gets no more messages.
    f_sent_W_.setZero();
    force_confirmed_ = false;
    if (heat_.named()) heat_.sent({}, false);
  }
  gate_.resume_from(f_sent_W_);
}

GatedForce Device::pass_guarded(const ForceCommand& command, double held) noexcept {
  const ArmPose& pose = sample().pose;
  // Energy of a linear spring; a force cut by the gate stores no more than this.
  held += 0.5 * command.f_T_W.norm() * command.touch.depth;
  EnergyFlow flow = work_->flow(traits_.motors ? pose.q : pose.p_BT, state_.p_WT, f_sent_W_, held);
  gate_.book_power(flow.work, state_.dt);
  explained_ = explained_ || programs_ || command.stored != 0;
  if (explained_) {
    work_->explain(flow, command.stored, command.f_program_W, settings_.energy.dissipation,
                   state_.dt);
  }
  if (heat_.named()) link_->limit_currents(heat_.drives());
  return gate_.pass_guarded(command.f_T_W, v_gate_W(), state_.dt, flow);
}

void Device::book(const LinkWrite& sent, const GatedForce& force) noexcept {
  if (sent.status != LinkStatus::kOk) return work_->hold();
  if (programs_) work_->program_sent(sent.scale * gate_.f_program_W());
  if (!traits_.motors) {
    return work_->sent(settings_.R_WB.transpose() * (sent.scale * force.f_T_W()));
  }
  const std::array<std::int16_t, 3> mA = whole_mA(link_->currents());
  work_->sent(torque_of(mA, *traits_.motors));
  if (heat_.named()) heat_.sent(mA, sent.scale < 1);
}

LinkWrite Device::send(const GatedForce& force) noexcept {
  spoken_ = true;
  const LinkWrite sent = link_->write(force, sample(), settings_.R_WB);
  if (sent.status == LinkStatus::kOk) {
    refused_in_a_row_ = 0;
  } else {
    count_refusal(sent.status);
  }
  return sent;
}

void Device::count_refusal(LinkStatus status) noexcept {
  if (status == LinkStatus::kLost) {
    refused_in_a_row_ = 0;
    return lose();
  }
  ++wire_.refused;
  if (refused_in_a_row_++ == 0) refused_since_ns_ = state_.time_ns;
  if (state_.time_ns - refused_since_ns_ > settings_.silence_limit_ns) gate_.trip(Fault::kRefused);
}

void Device::lose() noexcept {
  lost_ = true;
  gate_.trip(Fault::kTransportLost);
  // A message that has not left yet never will.
  if (link_ != nullptr && link_->settled() != LinkStatus::kOk) force_confirmed_ = false;
  retire_link();
}

}  // namespace thimble::driver
