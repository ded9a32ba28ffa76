#include "thimble/driver/fault.h"
#include "thimble/driver/tick_record.h"

namespace thimble::driver {

std::string_view describe(Fault fault) noexcept {
  switch (fault) {
    case Fault::kNone:
      return "No fault.";
    case Fault::kTransportLost:
      return "The arm is gone from the wire. Check its cable and power, then start again.";
    case Fault::kNoReports:
      return "The arm stopped sending reports. Check its cable and power; if it is a USB arm "
             "behind "
             "a hub, plug it into the computer itself.";
    case Fault::kForceNotFinite:
      return "The force law answered with a force that is not a number. This is a fault in the "
             "scene or in an effect; the last records show where the tip was.";
    case Fault::kStateNotFinite:
      return "The tip's position came out as not a number. Check the arm's geometry and encoder "
             "data.";
    case Fault::kOverSpeed:
      return "The tip moved faster than the arm's speed limit. Hold the arm, or raise speed_max in "
             "the arm file if such speeds are meant.";
    case Fault::kLoopStalled:
      return "The servo loop stood still longer than the arm's watchdog waits. Close other "
             "programs, or allow real-time scheduling.";
    case Fault::kRefused:
      return "The arm takes no messages any more, so its own watchdog must switch the motors off. "
             "Switch it off and on, and plug it in again.";
    case Fault::kTimeNotMonotonic:
      return "The servo loop's clock stepped back, or gave a time that is not a number. Use a "
             "monotonic clock (CLOCK_MONOTONIC), and activate the arm again.";
    case Fault::kMotorsReversed:
      return "The tip gained speed against the force that was sent, so a motor pulls the wrong "
             "way. "
             "Do not hold the arm; check the motors' wires and motor_sign with `thimble "
             "feel-check`.";
    case Fault::kEncoderFrozen:
      return "One joint's encoder stood still while the force on that joint changed and the others "
             "moved. Check that encoder's cable with `thimble feel-check`; an arm that leans on "
             "its "
             "stop looks the same.";
    case Fault::kCountsUnchanged:
      return "No encoder counted while a force was held, so the arm may be sending old positions. "
             "Move the arm and activate it again; if nothing counts, check its cable and power. An "
             "arm that lies still on an object for long looks the same (hold_unchanged in the arm "
             "file).";
    case Fault::kOtherArm:
      return "Another arm of this run came to a fault, and the scene takes the force of all its "
             "arms together (faults: apart lets the others go on).";
    case Fault::kCountsJumped:
      return "The arm's position jumped while no report came, as it does when the arm's board "
             "restarts and its encoders count from zero again. Put the arm into its home pose and "
             "activate it again; if it happens again, check its power and cable.";
    case Fault::kSuspended:
      return "The computer was suspended while the arm was in use. Put the arm into its home pose "
             "and activate it again; see that the computer stays awake during a run.";
    case Fault::kOutsideWorkspace:
      return "The tip went beyond the walls of the workspace that the arm file names. Bring it "
             "back and activate the arm again. If nobody moved it there, check "
             "gravity_compensation "
             "and the scene's forces.";
  }
  return "Unknown fault.";
}

std::string_view name(Fault fault) noexcept {
  switch (fault) {
    case Fault::kNone:
      return "none";
    case Fault::kTransportLost:
      return "transport_lost";
    case Fault::kNoReports:
      return "no_reports";
    case Fault::kForceNotFinite:
      return "force_not_finite";
    case Fault::kStateNotFinite:
      return "state_not_finite";
    case Fault::kOverSpeed:
      return "over_speed";
    case Fault::kLoopStalled:
      return "loop_stalled";
    case Fault::kRefused:
      return "messages_refused";
    case Fault::kTimeNotMonotonic:
      return "time_not_monotonic";
    case Fault::kMotorsReversed:
      return "motors_reversed";
    case Fault::kEncoderFrozen:
      return "encoder_frozen";
    case Fault::kCountsUnchanged:
      return "counts_unchanged";
    case Fault::kOtherArm:
      return "other_arm";
    case Fault::kCountsJumped:
      return "counts_jumped";
    case Fault::kSuspended:
      return "suspended";
    case Fault::kOutsideWorkspace:
      return "outside_workspace";
  }
  return "unknown";
}

std::string_view name(LinkState state) noexcept {
  switch (state) {
    case LinkState::kConnected:
      return "connected";
    case LinkState::kSilent:
      return "silent";
    case LinkState::kLost:
      return "lost";
  }
  return "unknown";
}

}  // namespace thimble::driver
