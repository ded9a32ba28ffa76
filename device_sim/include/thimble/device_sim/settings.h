#pragma once

#include <cstdint>

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

/// Describes motors and amplifiers.
struct MotorSettings {
  double current_max = 0;  ///< The amplifier saturates here, A. Must be > 0.
};

/// Describes the firmware. Sources of the defaults: device_sim/README.md.
struct FirmwareSettings {
  std::int64_t report_period_ns = 1'000'000;  ///< One report is sampled and sent in each period.
  /// Without a message for this long the motors go off [S, DEVICES 1].
  std::int64_t watchdog_ns = 100'000'000;
  /// A current beyond this counts as zero [S, DEVICES 1; the value is a guess].
  std::int16_t current_range_mA = 6000;
};

/// Describes the way between host and firmware.
struct WireSettings {
  std::int64_t delay_in_ns = 0;   ///< From sampling a report to the host being able to read it.
  std::int64_t delay_out_ns = 0;  ///< From the host's write to the motors.
};

/// Describes a whole simulated arm.
struct SimulatedArmSettings {
  PlantSettings plant;
  HandSettings hand;
  MotorSettings motors;
  FirmwareSettings firmware;
  WireSettings wire;
};

}  // namespace thimble::device_sim
