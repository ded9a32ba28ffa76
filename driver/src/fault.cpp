#include "thimble/driver/fault.h"
#include "thimble/driver/tick_record.h"

namespace thimble::driver {

std::string_view describe(Fault fault) noexcept {
  switch (fault) {
    case Fault::kNone:
      return "No fault.";
    case Fault::kTransportLost:
      return "The arm is disconnected. Check its cable and power, then restart.";
    case Fault::kNoReports:
      return "The arm stopped sending reports. Check its cable and power. If it is behind a USB "
             "hub, plug it directly into the computer.";
    case Fault::kForceNotFinite:
      return "The force law returned a force that is not finite. This is an error in the scene or "
             "in an effect; the last records show where the tip was.";
    case Fault::kStateNotFinite:
      return "The computed tip position is not finite. Check the arm's geometry and encoder data.";
    case Fault::kOverSpeed:
      return "The tip moved faster than the arm's speed limit. Hold the arm, or increase speed_max "
             "in the arm file if such speeds are intended.";
    case Fault::kLoopStalled:
      return "The servo loop stalled for longer than the timeout of the arm's watchdog. Close "
             "other programs, or allow real-time scheduling.";
    case Fault::kRefused:
      return "The arm no longer accepts messages, so its own watchdog must switch the motors off. "
             "Switch it off and on, and plug it in again.";
    case Fault::kTimeNotMonotonic:
      return "The servo loop's clock jumped backwards or returned a time that is not finite. Use a "
             "monotonic clock (CLOCK_MONOTONIC), and activate the arm again.";
    case Fault::kMotorsReversed:
      return "The tip accelerated against the sent force, so a motor pulls in the wrong direction. "
             "Let go of the arm; check the motor wires and motor_sign with `thimble feel-check`.";
    case Fault::kEncoderFrozen:
      return "The encoder of one joint did not change while the force on that joint changed and "
             "the other joints moved. Check that encoder's cable with `thimble feel-check`. An arm "
             "that rests against its stop looks the same.";
    case Fault::kCountsUnchanged:
      return "No encoder changed while a force was held, so the arm may be sending old positions. "
             "Move the arm and activate it again. If the encoders still do not change, check its "
             "cable and power. An arm that rests on an object for a long time looks the same "
             "(hold_unchanged in the arm file).";
    case Fault::kOtherArm:
      return "Another arm of this run had a fault, and this scene switches the forces of all its "
             "arms off together (with `faults: apart` the others continue).";
    case Fault::kCountsJumped:
      return "The arm's position jumped while no report arrived. This happens if the arm's board "
             "restarts and its encoders count from zero again. Put the arm into its home pose and "
             "activate it again. If it happens again, check its power and cable.";
    case Fault::kSuspended:
      return "The computer was suspended while the arm was in use. Put the arm into its home pose "
             "and activate it again. Keep the computer awake during a run.";
    case Fault::kOutsideWorkspace:
      return "The tip moved beyond the walls of the workspace in the arm file. Bring it back and "
             "activate the arm again. If it was not moved there by hand, check "
             "gravity_compensation and the scene's forces.";
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
