#pragma once

#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>

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

/// Sets the virtual walls around the workspace of an arm: a box along the axes of the world. None
/// by default.
struct WallSettings {
  /// Stiffness, N/m [chosen: a latency of 3 ms gives it the strength of a negative damper of
  /// 0.6 N s/m (K L, PHYSICS 1.1), less than the 1.5 N s/m that the damping takes on average].
  static constexpr double kStiffness = 200;
  /// Damping on the way out, N s/m [chosen: an eighth of m / T (1 + 2 d) for 75 g at 1 kHz and a
  /// delay of a tick].
  static constexpr double kDamping = 3;
  /// Distance between the box of the arm file and the wall, m [chosen: what is touched at the edge
  /// of the box is felt without the wall; the boxes lie 20 mm and more inside of the reach].
  static constexpr double kMargin = 0.01;
  /// Depth behind the wall at which the force goes off, m [chosen: 6 N of the spring, more than
  /// most arms here push].
  static constexpr double kBeyond = 0.03;

  Eigen::Vector3d min_W = Eigen::Vector3d::Constant(-HUGE_VAL);  ///< Lowest corner, m.
  Eigen::Vector3d max_W = Eigen::Vector3d::Constant(HUGE_VAL);   ///< Highest corner, m.
  double stiffness = kStiffness;                                 ///< N/m
  double damping = kDamping;                                     ///< On the way out, N s/m.
  double beyond = kBeyond;  ///< Depth behind a wall at which the force goes off, m.
};

/// Counts what the walls around a workspace did. The force of a wall is what it adds to the force
/// that was asked for, so that on each axis its sign is opposite to the side of the box at which
/// the tip is outside.
struct WallCounters {
  std::uint64_t pushed = 0;                ///< Ticks in which a wall pushed.
  Eigen::Vector3d f_W{0, 0, 0};            ///< Force of the walls in the last of them, N.
  Eigen::Vector3d f_strongest_W{0, 0, 0};  ///< Strongest force of the walls, N.
};

/// Sets an enabling input: what a person must hold so that an arm gets a force. Of several all must
/// be held. None by default.
struct HoldToRun {
  std::uint16_t buttons = 0;  ///< Of the arm, one bit each, of which one must be held; 0: none.
  bool by_caller = false;     ///< An input that the caller watches (Device::hold_until).

  /// Returns whether there is an enabling input. Real-time: safe.
  bool named() const noexcept { return buttons != 0 || by_caller; }
};

/// Sets how a device is placed and what it tolerates.
struct THIMBLE_EXPORT DeviceSettings {
  Eigen::Matrix3d R_WB = Eigen::Matrix3d::Identity();  ///< Rotation of the arm's base in the world.
  Eigen::Vector3d p_WB{0, 0, 0};                       ///< Position of the arm's base, m.
  GateLimits limits;                                   ///< Of force, rise and speed.
  EnergyGuardSettings energy{};                ///< Which energy stage the gate has; none: free.
  MotionWatchSettings motion{};                ///< What motors and encoders are watched by.
  HeatSettings heat{};                         ///< Of the motors; none: not known.
  double velocity_corner_frequency = 0;        ///< Pole of the velocity estimate, Hz; 0: none.
  std::int64_t silence_limit_ns = 20'000'000;  ///< Silence of the arm that is a fault, ns (20
                                               ///< reports of a full-speed USB arm; chosen).
  WallSettings walls{};                        ///< Around the workspace; none: no end.
  HoldToRun hold{};                            ///< What must be held for a force; none: nothing.
  /// No motor turns behind the link: a study or a test that simulates the arm. Then `limits` may be
  /// so wide that nothing is felt of them.
  bool no_motors = false;

  /// Fails if a limit is not a positive finite number or protects nobody (GateLimits), and if the
  /// base is not placed by a rotation and a position. Real-time: never from the servo thread.
  Result<void> check() const;
};

/// Counts what arrived over the link.
struct WireCounters {
  std::uint64_t reports = 0;    ///< Reports decoded.
  std::uint64_t rejected = 0;   ///< Reports of a length or content the protocol does not know.
  std::uint64_t skipped = 0;    ///< Reports dropped because a newer one was there.
  std::uint64_t missing = 0;    ///< Ticks without a new report.
  std::uint64_t refused = 0;    ///< Messages that the arm did not take.
  std::uint64_t repeated = 0;   ///< Reports that came before, of an arm that numbers them.
  std::uint64_t jumped = 0;     ///< Reports dropped for a jump that no hand makes.
  std::uint64_t replugged = 0;  ///< Times a lost wire was replaced.
};

/// What the caller knows of the arm's pose when it asks for forces.
enum class HomeCheck : std::uint8_t {
  kNone,    ///< Nothing. Enough as long as `Device::home_needed` is false.
  kPassed,  ///< It has seen the arm in its home pose, or the arm's counts cannot have restarted.
};

/// One open arm behind its link: idle -> active -> (fault ->) idle, until destroyed.
///
/// Every way out sends zero force: `deactivate`, a fault, the destructor. A fault latches until
/// `activate` is called again; a clock that steps back is one. Used by one thread at a time, but
/// for `offer`, `close_lost_link` and `ask_to_activate`.
///
/// The fault is the first reason why the force is off. The state of the link (`link_state`) is a
/// value of its own: an arm can be pulled because of, or after, any other fault.
///
/// An arm that was pulled and plugged in again: the loop continues with zero force; another thread
/// finds the arm by its serial number, closes the lost link (`close_lost_link`), opens a new one
/// and offers it; the next tick takes it and reads positions again. Forces come back only when the
/// user asks for them (`ask_to_activate`).
///
/// Encoders that count from where the arm stood when its board started
/// (ArmTraits::zero_at_power_on) are wrong after every restart of the board, with a wire that was
/// pulled or without. After a new link, a silence, or a jump of the position while no report came,
/// forces therefore need the home pose again (`home_needed`).
class THIMBLE_EXPORT Device {
 public:
  /// Takes the link to an arm; waits up to `timeout_ns` of `clock_now_ns` time for the first report
  /// by way of the link's deadline, and sends zero force meanwhile, because some arms speak only
  /// when spoken to. Fails if none arrives or none can be understood, if the settings are wrong
  /// (`DeviceSettings::check`), or if they name the heat of motors that the link keeps to itself.
  /// Real-time: never from the servo thread.
  static Result<std::unique_ptr<Device>> open(std::unique_ptr<ArmLink> link,
                                              const DeviceSettings& settings,
                                              std::int64_t clock_now_ns,
                                              std::int64_t timeout_ns = 1'000'000'000);

  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  /// Sends zero force, then closes the link. Where a force stands and the arm does not take the
  /// zero, it insists in real time as `insist_on_zero` does, unless that has been done.
  ~Device();

  /// Lets forces through from the next tick on, with a soft start; clears a fault. Fails if the
  /// link is lost, or if the home pose is needed first and `home` does not say that the arm was
  /// seen there. Real-time: never from the servo thread.
  Result<void> activate(HomeCheck home = HomeCheck::kNone);

  /// Sends zero force now, once more if the arm does not take it, and in every later tick.
  /// `zero_assured` says whether it was taken. Real-time: safe.
  void deactivate() noexcept;

  /// Sends zero force again, each millisecond of `clock`, until the arm takes it or the link is
  /// lost: for as long as the arm's own watchdog waits (`GateLimits::watchdog_ns`), after which the
  /// arm must have switched itself off. Returns whether it was taken; if not, that is the fault
  /// kRefused. For the end of a loop. Real-time: safe; waits, and a write may wait as well.
  bool insist_on_zero(Clock& clock) noexcept;

  /// Returns whether the force that stands is known to be zero: the last message said so, no
  /// message with a force has failed since, and the last message has left this computer
  /// (ArmLink::settled). False: a force may stand until the arm's own watchdog switches it off.
  /// From the thread that uses the device. Real-time: safe.
  bool zero_assured() const noexcept;

  /// Begins a tick: reads the newest report and finds where the tip is. A report after which the
  /// tip would have changed its speed by 1 m/s within 1 ms is dropped, once: no hand does that, but
  /// a disturbed encoder line does; the second in a row is believed. With no new report the last
  /// state stands (`fresh` is false); after `silence_limit_ns` of that it is a fault. Real-time:
  /// safe; waits no longer than `deadline_ns`.
  const DeviceState& read(std::int64_t now_ns, std::int64_t deadline_ns) noexcept;

  /// Reads the newest report as `read` does and sends zero force: for a caller that looks at the
  /// arm before a run. It counts no tick, and a silence is no fault, but may make the home pose
  /// needed. Real-time: safe.
  const DeviceState& idle(std::int64_t now_ns, std::int64_t deadline_ns) noexcept;

  /// Ends a tick: passes the command through the gate and sends what is left of it, or zero if the
  /// device is not active. What the arm does not take leaves the force before it standing, and the
  /// next one rises from that. Real-time: safe.
  void write(const ForceCommand& command) noexcept;

  /// Makes a fault that somebody above found (it latches, the force goes off). Real-time: safe.
  void trip(Fault fault) noexcept { gate_.trip(fault); }

  /// Closes the lost link, and an offer that was not taken. Call it before a new link to the same
  /// arm is opened: a vendor's library has one arm for all links, so that the end of an old link
  /// would close the new one. From the thread that offers. Real-time: never from the servo thread.
  void close_lost_link() noexcept;

  /// Offers a new link to the same arm as a replacement for a lost one; closes the lost one first,
  /// as `close_lost_link` does. The next `read` takes the offer if the link is lost. Fails, and
  /// drops the link, if it is to an arm of another kind (`ArmTraits`). From one thread other than
  /// the loop's. Real-time: never from the servo thread.
  Result<void> offer(std::unique_ptr<ArmLink> link);

  /// Asks the next `read` to activate the device. The request is dropped unless the link is
  /// connected, and if the home pose is needed and `home` does not say that the arm was seen there.
  /// From any thread. Real-time: safe.
  void ask_to_activate(HomeCheck home = HomeCheck::kNone) noexcept {
    activation_asked_.store(home == HomeCheck::kPassed ? Asked::kAtHome : Asked::kYes,
                            std::memory_order_release);
  }

  /// Lets the enabling input that the caller watches (HoldToRun::by_caller) count as held up to a
  /// time of the loop's clock, ns: while it is held the caller says so again and again. From any
  /// thread. Real-time: safe.
  void hold_until(std::int64_t time_ns) noexcept;

  /// Makes the fault that follows a sleep of the computer (Clock::asleep_ns): no force until the
  /// device is activated again, and the counts are doubted, for a board may have lost its power.
  /// Real-time: safe.
  void wake_from_sleep() noexcept {
    gate_.trip(Fault::kSuspended);
    doubt_counts();
  }

  /// Ends `home_needed`: the caller has seen the arm in its home pose. Real-time: safe.
  void confirm_home() noexcept { home_needed_ = false; }

  DeviceStage stage() const noexcept;  ///< Returns where it is in its life. Real-time: safe.
  /// Returns whether the link is lost and waits for an offer. Real-time: safe.
  bool lost() const noexcept { return lost_; }
  /// Returns the state of the link, whatever the fault is. Real-time: safe.
  LinkState link_state() const noexcept;
  /// Returns whether the arm's board may have restarted, so that its counts may be wrong: no force
  /// before the arm was seen in its home pose. Never for an arm with absolute encoders, one that
  /// finds its own zero, or one whose pose its vendor reports. Real-time: safe.
  bool home_needed() const noexcept { return home_needed_; }
  Fault fault() const noexcept { return gate_.fault(); }  ///< Names what switched the force off.
  /// Shows what was read last. Real-time: safe.
  const DeviceState& state() const noexcept { return state_; }
  /// Returns the force that stands, N in the world: of the last message that the arm took, and zero
  /// once the link is lost. Real-time: safe.
  const Eigen::Vector3d& f_sent_W() const noexcept { return f_sent_W_; }
  /// Counts what came over the link. Real-time: safe.
  const WireCounters& wire_counters() const noexcept { return wire_; }
  /// Counts what the gate did. Real-time: safe.
  const GateCounters& gate_counters() const noexcept { return gate_.counters(); }
  /// Counts what the walls around the workspace did. Real-time: safe.
  const WallCounters& wall_counters() const noexcept { return wall_counters_; }
  const SafetyGate& gate() const noexcept { return gate_; }  ///< Shows the gate. Real-time: safe.
  /// Returns the settings that it was opened with. Real-time: safe.
  const DeviceSettings& settings() const noexcept { return settings_; }
  /// Returns the thermal model of its motors. Real-time: safe.
  const HeatGuard& heat() const noexcept { return heat_; }
  /// Returns what the arm tells and how it is driven. Real-time: safe.
  const ArmTraits& traits() const noexcept { return traits_; }

 private:
  Device(std::unique_ptr<ArmLink> link, const DeviceSettings& settings) noexcept;
  bool take_report(std::int64_t now_ns, std::int64_t deadline_ns) noexcept;
  void take_extras(const ArmSample& sample) noexcept;
  bool jumped(const Eigen::Vector3d& p_WT, double since_last) noexcept;
  bool moved_unseen(const Eigen::Vector3d& p_WT, std::int64_t now_ns) const noexcept;
  bool follow_silence(std::int64_t now_ns) noexcept;
  void doubt_counts() noexcept { home_needed_ = home_needed_ || traits_.zero_at_power_on; }
  void take_offer(std::int64_t now_ns) noexcept;
  void take_request() noexcept;
  bool retire_link() noexcept;
  void begin_activity() noexcept;
  LinkWrite send(const GatedForce& force) noexcept;
  void send_zero() noexcept;
  void count_refusal(LinkStatus status) noexcept;
  void keep_standing() noexcept;
  bool zero_taken() const noexcept { return known_to_stand_ && f_sent_W_.isZero(0); }
  void lose() noexcept;
  void watch() noexcept;
  bool wait_for_hold() noexcept;
  void stop_at_walls(const ForceCommand& command) noexcept;
  void pass_on(const ForceCommand& command, double held) noexcept;
  void forget_velocity() noexcept;
  /// Returns the velocity that the gate goes by, m/s: whoever reads the arm may smooth his own.
  const Eigen::Vector3d& v_gate_W() const noexcept {
    return own_velocity_ != nullptr ? v_own_W_ : state_.v_WT;
  }
  void book_power() noexcept;
  GatedForce pass_program(const ForceCommand& command, double held) noexcept;
  GatedForce pass_guarded(const ForceCommand& command, double held) noexcept;
  void book(const LinkWrite& sent, const GatedForce& force) noexcept;
  const ArmSample& sample() const noexcept { return samples_[newest_]; }

  /// A request to activate.
  enum class Asked : std::uint8_t { kNo, kYes, kAtHome };

  std::unique_ptr<ArmLink> link_;  // null while it is lost, as soon as the old one was retired
  ArmTraits traits_;
  DeviceSettings settings_;
  SafetyGate gate_;
  MotionWatch motion_;
  HeatGuard heat_;
  std::unique_ptr<WorkAccount> work_;  // for the energy stage
  // Of the tip when the power was booked last, and whether that is known.
  Eigen::Vector3d p_power_WT_{0, 0, 0};
  bool placed_ = false;
  // Since forces are let through: a program asked for one; that, or storages were named.
  bool programs_ = false;
  bool explained_ = false;

  std::unique_ptr<VelocityEstimator> velocity_;
  std::unique_ptr<VelocityEstimator>
      own_velocity_;                  // where the other is slower than the gate may be
  Eigen::Vector3d v_own_W_{0, 0, 0};  // m/s, by it
  std::unique_ptr<WorkspaceWalls> walls_;
  WallCounters wall_counters_;
  std::unique_ptr<EnablingInput> enabling_;  // null: nothing is to be held
  WireCounters wire_;
  // One holds what is believed, the other takes the next report.
  std::array<ArmSample, 2> samples_;
  std::size_t newest_ = 0;
  DeviceState state_;
  Eigen::Vector3d f_sent_W_{0, 0, 0};
  std::int64_t last_report_ns_ = 0;
  std::int64_t quiet_since_ns_ = 0;  // last report, or the begin of listening
  std::int64_t listened_ns_ = 0;     // last read or idle
  bool guarded_;                     // an energy stage or a heat guard is named
  bool extras_;                      // the arm tells more, or less, than joints and counts
  bool active_ = false;
  bool waiting_ = false;  // for the enabling input
  bool started_ = false;  // a tick has been read
  bool lost_ = false;
  bool jumped_ = false;          // the newest report was dropped for a jump
  bool reported_ = false;        // a report came over this link
  bool known_to_stand_ = false;  // f_sent_W_ is what the arm took last, over this link
  bool silent_ = false;          // no report for the silence limit, and none since
  bool spoken_ = false;          // a message was sent, or refused, since the last report
  bool home_needed_ = false;
  bool insisted_ = false;  // on a zero that was not taken
  int refused_in_a_row_ = 0;
  int missed_in_a_row_ = 0;  // reads without a report, while it was listened to
  std::int64_t refused_since_ns_ = 0;
  std::atomic<ArmLink*> offered_{nullptr}, retired_{nullptr};
  std::atomic<Asked> activation_asked_{Asked::kNo};
};

}  // namespace thimble::driver
