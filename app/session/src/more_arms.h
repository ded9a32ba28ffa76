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

/// Loop of one of several arms after the first, with the observers of its ticks.
struct ArmRun {
  /// Allocates memory for the run of an arm, numbered from 1. Real-time: never from the servo
  /// thread.
  ArmRun(const Setup& setup, std::size_t arm);

  RunRecords records;  ///< Records of this arm, without dents and poses.
  /// Log of events; created once the arm is open, if the run is logged.
  std::unique_ptr<EventLog> event_log;
  RunLaw law;    ///< Force law of this arm.
  RunLoop loop;  ///< Servo loop of this arm.
};

/// The arms of a run after the first. A tick of the run consists of the tick of each arm in turn
/// (read, law, gate, write), then one step of the bodies that they touch. So every arm finds the
/// bodies in the same place, whatever its number, and the run is bit-identical when repeated.
class MoreArms {
 public:
  /// Allocates memory for the arms of `setup`, which must outlive it; there may be none. Real-time:
  /// never from the servo thread.
  explicit MoreArms(Setup& setup);

  /// Returns whether the scene has only one arm. Real-time: safe.
  bool empty() const noexcept { return runs_.empty(); }
  /// Returns the run of an arm, numbered from 1.
  ArmRun& run(std::size_t arm) noexcept { return *runs_[arm - 1]; }

  /// Creates the logs of the open arms if the run is logged. Real-time: never from the servo
  /// thread.
  void open(bool log);
  /// Shares the arms after the first with viewers and applies `control` to them; both arguments
  /// must outlive the run. Real-time: never from the servo thread.
  void share(SharedRun& shared, LiveControl& control);
  /// Starts the loops of all arms after the first. Precondition: the arms are open. Real-time:
  /// safe.
  void begin(const driver::ServoSettings& settings) noexcept;
  /// Runs the rest of a tick, after that of the first arm, which returned `end`. If any loop ends,
  /// the run ends, with zero force for all arms in the same tick. Faults with FaultRule::kApart do
  /// not end a loop. Real-time: safe.
  std::optional<driver::ServoEnd> tick(RunLoop& first, std::optional<driver::ServoEnd> end,
                                       const std::atomic<bool>& stop) noexcept;
  /// Returns the end reason of a run of several arms; empty while it continues, and for one arm.
  std::optional<driver::ServoEnd> end() const noexcept { return end_; }

 private:
  /// Switches off the force of all arms if one is in fault and the scene requests it. Real-time:
  /// safe.
  void remove_forces_on_fault() noexcept;

  Setup& setup_;
  std::vector<std::unique_ptr<OtherArmSharing>> sharing_;
  std::vector<std::unique_ptr<ArmRun>> runs_;
  std::optional<driver::ServoEnd> end_;
};

/// Returns the description of an arm's run for the log; arms are numbered from 0. Precondition: the
/// arm is open. Real-time: never from the servo thread.
LoggedRun logged_run(const Setup& setup, std::size_t arm);

}  // namespace thimble::session
