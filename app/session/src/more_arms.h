#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "events/event_log.h"
#include "run_law.h"
#include "run_loop.h"
#include "run_records.h"
#include "setup.h"
#include "share/live_control.h"
#include "share/run_sharing.h"
#include "thimble/driver/device.h"
#include "thimble/driver/servo_loop.h"

namespace thimble::session {

/// The loop over one of several arms after the first, and the observers of its ticks.
struct ArmRun {
  /// Makes room for the run of an arm, counted from 1. Real-time: never from the servo thread.
  ArmRun(const Setup& setup, std::size_t arm);

  RunRecords records;                   ///< Of this arm alone; no dents and poses.
  std::unique_ptr<EventLog> event_log;  ///< Once the arm is open, if the run is logged.
  RunLaw law;                           ///< On this arm's hand.
  RunLoop loop;                         ///< Over this arm.
};

/// The arms of a run after the first, if a scene has several. One tick of the run is the tick of
/// each arm in turn (read, law, gate, write), then one step of the bodies that they touch: so every
/// arm finds them at one place, whatever its number, and the run is repeatable to the bit.
class MoreArms {
 public:
  /// Makes room for the arms of `setup`, which must outlive it; there may be none.
  /// Real-time: never from the servo thread.
  explicit MoreArms(Setup& setup);

  /// Returns whether the scene has one arm alone. Real-time: safe.
  bool empty() const noexcept { return runs_.empty(); }
  /// Returns the run of an arm, counted from 1.
  ArmRun& run(std::size_t arm) noexcept { return *runs_[arm - 1]; }

  /// Makes the logs of arms that are open, if the run is logged. Real-time: never from the servo
  /// thread.
  void open(bool log);
  /// Lets viewers see the arms after the first, and do what `control` does for the first; both must
  /// outlive the run. Real-time: never from the servo thread.
  void share(SharedRun& shared, LiveControl& control);
  /// Begins the loops of all arms after the first. Precondition: the arms are open. Real-time:
  /// safe.
  void begin(const driver::ServoSettings& settings) noexcept;
  /// Runs the rest of a tick, after that of the first arm, which returned `end`. A loop that ends
  /// ends the run, with zero force for all in this very tick; faults that arms outlive
  /// (FaultRule::kApart) end none. Real-time: safe.
  std::optional<driver::ServoEnd> tick(RunLoop& first, std::optional<driver::ServoEnd> end,
                                       const std::atomic<bool>& stop) noexcept;
  /// Returns why a run of several arms ended; empty while it has not, and of one arm.
  std::optional<driver::ServoEnd> end() const noexcept { return end_; }

 private:
  /// Where the scene says so, takes the force of all arms once one is in fault. Real-time: safe.
  void take_all_forces() noexcept;

  Setup& setup_;
  std::vector<std::unique_ptr<OtherArmSharing>> sharing_;
  std::vector<std::unique_ptr<ArmRun>> runs_;
  std::optional<driver::ServoEnd> end_;
};

/// Returns what the log is told of an arm's run, counted from 0. Precondition: the arm is open.
/// Real-time: never from the servo thread.
LoggedRun logged_run(const Setup& setup, std::size_t arm);

}  // namespace thimble::session
