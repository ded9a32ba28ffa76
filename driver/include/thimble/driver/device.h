#pragma once

#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "thimble/driver/arm_link.h"
#include "thimble/driver/clock.h"
#include "thimble/driver/device_state.h"
#include "thimble/driver/export.h"
#include "thimble/driver/force_law.h"
#include "thimble/driver/heat_guard.h"
#include "thimble/driver/motion_watch.h"
#include "thimble/driver/result.h"
#include "thimble/driver/safety_gate.h"
#include "thimble/driver/tick_record.h"

namespace thimble::driver {

class EnablingInput;
class VelocityEstimator;
class WorkAccount;
class WorkspaceWalls;

/// Settings of the virtual walls around the workspace of an arm: a box aligned with the world axes.
/// No walls by default.
struct WallSettings {
  /// Default stiffness K, N/m [chosen: a latency L of 3 ms acts like a negative damper of K L = 0.6
  /// N s/m (PHYSICS 1.1). This is less than the mean of the damping, 1.5 N s/m].
  static constexpr double kStiffness = 200;
  /// Default damping while the tip moves outwards, N s/m [chosen: an eighth of m / (T (1 + 2 d)),
  /// for a mass m of 75 g, a period T of 1 ms and a delay d of one tick].
  static constexpr double kDamping = 3;
  /// Distance from the box of the arm file to the wall, m [chosen: objects at the edge of the box
  /// are felt without the wall. The boxes end 20 mm or more inside the reach of their arms].
  static constexpr double kMargin = 0.01;
  /// Default depth behind the wall at which the force is switched off, m [chosen: the spring then
  /// exerts 6 N, more than most arms here can exert].
  static constexpr double kBeyond = 0.03;

  Eigen::Vector3d min_W = Eigen::Vector3d::Constant(-HUGE_VAL);  ///< Minimum corner, m.
  Eigen::Vector3d max_W = Eigen::Vector3d::Constant(HUGE_VAL);   ///< Maximum corner, m.
  double stiffness = kStiffness;                                 ///< Stiffness, N/m.
  /// Damping while the tip moves outwards, N s/m.
  double damping = kDamping;
  /// Depth behind a wall at which the force is switched off, m.
  double beyond = kBeyond;
};

/// Counters of the workspace walls. The force of the walls is their contribution to the requested
/// force. On each axis on which the tip is outside the box, it points towards the box.
struct WallCounters {
  std::uint64_t pushed = 0;                ///< Number of ticks in which a wall pushed.
  Eigen::Vector3d f_W{0, 0, 0};            ///< Force of the walls in the last of these ticks, N.
  Eigen::Vector3d f_strongest_W{0, 0, 0};  ///< Largest force of the walls, N.
};

/// Force that an arm with one or two motors could not give: the part across the line or plane of
/// its tip, of the forces of laws and walls. Zero for other arms.
struct MissingForce {
  std::uint64_t ticks = 0;                 ///< Number of ticks with such a part.
  Eigen::Vector3d f_W{0, 0, 0};            ///< The part in the last of these ticks, N.
  Eigen::Vector3d f_strongest_W{0, 0, 0};  ///< The largest part, N.
};

/// Enabling inputs. An arm gets a force only while a person holds all inputs that are set. By
/// default none is set.
struct HoldToRun {
  /// Mask of arm buttons, one bit each. At least one of them must be held; 0: no button.
  std::uint16_t buttons = 0;
  bool by_caller = false;  ///< True if the caller monitors an input (Device::hold_until).

  /// Returns whether an enabling input is set. Real-time: safe.
  bool named() const noexcept { return buttons != 0 || by_caller; }
};

/// Settings of a device: pose of the arm's base, limits and monitoring.
struct THIMBLE_EXPORT DeviceSettings {
  Eigen::Matrix3d R_WB = Eigen::Matrix3d::Identity();  ///< Rotation of the arm's base in the world.
  /// Position of the arm's base in the world, m.
  Eigen::Vector3d p_WB{0, 0, 0};
  GateLimits limits;  ///< Limits of force, rise and speed.
  /// Energy stage of the gate; kNone: no stage.
  EnergyGuardSettings energy{};
  MotionWatchSettings motion{};  ///< Settings of the motion watch.
  HeatSettings heat{};           ///< Thermal limits of the motors, if known.
  /// Corner frequency of the low-pass filter of the velocity, Hz; 0: no filter.
  double velocity_corner_frequency = 0;
  /// Time without a report after which a fault occurs, ns [chosen: 20 reports of a full-speed USB
  /// arm].
  std::int64_t silence_limit_ns = 20'000'000;
  WallSettings walls{};  ///< Walls around the workspace; by default none.
  HoldToRun hold{};      ///< Enabling inputs; by default none.
  /// True if no real motor is behind the link, for a study or a test with a simulated arm. Then
  /// `limits` may be too wide to protect a person.
  bool no_motors = false;

  /// Checks the settings. Fails if a limit is not a positive finite number or is too loose to
  /// protect a person (GateLimits). Also fails if `R_WB` is not a rotation or `p_WB` is not a valid
  /// position. Real-time: never from the servo thread.
  Result<void> check() const;
};

/// Counters of messages on the link.
struct WireCounters {
  std::uint64_t reports = 0;    ///< Number of reports decoded.
  std::uint64_t rejected = 0;   ///< Number of reports with an unknown length or content.
  std::uint64_t skipped = 0;    ///< Number of reports dropped because a newer one was available.
  std::uint64_t missing = 0;    ///< Number of ticks without a new report.
  std::uint64_t refused = 0;    ///< Number of messages that the arm did not accept.
  std::uint64_t repeated = 0;   ///< Number of repeated reports, if the arm numbers them.
  std::uint64_t jumped = 0;     ///< Number of reports dropped because of a jump that no hand makes.
  std::uint64_t replugged = 0;  ///< Number of times that a lost link was replaced.
};

/// Home-pose check that a caller has made before it requests forces.
enum class HomeCheck : std::uint8_t {
  kNone,  ///< No check. Sufficient while `Device::home_needed` is false.
  /// The caller has seen the arm in its home pose, or knows that its counts did not restart.
  kPassed,
};

/// Open arm and its link. A device is idle until `activate`, and active until `deactivate`. After a
/// fault it stays in the stage kFault until `activate` is called again (DeviceStage). A clock that
/// steps back is a fault.
///
/// `deactivate`, a fault and the destructor send zero force. Only one thread at a time may use a
/// device. The exceptions are `offer`, `close_lost_link`, `ask_to_activate` and `hold_until`.
///
/// If several faults occur, `fault` returns the first. The state of the link (`link_state`) is
/// independent of it: an arm can be disconnected because of, or after, any other fault.
///
/// After a disconnection the loop continues with zero force. Another thread finds the reconnected
/// arm by its serial number, closes the lost link (`close_lost_link`), opens a new one and offers
/// it. The next tick takes the offer and reads positions again. Forces return only when the user
/// requests them (`ask_to_activate`).
///
/// The encoders of some arms count from the pose that the arm had when its board started
/// (ArmTraits::zero_at_power_on). Their counts are wrong after every restart of the board, with or
/// without a disconnection. After a new link, a silence, or a position jump without a report, the
/// board may have restarted. Such an arm then gets no force before it returns to its home pose
/// (`home_needed`).
class THIMBLE_EXPORT Device {
 public:
  /// Opens a device on the link to an arm. Waits for the first report until `timeout_ns` after
  /// `clock_now_ns`, on the clock of the link's deadlines. Meanwhile it sends zero force, because
  /// some arms report only in response to a message. Fails if no report arrives or none is valid,
  /// or if the settings are invalid (`DeviceSettings::check`). Also fails if heat limits are set
  /// but the link does not report its motors (ArmTraits::motors). Real-time: never from the servo
  /// thread.
  static Result<std::unique_ptr<Device>> open(std::unique_ptr<ArmLink> link,
                                              const DeviceSettings& settings,
                                              std::int64_t clock_now_ns,
                                              std::int64_t timeout_ns = 1'000'000'000);

  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  /// Sends zero force, then closes the link. If the arm did not accept zero force, a force may
  /// still act. The destructor then first calls `insist_on_zero` on the wall clock, unless the
  /// caller has done so.
  ~Device();

  /// Enables forces from the next tick on, with a soft start, and clears a fault. Fails if the link
  /// is lost, or if the home pose is required and `home` is kNone. Real-time: never from the servo
  /// thread.
  Result<void> activate(HomeCheck home = HomeCheck::kNone);

  /// Sends zero force now (once more if the arm does not accept it) and in every later tick.
  /// `zero_assured` returns whether it was accepted. Real-time: safe.
  void deactivate() noexcept;

  /// Sends zero force every millisecond of `clock`, until the arm accepts it or the link is lost.
  /// Stops after `GateLimits::watchdog_ns`, when the arm's own watchdog must have switched the
  /// motors off. Returns whether zero force was accepted; if not, the fault is kRefused. For use at
  /// the end of a loop. Real-time: safe; waits, and a write may wait as well.
  bool insist_on_zero(Clock& clock) noexcept;

  /// Returns whether the acting force is known to be zero. This requires that the last message was
  /// zero force and has left this computer (ArmLink::settled). It also requires that no message
  /// with a force has failed since. Otherwise a force may act until the arm's own watchdog switches
  /// the motors off. Call from the thread that uses the device. Real-time: safe.
  bool zero_assured() const noexcept;

  /// Starts a tick: reads the newest report and computes the tip's position and velocity. Drops a
  /// report that implies a change of tip speed of more than 1 m/s within 1 ms. A hand cannot cause
  /// such a change, but a disturbed encoder line can. A second such report in a row is accepted.
  /// Without a new report, returns the last state with `fresh` false. After `silence_limit_ns`
  /// without a report, latches a fault. Real-time: safe; waits no longer than `deadline_ns`.
  const DeviceState& read(std::int64_t now_ns, std::int64_t deadline_ns) noexcept;

  /// Reads the newest report as `read` does and sends zero force, for a caller that checks the arm
  /// before a run. The call does not count as a tick. A silence is not a fault, but may make the
  /// home pose required (`home_needed`). Real-time: safe.
  const DeviceState& idle(std::int64_t now_ns, std::int64_t deadline_ns) noexcept;

  /// Ends a tick: passes the command through the gate and sends the result, or zero force if the
  /// device is not active. If the arm does not accept the message, the previous force still acts.
  /// The rise limit of the next force then starts from it. Real-time: safe.
  void write(const ForceCommand& command) noexcept;

  /// Latches a fault that the caller has detected; the force is switched off. Real-time: safe.
  void trip(Fault fault) noexcept { gate_.trip(fault); }

  /// Closes the lost link and any offer that was not taken. Call it before opening a new link to
  /// the same arm. A vendor library can share one arm between all links, so that closing the old
  /// link later would close the new one. Call from the thread that calls `offer`. Real-time: never
  /// from the servo thread.
  void close_lost_link() noexcept;

  /// Offers a new link to the same arm as a replacement for a lost one. Closes the lost one first,
  /// as `close_lost_link` does. The next `read` takes the offer if the link is lost. Fails, and
  /// closes the new link, if the arm differs (`ArmTraits`). Call from one thread other than the
  /// loop's. Real-time: never from the servo thread.
  Result<void> offer(std::unique_ptr<ArmLink> link);

  /// Requests the next `read` to activate the device. The request is dropped if the link is not
  /// connected, or if the home pose is required and `home` is kNone. From any thread. Real-time:
  /// safe.
  void ask_to_activate(HomeCheck home = HomeCheck::kNone) noexcept {
    activation_asked_.store(home == HomeCheck::kPassed ? Asked::kAtHome : Asked::kYes,
                            std::memory_order_release);
  }

  /// Marks the enabling input of the caller (HoldToRun::by_caller) as held until `time_ns` on the
  /// loop's clock. The caller repeats the call while the input is held. From any thread. Real-time:
  /// safe.
  void hold_until(std::int64_t time_ns) noexcept;

  /// Latches Fault::kSuspended after the computer was suspended (Clock::asleep_ns). No force is
  /// sent until the device is activated again. If the encoders count from zero at power-on, the
  /// home pose becomes required, because the board may have lost power. Real-time: safe.
  void wake_from_sleep() noexcept {
    gate_.trip(Fault::kSuspended);
    require_home_pose();
  }

  /// Clears `home_needed`: the caller has seen the arm in its home pose. Real-time: safe.
  void confirm_home() noexcept { home_needed_ = false; }

  DeviceStage stage() const noexcept;  ///< Returns the stage of the device. Real-time: safe.
  /// Returns whether the link is lost and a new one can be offered. Real-time: safe.
  bool lost() const noexcept { return lost_; }
  /// Returns the state of the link, independent of the fault. Real-time: safe.
  LinkState link_state() const noexcept;
  /// Returns whether the arm must be seen in its home pose before it gets a force, because its
  /// board may have restarted and its counts may be wrong. Always false for an arm with absolute
  /// encoders, one that finds its own zero, or one whose pose its vendor reports. Real-time: safe.
  bool home_needed() const noexcept { return home_needed_; }
  /// Returns the latched fault, the first if several occurred; kNone without a fault. Real-time:
  /// safe.
  Fault fault() const noexcept { return gate_.fault(); }
  /// Returns the last state read. Real-time: safe.
  const DeviceState& state() const noexcept { return state_; }
  /// Returns the acting force, N in the world. It is the force of the last message that the arm
  /// accepted, or zero once the link is lost. Real-time: safe.
  const Eigen::Vector3d& f_sent_W() const noexcept { return f_sent_W_; }
  /// Returns the counters of messages on the link. Real-time: safe.
  const WireCounters& wire_counters() const noexcept { return wire_; }
  /// Returns the counters of the gate. Real-time: safe.
  const GateCounters& gate_counters() const noexcept { return gate_.counters(); }
  /// Returns the counters of the workspace walls. Real-time: safe.
  const WallCounters& wall_counters() const noexcept { return wall_counters_; }
  /// Returns the force that the arm could not give. Real-time: safe.
  const MissingForce& missing_force() const noexcept { return missing_force_; }
  const SafetyGate& gate() const noexcept { return gate_; }  ///< Returns the gate. Real-time: safe.
  /// Returns the settings of the device. Real-time: safe.
  const DeviceSettings& settings() const noexcept { return settings_; }
  /// Returns the thermal model of the motors. Real-time: safe.
  const HeatGuard& heat() const noexcept { return heat_; }
  /// Returns the capabilities of the arm. Real-time: safe.
  const ArmTraits& traits() const noexcept { return traits_; }

  /// Appends the memory that `read` and `write` use in each tick, without that of the link, so that
  /// a caller with many devices can prefetch it. Real-time: never from the servo thread.
  void list_memory(std::vector<std::span<const std::byte>>& memory) const;

 private:
  Device(std::unique_ptr<ArmLink> link, const DeviceSettings& settings) noexcept;
  bool take_report(std::int64_t now_ns, std::int64_t deadline_ns) noexcept;
  void take_extras(const ArmSample& sample) noexcept;
  bool jumped(const Eigen::Vector3d& p_WT, double since_last) noexcept;
  bool moved_unseen(const Eigen::Vector3d& p_WT, std::int64_t now_ns) const noexcept;
  bool follow_silence(std::int64_t now_ns) noexcept;
  void require_home_pose() noexcept { home_needed_ = home_needed_ || traits_.zero_at_power_on; }
  void take_offer(std::int64_t now_ns) noexcept;
  void take_request() noexcept;
  bool retire_link() noexcept;
  void begin_activity() noexcept;
  LinkWrite send(const GatedForce& force) noexcept;
  void send_zero() noexcept;
  void count_refusal(LinkStatus status) noexcept;
  void keep_previous_force() noexcept;
  bool zero_taken() const noexcept { return force_confirmed_ && f_sent_W_.isZero(0); }
  void lose() noexcept;
  void watch() noexcept;
  bool wait_for_hold() noexcept;
  void stop_at_walls(const ForceCommand& command) noexcept;
  void write_along_axes(const ForceCommand& command) noexcept;
  Eigen::Vector3d along_axes(const Eigen::Vector3d& f_W) noexcept;
  void pass_on(const ForceCommand& command, double held) noexcept;
  void forget_velocity() noexcept;
  /// Returns the velocity used by the gate, m/s. It does not depend on a slow filter that a law
  /// requests for the velocity in `state`.
  const Eigen::Vector3d& v_gate_W() const noexcept {
    return own_velocity_ != nullptr ? v_own_W_ : state_.v_WT;
  }
  void book_power() noexcept;
  GatedForce pass_program(const ForceCommand& command, double held) noexcept;
  GatedForce pass_guarded(const ForceCommand& command, double held) noexcept;
  void book(const LinkWrite& sent, const GatedForce& force) noexcept;
  const ArmSample& sample() const noexcept { return samples_[newest_]; }

  /// Requested activation.
  enum class Asked : std::uint8_t { kNo, kYes, kAtHome };

  std::unique_ptr<ArmLink> link_;  // Null after the lost link was retired, until a new one.
  ArmTraits traits_;
  DeviceSettings settings_;
  SafetyGate gate_;
  MotionWatch motion_;
  HeatGuard heat_;
  std::unique_ptr<WorkAccount> work_;  // For the energy stage.
  // Position of the tip when the power was last integrated, and whether it is known.
  Eigen::Vector3d p_power_WT_{0, 0, 0};
  bool placed_ = false;
  // Since activation: true if a program requested a force; true if that happened or a law declared
  // stored energy.
  bool programs_ = false;
  bool explained_ = false;

  std::unique_ptr<VelocityEstimator> velocity_;
  // Used if `velocity_` is slower than the gate allows.
  std::unique_ptr<VelocityEstimator> own_velocity_;
  Eigen::Vector3d v_own_W_{0, 0, 0};  // From `own_velocity_`, m/s.
  std::unique_ptr<WorkspaceWalls> walls_;
  WallCounters wall_counters_;
  std::unique_ptr<EnablingInput> enabling_;  // Null: no enabling input.
  WireCounters wire_;
  // One holds the accepted sample, the other receives the next report.
  std::array<ArmSample, 2> samples_;
  std::size_t newest_ = 0;
  DeviceState state_;
  Eigen::Vector3d f_sent_W_{0, 0, 0};
  std::int64_t last_report_ns_ = 0;
  std::int64_t quiet_since_ns_ = 0;  // Last report, or the start of listening.
  std::int64_t listened_ns_ = 0;     // Last call of `read` or `idle`.
  bool guarded_;                     // True with an energy stage or a heat guard.
  bool partial_;                     // True if the arm has fewer than three motors.
  // True if the samples have other members than joints and counts.
  bool extras_;
  bool active_ = false;
  bool waiting_ = false;  // True while waiting for the enabling input.
  bool started_ = false;  // True if a tick has been read.
  bool lost_ = false;
  bool jumped_ = false;    // True if the newest report was dropped for a jump.
  bool reported_ = false;  // True if a report arrived over this link.
  // True if f_sent_W_ is the last force that the arm accepted over this link.
  bool force_confirmed_ = false;
  bool silent_ = false;  // True after the silence limit, until a report arrives.
  bool spoken_ = false;  // True if a message was sent or refused since the last report.
  bool home_needed_ = false;
  // True if `insist_on_zero` was called for a zero force that was not accepted.
  bool insisted_ = false;
  int refused_in_a_row_ = 0;
  int missed_in_a_row_ = 0;  // Number of reads without a report while listening.
  std::int64_t refused_since_ns_ = 0;
  MissingForce missing_force_;
  Eigen::Matrix3d along_axes_W_;  // Projects a force to the axes of the tip (ArmTraits::axes).
  std::atomic<ArmLink*> offered_{nullptr}, retired_{nullptr};
  std::atomic<Asked> activation_asked_{Asked::kNo};
};

}  // namespace thimble::driver
