#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <optional>

#include "thimble/driver/arm.h"
#include "thimble/driver/clock.h"
#include "thimble/driver/device_state.h"
#include "thimble/driver/force_command.h"
#include "thimble/driver/heat_guard.h"
#include "thimble/driver/motion_watch.h"
#include "thimble/driver/result.h"
#include "thimble/driver/safety_gate.h"
#include "thimble/driver/tick_record.h"
#include "thimble/driver/transport.h"
#include "thimble/driver/velocity_estimator.h"

namespace thimble::driver {

/// Sets how a device is placed and what it tolerates.
struct DeviceSettings {
  Eigen::Matrix3d R_WB = Eigen::Matrix3d::Identity();  ///< Rotation of the arm's base in the world.
  Eigen::Vector3d p_WB{0, 0, 0};                       ///< Position of the arm's base, m.
  GateLimits limits;                                   ///< Of force, rise and speed.
  EnergyGuardSettings energy{};                ///< Which energy stage the gate has; none: free.
  MotionWatchSettings motion{};                ///< What motors and encoders are watched by.
  HeatSettings heat{};                         ///< Of the motors; none: not known.
  double velocity_corner_frequency = 0;        ///< Pole of the velocity estimate, Hz; 0: none.
  std::int64_t silence_limit_ns = 20'000'000;  ///< Silence of the arm that is a fault, ns (20
                                               ///< reports of a full-speed USB arm; chosen).
};

/// Counts what arrived over the wire.
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

/// Is one open arm, from its bytes to its tip: idle -> active -> (fault ->) idle, until destroyed.
///
/// Every way out sends zero force: `deactivate`, a fault, the destructor. A fault latches until
/// `activate` is called again; a clock that steps back is one. Used by one thread at a time, but
/// for `offer` and `ask_to_activate`.
///
/// An arm that was pulled and plugged in again: the loop goes on with zero force and the fault
/// kTransportLost; somebody at the side finds the arm by its serial number, opens a wire and offers
/// it; the next tick takes it and reads positions again. Forces come back only when the user says
/// so (`ask_to_activate`). Encoders count from where the arm stood when it got power, so it must
/// stand in its home pose then.
class Device {
 public:
  /// Takes an open wire and the arm at its other end; waits up to `timeout_ns` of `clock_now_ns`
  /// time for the first report by way of the transport's deadline, and sends zero force meanwhile,
  /// because some arms speak only when spoken to. Fails if none arrives or none can be understood,
  /// if a limit is not a positive finite number, or if one protects nobody: a soft start below 0.05
  /// s, a rise above 100,000 N/s and above force_max in 50 us, a watchdog above 1 s. Real-time:
  /// never from the servo thread.
  static Result<std::unique_ptr<Device>> open(std::unique_ptr<Transport> transport,
                                              std::unique_ptr<const Arm> arm,
                                              const DeviceSettings& settings,
                                              std::int64_t clock_now_ns,
                                              std::int64_t timeout_ns = 1'000'000'000);

  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  /// Sends zero force, then closes the wire. Where a force stands and the arm does not take the
  /// zero, it insists in real time as `insist_on_zero` does, unless that has been done.
  ~Device();

  /// Lets forces through from the next tick on, with a soft start; clears a fault. Fails if the
  /// wire is lost. Real-time: never from the servo thread.
  Result<void> activate();

  /// Sends zero force now, once more if the arm does not take it, and in every later tick.
  /// `zero_assured` says whether it was taken. Real-time: safe.
  void deactivate() noexcept;

  /// Sends zero force again, each millisecond of `clock`, until the arm takes it or the wire is
  /// lost: for as long as the arm's own watchdog waits (`GateLimits::watchdog_ns`), after which the
  /// arm must have switched itself off. Returns whether it was taken; if not, that is the fault
  /// kRefused. For the end of a loop. Real-time: safe; waits, and a write may wait as well.
  bool insist_on_zero(Clock& clock) noexcept;

  /// Returns whether the force that stands is known to be zero: the last message that the arm took
  /// said so. False: another force may stand until the arm's own watchdog switches it off. Taken
  /// means handed over: a serial port or a converter may still have it on the way. Real-time: safe.
  bool zero_assured() const noexcept { return known_to_stand_ && f_sent_W_.isZero(0); }

  /// Begins a tick: reads the newest report and finds where the tip is. A report after which the
  /// tip would have changed its speed by 1 m/s within 1 ms is dropped, once: no hand does that, but
  /// a disturbed encoder line does; the second in a row is believed. With no new report the last
  /// state stands (`fresh` is false); after `silence_limit_ns` of that it is a fault. Real-time:
  /// safe; waits no longer than `deadline_ns`.
  const DeviceState& read(std::int64_t now_ns, std::int64_t deadline_ns) noexcept;

  /// Reads the newest report as `read` does and sends zero force: for whoever looks at the arm
  /// before a run. It counts no tick, and notices no silence. Real-time: safe.
  const DeviceState& idle(std::int64_t now_ns, std::int64_t deadline_ns) noexcept;

  /// Ends a tick: passes the command through the gate and sends what is left of it, or zero if the
  /// device is not active. What the arm does not take leaves the force before it standing, and the
  /// next one rises from that. Real-time: safe.
  void write(const ForceCommand& command) noexcept;

  /// Makes a fault that somebody above found (it latches, the force goes off). Real-time: safe.
  void trip(Fault fault) noexcept { gate_.trip(fault); }

  /// Offers a new wire to the same arm in place of a lost one; an earlier offer that was not taken
  /// is dropped. The next `read` takes it if the wire is lost. From any one thread beside the
  /// loop's. Real-time: never from the servo thread.
  void offer(std::unique_ptr<Transport> transport);

  /// Asks the next `read` to activate the device. An ask while the wire is lost, or before the
  /// first report of a new wire, is forgotten: nobody gets a force he did not just ask for. From
  /// any thread. Real-time: safe.
  void ask_to_activate() noexcept { activation_asked_.store(true, std::memory_order_release); }

  DeviceStage stage() const noexcept;  ///< Tells where it is in its life. Real-time: safe.
  /// Tells whether the wire is lost and waits for an offer. Real-time: safe.
  bool lost() const noexcept { return lost_; }
  Fault fault() const noexcept { return gate_.fault(); }  ///< Names what switched the force off.
  /// Shows what was read last. Real-time: safe.
  const DeviceState& state() const noexcept { return state_; }
  /// Returns the force that stands, N in the world: of the last message that the arm took, and zero
  /// once the wire is lost. Real-time: safe.
  const Eigen::Vector3d& f_sent_W() const noexcept { return f_sent_W_; }
  /// Counts what came over the wire. Real-time: safe.
  const WireCounters& wire_counters() const noexcept { return wire_; }
  /// Counts what the gate did. Real-time: safe.
  const GateCounters& gate_counters() const noexcept { return gate_.counters(); }
  const SafetyGate& gate() const noexcept { return gate_; }  ///< Shows the gate. Real-time: safe.
  /// Returns the thermal model of its motors. Real-time: safe.
  const HeatGuard& heat() const noexcept { return heat_; }

 private:
  Device(std::unique_ptr<Transport> transport, std::unique_ptr<const Arm> arm,
         const DeviceSettings& settings) noexcept;
  bool take_report(std::int64_t now_ns, std::int64_t deadline_ns) noexcept;
  bool jumped(const Eigen::Vector3d& p_WT, double since_last) noexcept;
  bool came_before(const ArmReading& reading) noexcept;
  void take_offer(std::int64_t now_ns) noexcept;
  void begin_activity() noexcept;
  bool send(const MotorCurrents& currents) noexcept;
  void send_zero() noexcept;
  void keep_standing() noexcept;
  void choose_way() noexcept;
  void watch() noexcept;
  void write_otherwise(const ForceCommand& command) noexcept;
  void write_guarded(const ForceCommand& command) noexcept;
  Eigen::Vector3d torque_of(const MotorCurrents& currents) const noexcept;

  std::unique_ptr<Transport> transport_;
  std::unique_ptr<const Arm> arm_;
  DeviceSettings settings_;
  SafetyGate gate_;
  MotionWatch motion_;
  HeatGuard heat_;
  VelocityEstimator velocity_;
  WireCounters wire_;
  ArmPose pose_;
  DeviceState state_;
  Eigen::Vector3d f_sent_W_{0, 0, 0};
  std::int64_t last_report_ns_ = 0;
  // Active, with a wire, and neither energy stage nor heat guard: the one test of a usual tick.
  bool plain_ = false;
  bool active_ = false;
  bool started_ = false;  // a tick has been read
  bool lost_ = false;
  bool jumped_ = false;    // the newest report was dropped for a jump
  bool reported_ = false;  // a report came over this wire
  bool numbered_ = false;  // two reports of this wire had different numbers
  std::optional<std::uint16_t> number_;
  // Of the energy stage: torques on their way to the motors, N m, the newest first, and where the
  // arm was when it was asked last.
  std::array<Eigen::Vector3d, EnergyGuardSettings::kDelayMost + 1> tau_sent_{};
  Eigen::Vector3d q_booked_{0, 0, 0};
  Eigen::Vector3d p_booked_W_{0, 0, 0};
  bool booked_ = false;
  bool known_to_stand_ = false;  // f_sent_W_ is what the arm took last, over this wire
  bool insisted_ = false;        // on a zero that was not taken
  int refused_in_a_row_ = 0;
  std::int64_t refused_since_ns_ = 0;
  std::atomic<Transport*> offered_{nullptr}, retired_{nullptr};
  std::atomic<bool> activation_asked_{false};
};

}  // namespace thimble::driver
