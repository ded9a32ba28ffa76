#pragma once

#include <stddef.h>
#include <stdint.h>

#include "arm_config.h"
#include "packet.h"

namespace thimble {
namespace firmware {

/// Values that a board measures at the beginning of a loop.
struct Inputs {
  int32_t counts[kMotorsMax] = {};  ///< Raw counts; wrap at 32 bits.
  int16_t gimbal[3] = {};
  uint16_t supply_mV = 0;              ///< 0: not measured.
  int16_t temperature_dC = kNoSensor;  ///< Highest temperature, 0.1 degrees C.
  uint8_t buttons = 0;
  bool encoder_error = false;  ///< A sensor reported an error, or its parity is wrong.
};

/// Values that a board applies to its outputs.
struct Outputs {
  float amperes[kMotorsMax] = {};
  bool motors_on = false;  ///< False: the amplifiers are disabled.
  uint32_t fed_us = 0;     ///< Time of the last message that fed the watchdog, while driving.
};

/// The logic of the firmware, independent of the board. It has no clock and no input or output: its
/// caller passes time, measured values and messages, and applies the outputs after each call.
///
/// The motors are off until a valid drive message requests zero current. A fault switches them off
/// and is latched until a clear message arrives after its cause has ended. Times are in
/// microseconds and wrap at 32 bits.
class Controller {
 public:
  /// `restarted`: the hardware watchdog has restarted the board.
  explicit Controller(const ArmConfig& config, bool restarted = false) noexcept;

  /// Takes a message of the host without its framing. Accepts any bytes. Returns whether the host
  /// asks for the self-description.
  bool receive(const uint8_t* bytes, size_t size, uint32_t now_us) noexcept;

  /// Counts a message that its framing or the bus rejected.
  void refuse() noexcept { ++state_.refused; }

  /// Takes the measured values at the beginning of a loop, and checks them.
  void tick(const Inputs& inputs, uint32_t now_us) noexcept;

  /// Checks the time since the last drive message. Call it in each pass of the main loop.
  void watch(uint32_t now_us) noexcept;

  /// Takes the loss of the link: a reset or suspension of the bus, or an unplugged cable. It is a
  /// fault while driving.
  void lose_link() noexcept;

  /// Takes the duration of a loop, for the reports.
  void loop_took(uint32_t duration_us) noexcept;

  /// Encodes the next state into kStateSize bytes.
  void report(uint8_t* bytes) noexcept;

  /// Encodes the self-description into kDescriptionSize bytes.
  void describe(uint8_t* bytes) const noexcept;

  const Outputs& outputs() const noexcept { return outputs_; }
  Stage stage() const noexcept { return state_.stage; }
  /// Returns the flags of the next state.
  uint16_t flags() const noexcept { return static_cast<uint16_t>(latched_ | causes_ | notes_); }
  /// Returns whether the lamp is lit: it blinks on request, and is lit while driving.
  bool lamp(uint32_t now_us) noexcept;
  const ArmConfig& config() const noexcept { return config_; }

 private:
  void drive(const Command& command, uint32_t now_us) noexcept;
  void set_counters(const Command& command) noexcept;
  void clear() noexcept;
  void switch_off(Stage stage) noexcept;
  void fail(uint16_t flags) noexcept;
  bool over_speed(const Inputs& inputs) noexcept;

  // Speed is measured over this number of loops, so that the steps of a coarse encoder are not
  // taken for speed. [chosen: 8 ms at 1 kHz; at 2000 counts per turn, a step is 0.4 rad/s]
  static constexpr uint8_t kWindow = 8;
  // A loop that begins later than this number of periods is a fault. [chosen: longer than any
  // single interrupt of these boards, shorter than a tenth of the watchdog's time]
  static constexpr uint8_t kLatePeriods = 4;

  ArmConfig config_;
  uint16_t latched_ = 0;  // faults
  uint16_t causes_ = 0;   // causes of faults that exist at present
  uint16_t notes_ = 0;
  State state_;
  Outputs outputs_;
  Inputs inputs_;
  int32_t offset_[kMotorsMax] = {};  // added to the raw counts
  int32_t past_[kWindow][kMotorsMax] = {};
  uint32_t late_us_ = 0, watchdog_us_ = 0;
  float current_max_ = 0;                // A
  uint32_t steps_max_[kMotorsMax] = {};  // counts in a window
  uint8_t newest_ = 0, filled_ = 0;
  uint32_t ticked_us_ = 0, blink_from_us_ = 0, blink_us_ = 0;
  bool ticked_ = false;
};

}  // namespace firmware
}  // namespace thimble
