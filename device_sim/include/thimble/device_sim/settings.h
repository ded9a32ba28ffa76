#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>

#include "thimble/driver/board.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::driver {
struct WireTable;
}

namespace thimble::device_sim {

class ReferenceProgram;

// Constants of the simulated arm. app/arms/*.yaml gives each with its unit and source. A default of
// zero means "not simulated".

/// Apparent properties of the arm at its tip: the same mass and friction in x, y and z of the base.
struct PlantSettings {
  double mass = 0;     ///< Apparent mass at the tip, kg. Must be > 0.
  double viscous = 0;  ///< Viscous friction, N s/m.
  double coulomb = 0;  ///< Coulomb friction per axis, N.
};

/// Hand that holds the tip: a mass fixed to it, and a spring and a damper between it and the target
/// of the hand.
struct HandSettings {
  double mass = 0;               ///< Mass, kg.
  double stiffness = 0;          ///< Stiffness, N/m.
  double damping = 0;            ///< Damping, N s/m.
  double tremor_amplitude = 0;   ///< Peak displacement of the target per axis, m.
  double tremor_frequency = 10;  ///< Centre frequency of the tremor, Hz.
};

/// Motion of the stylus by a simulated hand: each gimbal axis oscillates, a third of a period after
/// the previous one. The motion is prescribed: no force rotates the stylus.
struct THIMBLE_EXPORT GimbalMotion {
  Eigen::Vector3d middle{0, 0, 0};     ///< Centre angles of the oscillation, rad.
  Eigen::Vector3d amplitude{0, 0, 0};  ///< Amplitude, rad.
  double period = 2;                   ///< Period, s. Must be > 0.

  /// Returns the gimbal angles at a time (s), rad. Real-time: safe.
  Eigen::Vector3d at(double time) const noexcept;
};

/// Motors and amplifiers.
struct MotorSettings {
  double current_max = 0;  ///< Saturation current of the amplifier, A. Must be > 0.
};

/// Heating of the motors by their currents, and its effects. Vector components are joints.
struct MotorHeatSettings {
  /// Largest allowed rise, K; copper melts at a rise of about 1060.
  static constexpr double kRiseMax = 1000;
  /// Former name of kRiseMax.
  [[deprecated("renamed to kRiseMax")]] static constexpr double kRiseMost = kRiseMax;

  /// Final temperature rise of a winding above ambient at the continuous current, K.
  double rise = 0;
  Eigen::Vector3d continuous_current{0, 0, 0};  ///< Continuous current, A.
  Eigen::Vector3d time_constant{0, 0, 0};       ///< Time constant of a winding's temperature, s.
  /// Temperature coefficient of the copper resistance (increase), 1/K.
  double resistance = 0;
  /// Temperature coefficient of the torque constant, 1/K; <= 0.
  double torque = 0;
  Eigen::Vector3d at_start{0, 0, 0};  ///< Initial temperature above ambient, K.

  /// Returns whether there is anything to simulate. Real-time: safe.
  bool named() const noexcept { return rise != 0; }
};

/// Drive train between the amplifiers and the links; all zeros are an ideal one. Vector components
/// are joints.
struct DriveTrainSettings {
  double current_lag = 0;  ///< Time constant of the currents (inductance, current loop), s.
  Eigen::Vector3d cogging{0, 0, 0};  ///< Amplitude of the cogging torque, N m at a motor.
  /// Amplitude of the relative variation of the torque constant (torque ripple).
  Eigen::Vector3d ripple{0, 0, 0};
  double periods_per_turn = 0;  ///< Periods of cogging and ripple per turn of the motor.
  /// Phase of each motor's cogging at joint angle zero, rad. At the motor angle theta the cogging
  /// torque is proportional to -sin(periods_per_turn theta + phase), and the ripple adds
  /// sin(periods_per_turn theta + phase).
  Eigen::Vector3d cogging_phase{0, 0, 0};
  /// Phase of each motor's ripple at joint angle zero, rad.
  Eigen::Vector3d ripple_phase{0, 0, 0};
  /// Inertia of rotor and pulley, kg m^2 at the joint. It makes the mass at the tip depend on the
  /// pose: J^-T diag(inertia) J^-1 is added to the tip's own mass.
  Eigen::Vector3d inertia{0, 0, 0};
  /// Stiffness of the cable, N m/rad at the joint. All > 0, or none.
  Eigen::Vector3d stiffness{0, 0, 0};
  Eigen::Vector3d damping{0, 0, 0};  ///< Damping of the cable, N m s/rad.
  Eigen::Vector3d play{0, 0, 0};     ///< Full width of the backlash, rad at the joint.
  /// Viscous friction of each joint, N m s/rad; with a compliant cable that of the motor side.
  Eigen::Vector3d viscous{0, 0, 0};
  /// Coulomb friction, N m at the joint; with a compliant cable that of the motor side.
  Eigen::Vector3d coulomb{0, 0, 0};
  /// Heating of the motors; by default their torque does not change.
  MotorHeatSettings heat{};

  /// Returns whether the cable is compliant, so that motors and links move separately. Real-time:
  /// safe.
  bool compliant() const noexcept { return !stiffness.isZero(0); }
  /// Returns whether joints that are rigidly connected to their motors have friction. Real-time:
  /// safe.
  bool has_joint_friction() const noexcept {
    return !compliant() && !(viscous.isZero(0) && coulomb.isZero(0));
  }
  /// Former name of `has_joint_friction`.
  [[deprecated("renamed to has_joint_friction")]] bool joints_rub() const noexcept {
    return has_joint_friction();
  }
  /// Returns whether there is anything to simulate. Real-time: safe.
  bool named() const noexcept {
    return current_lag != 0 || !cogging.isZero(0) || !ripple.isZero(0) || periods_per_turn != 0 ||
           !inertia.isZero(0) || compliant() || !damping.isZero(0) || !play.isZero(0) ||
           !viscous.isZero(0) || !coulomb.isZero(0) || heat.named();
  }
};

/// Links of a serial arm in addition to the tip's mass, by all parameters that motion and weight
/// depend on. All zeros: the mass of the arm is at its tip. Angles A, B, C are those of
/// driver::SerialArm. Consider a link of mass m along B, with its centre at s from the shoulder and
/// the inertia I about a perpendicular axis through its centre. It adds m s^2 + I to inertia B and
/// to yaw_b, and m s to moment_b. A link along C hangs on the elbow. It adds m length_b^2 to
/// inertia B and yaw_b, and m s^2 + I to inertia C and yaw_c. It also adds m length_b s to
/// coupling, m length_b to moment_b, and m s to moment_c.
struct LinkSettings {
  /// Inertia about the yaw with both links upright, and about B and C, kg m^2. Includes rotors that
  /// turn with the joints, unless the drive train has them.
  Eigen::Vector3d inertia{0, 0, 0};
  double yaw_b = 0;  ///< Inertia about the yaw proportional to sin^2 B, kg m^2.
  double yaw_c = 0;  ///< Inertia about the yaw proportional to sin^2 C, kg m^2.
  /// Coupling inertia between B and C, proportional to cos(B + C), and about the yaw, proportional
  /// to sin B sin C, kg m^2.
  double coupling = 0;
  double moment_b = 0;  ///< First moment of mass along link B, counterweights negative, kg m.
  double moment_c = 0;  ///< First moment of mass along link C, kg m.
  Eigen::Vector3d gravity_B{0, 0, 0};  ///< Gravity in the base frame, m/s^2.

  /// Returns whether there is anything to simulate. Real-time: safe.
  bool named() const noexcept {
    return !inertia.isZero(0) || yaw_b != 0 || yaw_c != 0 || coupling != 0 || moment_b != 0 ||
           moment_c != 0;
  }
};

/// Wiring of encoders and motors to the board. A correct arm has the defaults; other values are
/// mistakes that a check must find.
struct THIMBLE_EXPORT WiringSettings {
  /// Joint whose encoder is connected to each input of the board.
  std::array<std::uint8_t, 3> encoder_of{0, 1, 2};
  /// Gain of each input: 1 for a correct encoder, -1 for one that counts backwards, 0 for a dead
  /// one.
  Eigen::Vector3d encoder_gain{1, 1, 1};
  /// Joint whose motor is connected to each output of the board.
  std::array<std::uint8_t, 3> motor_of{0, 1, 2};
  /// Gain of each output: 1 for a correct motor, -1 for one with swapped wires, 0 for a dead one.
  Eigen::Vector3d motor_gain{1, 1, 1};

  /// Fails if a joint does not exist or a gain is not finite. Real-time: never from the servo
  /// thread.
  driver::Result<void> check() const;
  /// Converts the encoder counts of the joints into those at the inputs of the board. Real-time:
  /// safe.
  Eigen::Vector3d inputs(const Eigen::Vector3d& counts) const noexcept {
    return {encoder_gain[0] * counts[encoder_of[0]], encoder_gain[1] * counts[encoder_of[1]],
            encoder_gain[2] * counts[encoder_of[2]]};
  }
  /// Converts the currents of the outputs into those of the motors of the joints, A. Real-time:
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

/// Supply and temperature that a simulated board with the reference firmware measures [chosen:
/// those of a sound arm], and its lowest supply [chosen: half of it].
struct BoardHealth {
  std::uint16_t supply_mV = 24'000;   ///< Supply of the motors, mV.
  std::int16_t temperature_dC = 250;  ///< Highest temperature, 0.1 degrees C.
  bool encoder_error = false;         ///< An encoder reports an error.
};
inline constexpr std::uint16_t kReferenceSupplyMin_mV = 12'000;  ///< Lowest supply, mV.

/// Firmware of the board. Sources of the defaults: app/guide/pages/simulated_arm.md.
struct FirmwareSettings {
  std::int64_t report_period_ns = 1'000'000;  ///< Period of the reports, ns.
  /// Time without a message after which the motors are switched off, ns [S, DEVICES 1].
  std::int64_t watchdog_ns = 100'000'000;
  /// Largest current, mA; a larger one is replaced by zero [S, DEVICES 1; the value is a guess].
  std::int16_t current_range_mA = 6000;
  WiringSettings wiring;  ///< Wiring, possibly with dead or swapped lines.
  /// Protocol: kPolhem, kWoody, kHfabLine or kDescribed.
  driver::ArmKind protocol = driver::ArmKind::kPolhem;
  std::int32_t line_model = 1;  ///< Model number of the arm in text lines [S hfabapi].
  /// True for encoders with 65536 times the resolution, below a nanometre at the tip, to measure
  /// the effect of real ones. Their counts fit only into the 14-byte protocol
  /// (hfab::FineReportWire), which then replaces `protocol`, without a gimbal.
  bool ideal_encoders = false;
  /// True for a board that runs the reference firmware (driver/firmware), which then determines the
  /// messages in both directions; `protocol` is the host's description of them.
  bool reference = false;
  /// Runs the reference firmware elsewhere, for example on an emulated processor. Null: in this
  /// process. Not owned; must outlive the arm.
  ReferenceProgram* program = nullptr;
  /// Wire of the protocol kDescribed, otherwise null.
  std::shared_ptr<const driver::WireTable> described{};
  double missed_edges = 0;  ///< Probability that a counter misses a step of its encoder, 0 to 1.
};

/// Connection between host and firmware.
struct WireSettings {
  std::int64_t delay_in_ns = 0;   ///< Delay from sampling a report until the host can read it, ns.
  std::int64_t delay_out_ns = 0;  ///< Delay from the host's write to the motors, ns.
  /// Random addition to either delay, uniform from 0 to this, ns; the order is preserved.
  std::int64_t jitter_ns = 0;
  double loss = 0;  ///< Probability that a report or a message is lost, 0 to below 1.

  /// Returns whether all messages arrive, with constant delay. Real-time: safe.
  bool regular() const noexcept { return jitter_ns == 0 && loss == 0; }
};

/// A complete simulated arm.
struct SimulatedArmSettings {
  PlantSettings plant;                ///< Mass and friction of the arm.
  HandSettings hand;                  ///< Hand that holds the tip.
  MotorSettings motors;               ///< Motors and amplifiers.
  DriveTrainSettings drive_train{};   ///< Drive train between motors and links.
  LinkSettings links{};               ///< Links; serial arms only.
  Eigen::Vector3d weight_B{0, 0, 0};  ///< Weight of the tip in the base frame, N.
  FirmwareSettings firmware;          ///< Firmware of the board.
  WireSettings wire;                  ///< Connection to the host.
  GimbalMotion gimbal;                ///< Motion of the stylus, if a gimbal is mounted.
};

}  // namespace thimble::device_sim
