#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "thimble/driver/board.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::device_sim {

// Constants of the simulated arm. All of them are data: app/arms/*.yaml gives each with its unit
// and its source; a default of zero here means "not simulated".

/// Describes the arm as it feels at its tip: the same mass and friction in x, y and z of the base.
struct PlantSettings {
  double mass = 0;     ///< Apparent mass at the tip, kg. Must be > 0.
  double viscous = 0;  ///< Viscous friction, N s/m.
  double coulomb = 0;  ///< Coulomb friction per axis, N.
};

/// Describes the hand that holds the tip: a mass fixed to it, and a spring and a damper to the
/// point where the hand wants to be.
struct HandSettings {
  double mass = 0;               ///< kg
  double stiffness = 0;          ///< N/m
  double damping = 0;            ///< N s/m
  double tremor_amplitude = 0;   ///< Peak displacement of the wanted point per axis, m.
  double tremor_frequency = 10;  ///< Middle of the tremor's band, Hz.
};

/// How a simulated hand turns the stylus: each axis of the gimbal to and fro, a third of a period
/// after the one before. It is a script: no force turns the stylus.
struct THIMBLE_EXPORT GimbalMotion {
  Eigen::Vector3d middle{0, 0, 0};     ///< Angles about which it turns to and fro, rad.
  Eigen::Vector3d amplitude{0, 0, 0};  ///< How far to each side, rad.
  double period = 2;                   ///< s. Must be > 0.

  /// Returns the angles of the gimbal at a time (s), rad. Real-time: safe.
  Eigen::Vector3d at(double time) const noexcept;
};

/// Describes motors and amplifiers.
struct MotorSettings {
  double current_max = 0;  ///< The amplifier saturates here, A. Must be > 0.
};

/// Describes how motors warm up by their currents, and what that makes of them. Vectors go joint by
/// joint.
struct MotorHeatSettings {
  static constexpr double kRiseMost = 1000;  ///< K; copper melts at about 1060.

  double rise = 0;  ///< Of a winding above the room, by its continuous current in the end, K.
  Eigen::Vector3d continuous_current{0, 0, 0};  ///< A
  Eigen::Vector3d time_constant{0, 0, 0};       ///< Of a winding's temperature, s.
  double resistance = 0;                        ///< Of the copper, by which it rises, 1/K.
  double torque = 0;                  ///< Of the torque constant, by which it changes, 1/K; <= 0.
  Eigen::Vector3d at_start{0, 0, 0};  ///< How much warmer than the room they are, K.

  /// Returns whether there is anything to simulate. Real-time: safe.
  bool named() const noexcept { return rise != 0; }
};

/// Describes what lies between the amplifiers and the links: all of it zero is an ideal drive
/// train. Vectors go joint by joint.
struct DriveTrainSettings {
  double current_lag = 0;  ///< Time constant of the currents (inductance, current loop), s.
  Eigen::Vector3d cogging{0, 0, 0};  ///< Amplitude of the torque towards the poles, N m at a motor.
  Eigen::Vector3d ripple{0, 0, 0};   ///< Amplitude of the torque constant's variation, relative.
  double periods_per_turn = 0;       ///< Of cogging and ripple, in a turn of the motor.
  /// Of each motor's wave where its joint's angle is zero, rad: the cogging pulls by
  /// -sin(periods_per_turn theta + phase) at the motor's angle theta, the ripple adds
  /// sin(periods_per_turn theta + phase).
  Eigen::Vector3d cogging_phase{0, 0, 0};
  Eigen::Vector3d ripple_phase{0, 0, 0};  ///< Likewise.
  /// Inertia of rotor and pulley, kg m^2 at the joint. It makes the mass at the tip depend on the
  /// pose: J^-T diag(inertia) J^-1 comes on top of the tip's own.
  Eigen::Vector3d inertia{0, 0, 0};
  Eigen::Vector3d stiffness{0, 0, 0};  ///< Of the cable, N m/rad at the joint. All > 0, or none.
  Eigen::Vector3d damping{0, 0, 0};    ///< Of the cable, N m s/rad.
  Eigen::Vector3d play{0, 0, 0};       ///< Whole width of the backlash, rad at the joint.
  /// Friction of each joint, N m s/rad; behind a cable that stretches that of the motor's side.
  Eigen::Vector3d viscous{0, 0, 0};
  Eigen::Vector3d coulomb{0, 0, 0};  ///< Dry friction, likewise, N m at the joint.
  MotorHeatSettings heat{};          ///< Of the motors; none: their torque never changes.

  /// Returns whether the cable stretches, so that motors and links move apart. Real-time: safe.
  bool compliant() const noexcept { return !stiffness.isZero(0); }
  /// Returns whether joints rub that are one with their motors. Real-time: safe.
  bool joints_rub() const noexcept {
    return !compliant() && !(viscous.isZero(0) && coulomb.isZero(0));
  }
  /// Returns whether there is anything to simulate. Real-time: safe.
  bool named() const noexcept {
    return current_lag != 0 || !cogging.isZero(0) || !ripple.isZero(0) || periods_per_turn != 0 ||
           !inertia.isZero(0) || compliant() || !damping.isZero(0) || !play.isZero(0) ||
           !viscous.isZero(0) || !coulomb.isZero(0) || heat.named();
  }
};

/// Describes the links of a serial arm beside the tip's own mass, by all that motion and weight can
/// tell of them: all zero is an arm whose mass is at its tip. Angles A, B, C are those of
/// driver::SerialArm. A link of mass m along B, its centre s from the shoulder, with the inertia I
/// about an axis across it through its centre, adds m s^2 + I to inertia B and to yaw_b, and m s to
/// moment_b; one along C that hangs on the elbow adds m length_b^2 to inertia B and yaw_b,
/// m s^2 + I to inertia C and yaw_c, m length_b s to coupling, m length_b to moment_b, and m s to
/// moment_c.
struct LinkSettings {
  /// About the yaw with both links upright, and about B and C, kg m^2. It includes rotors that turn
  /// with the joints, unless the drive train has them.
  Eigen::Vector3d inertia{0, 0, 0};
  double yaw_b = 0;  ///< What comes about the yaw with sin^2 B, kg m^2.
  double yaw_c = 0;  ///< With sin^2 C, kg m^2.
  double coupling =
      0;  ///< Between B and C with cos(B + C), about the yaw with sin B sin C, kg m^2.
  double moment_b = 0;  ///< First moment of mass along link B, counterweights negative, kg m.
  double moment_c = 0;  ///< Along link C, kg m.
  Eigen::Vector3d gravity_B{0, 0, 0};  ///< Gravity in the base, m/s^2.

  /// Returns whether there is anything to simulate. Real-time: safe.
  bool named() const noexcept {
    return !inertia.isZero(0) || yaw_b != 0 || yaw_c != 0 || coupling != 0 || moment_b != 0 ||
           moment_c != 0;
  }
};

/// Describes how encoders and motors are plugged into the board: a well-made arm has the defaults,
/// anything else is a mistake for a check to find.
struct THIMBLE_EXPORT WiringSettings {
  /// Names the joint whose encoder is plugged into each input of the board.
  std::array<std::uint8_t, 3> encoder_of{0, 1, 2};
  /// 1 for an encoder that counts as it should, -1 for one that counts backwards, 0 for a dead
  /// one; one for each input.
  Eigen::Vector3d encoder_gain{1, 1, 1};
  /// Names the joint whose motor is plugged into each output of the board.
  std::array<std::uint8_t, 3> motor_of{0, 1, 2};
  /// 1 for a motor that pulls as it should, -1 for one with its wires swapped, 0 for a dead one;
  /// one for each output.
  Eigen::Vector3d motor_gain{1, 1, 1};

  /// Returns an error if it names a joint that is not there or a gain is not finite. Real-time:
  /// never from the servo thread.
  driver::Result<void> check() const;
  /// Turns the encoders' counts, joint by joint, into those that the inputs see. Real-time: safe.
  Eigen::Vector3d inputs(const Eigen::Vector3d& counts) const noexcept {
    return {encoder_gain[0] * counts[encoder_of[0]], encoder_gain[1] * counts[encoder_of[1]],
            encoder_gain[2] * counts[encoder_of[2]]};
  }
  /// Turns the currents of the outputs into those of the motors, joint by joint, A. Real-time:
  /// safe.
  Eigen::Vector3d motors(const Eigen::Vector3d& outputs) const noexcept {
    Eigen::Vector3d amperes(0, 0, 0);
    for (std::size_t i = 0; i < 3; ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      amperes[motor_of[i]] += motor_gain[k] * outputs[k];
    }
    return amperes;
  }
};

/// Describes the firmware. Sources of the defaults: app/guide/pages/simulated_arm.md.
struct FirmwareSettings {
  std::int64_t report_period_ns = 1'000'000;  ///< One report is sampled and sent in each period.
  /// Without a message for this long the motors go off [S, DEVICES 1].
  std::int64_t watchdog_ns = 100'000'000;
  /// A current beyond this counts as zero [S, DEVICES 1; the value is a guess].
  std::int16_t current_range_mA = 6000;
  WiringSettings wiring;  ///< Which lines are dead or swapped.
  /// What it speaks: kPolhem, kWoody or kHfabLine.
  driver::ArmKind speaks = driver::ArmKind::kPolhem;
  std::int32_t line_model = 1;  ///< What it calls its arm in text lines [S hfabapi].
  /// Encoders of 65536 times as many steps, below a nanometre at the tip, to see what the real ones
  /// cost. Their counts need more room than any arm's language has but that of 14 bytes
  /// (hfab::FineReportWire), which is then spoken in place of `speaks`, and without a gimbal.
  bool ideal_encoders = false;
  double missed_edges = 0;  ///< Chance that a counter misses a step of its encoder, 0 to 1.
};

/// Describes the way between host and firmware.
struct WireSettings {
  std::int64_t delay_in_ns = 0;   ///< From sampling a report to the host being able to read it.
  std::int64_t delay_out_ns = 0;  ///< From the host's write to the motors.
  /// Comes on top of either delay, evenly spread from 0 to this; nothing overtakes.
  std::int64_t jitter_ns = 0;
  double loss = 0;  ///< Chance that a report or a message never arrives, 0 to below 1.

  /// Returns whether all that is sent arrives, after the same time. Real-time: safe.
  bool regular() const noexcept { return jitter_ns == 0 && loss == 0; }
};

/// Describes a whole simulated arm.
struct SimulatedArmSettings {
  PlantSettings plant;                ///< Mass, friction and stops of the arm.
  HandSettings hand;                  ///< How the hand holds it.
  MotorSettings motors;               ///< What the motors make of currents.
  DriveTrainSettings drive_train{};   ///< What lies between motors and links.
  LinkSettings links{};               ///< What hangs on the tip; of serial arms.
  Eigen::Vector3d weight_B{0, 0, 0};  ///< What gravity pulls on the tip with, in the base, N.
  FirmwareSettings firmware;          ///< What the board does, and when it gives up.
  WireSettings wire;                  ///< How long messages are on their way.
  GimbalMotion gimbal;                ///< How the hand turns the stylus, if a gimbal is mounted.
};

}  // namespace thimble::device_sim
