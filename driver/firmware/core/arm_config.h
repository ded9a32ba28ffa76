#pragma once

#include <stddef.h>
#include <stdint.h>

namespace thimble {
namespace firmware {

/// Largest number of motors of an arm.
constexpr size_t kMotorsMax = 3;

/// Geometry of an arm, as in its self-description. The firmware does not use it.
enum class Geometry : uint8_t {
  kSerial = 0,
  kLinkage = 1,
  kDelta = 2,
  kPaddle = 3,
  kFiveBar = 4,
  kCartesian = 5,
};

/// Data of the arm that a board drives: its limits, and what it reports of itself. The defaults are
/// those of boards/arm.h; a maker changes them there.
struct ArmConfig {
  uint8_t motors = 3;
  Geometry geometry = Geometry::kSerial;
  uint8_t serial[8] = {};      ///< Serial number of the chip.
  uint32_t arm_file_hash = 0;  ///< Hash of the arm file; 0: not known.
  uint16_t watchdog_ms = 50;  ///< [chosen: 50 ticks; half of what published boards have, DEVICES 1]
  uint16_t loop_hz = 1000;    ///< [chosen: a frame of full-speed USB]
  uint16_t report_hz = 1000;  ///< Divides loop_hz.
  uint16_t current_max_mA = 1000;  ///< [chosen: small; each arm sets its own]
  /// Largest speed of a motor, 0.1 rad/s; 0: not limited. [chosen: 400 rad/s, 3820 turns per
  /// minute; with a ratio of 12 and 0.2 m of arm, the tip moves at 6.7 m/s, faster than any hand]
  uint16_t speed_max = 4000;
  int16_t temperature_max_dC = 800;  ///< 0.1 degrees C [chosen: below the 155 of winding class F]
  uint16_t supply_min_mV = 0;        ///< mV; 0: no limit.
  uint32_t counts_per_turn[kMotorsMax] = {2000, 2000, 2000};
  float ratio[kMotorsMax] = {1, 1, 1};  ///< Turns of the motor per turn of the joint.
  char board[6] = {};                   ///< Name of the board, padded with zeros.
};

}  // namespace firmware
}  // namespace thimble
