#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "thimble/driver/arm_link.h"
#include "thimble/driver/clock.h"
#include "thimble/driver/device_state.h"
#include "thimble/driver/force_law.h"
#include "thimble/driver/heat_guard.h"
#include "thimble/driver/motion_watch.h"
#include "thimble/driver/result.h"
#include "thimble/driver/safety_gate.h"
#include "thimble/driver/tick_record.h"

namespace thimble::driver {

class VelocityEstimator;
class WorkAccount;

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

  /// Fails if a limit is not a positive finite number or protects nobody (GateLimits). Real-time:
  /// never from the servo thread.
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

/// One open arm behind its link: idle -> active -> (fault ->) idle, until destroyed.
///
/// Every way out sends zero force: `deactivate`, a fault, the destructor. A fault latches until
/// `activate` is called again; a clock that steps back is one. Used by one thread at a time, but
/// for `offer` and `ask_to_activate`.
///
/// An arm that was pulled and plugged in again: the loop goes on with zero force and the fault
/// kTransportLost; somebody at the side finds the arm by its serial number, opens a link and offers
/// it; the next tick takes it and reads positions again. Forces come back only when the user says
/// so (`ask_to_activate`). Encoders count from where the arm stood when it got power, so it must
/// stand in its home pose then.
class Device {
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
  /// link is lost. Real-time: never from the servo thread.
  Result<void> activate();

  /// Sends zero force now, once more if the arm does not take it, and in every later tick.
  /// `zero_assured` says whether it was taken. Real-time: safe.
  void deactivate() noexcept;

  /// Sends zero force again, each millisecond of `clock`, until the arm takes it or the link is
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

  /// Offers a new link to the same arm in place of a lost one; an earlier offer that was not taken
  /// is dropped. The next `read` takes it if the link is lost. Fails, and drops the link, if it is
  /// to an arm of another kind (`ArmTraits`). From any one thread beside the loop's. Real-time:
  /// never from the servo thread.
  Result<void> offer(std::unique_ptr<ArmLink> link);

  /// Asks the next `read` to activate the device. An ask while the link is lost, or before the
  /// first report of a new link, is forgotten: nobody gets a force he did not just ask for. From
  /// any thread. Real-time: safe.
  void ask_to_activate() noexcept { activation_asked_.store(true, std::memory_order_release); }

  DeviceStage stage() const noexcept;  ///< Returns where it is in its life. Real-time: safe.
  /// Returns whether the link is lost and waits for an offer. Real-time: safe.
  bool lost() const noexcept { return lost_; }
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
  const SafetyGate& gate() const noexcept { return gate_; }  ///< Shows the gate. Real-time: safe.
  /// Returns the thermal model of its motors. Real-time: safe.
  const HeatGuard& heat() const noexcept { return heat_; }
  /// Returns what the arm tells and how it is driven. Real-time: safe.
  const ArmTraits& traits() const noexcept { return traits_; }

 private:
  Device(std::unique_ptr<ArmLink> link, const DeviceSettings& settings) noexcept;
  bool take_report(std::int64_t now_ns, std::int64_t deadline_ns) noexcept;
  void take_extras(const ArmSample& sample) noexcept;
  bool jumped(const Eigen::Vector3d& p_WT, double since_last) noexcept;
  void take_offer(std::int64_t now_ns) noexcept;
  void begin_activity() noexcept;
  LinkWrite send(const GatedForce& force) noexcept;
  void send_zero() noexcept;
  void count_refusal(LinkStatus status) noexcept;
  void keep_standing() noexcept;
  void lose() noexcept;
  void watch() noexcept;
  GatedForce pass_guarded(const ForceCommand& command) noexcept;
  void book(const LinkWrite& sent, const GatedForce& force) noexcept;
  const ArmSample& sample() const noexcept { return samples_[newest_]; }

  std::unique_ptr<ArmLink> link_;
  ArmTraits traits_;
  DeviceSettings settings_;
  SafetyGate gate_;
  MotionWatch motion_;
  HeatGuard heat_;
  std::unique_ptr<WorkAccount> work_;  // for the energy stage
  std::unique_ptr<VelocityEstimator> velocity_;
  WireCounters wire_;
  // One holds what is believed, the other takes the next report.
  std::array<ArmSample, 2> samples_;
  std::size_t newest_ = 0;
  DeviceState state_;
  Eigen::Vector3d f_sent_W_{0, 0, 0};
  std::int64_t last_report_ns_ = 0;
  bool guarded_;  // an energy stage or a heat guard is named
  bool extras_;   // the arm tells more, or less, than joints and counts
  bool active_ = false;
  bool started_ = false;  // a tick has been read
  bool lost_ = false;
  bool jumped_ = false;          // the newest report was dropped for a jump
  bool reported_ = false;        // a report came over this link
  bool known_to_stand_ = false;  // f_sent_W_ is what the arm took last, over this link
  bool insisted_ = false;        // on a zero that was not taken
  int refused_in_a_row_ = 0;
  std::int64_t refused_since_ns_ = 0;
  std::atomic<ArmLink*> offered_{nullptr}, retired_{nullptr};
  std::atomic<bool> activation_asked_{false};
};

}  // namespace thimble::driver
