#include "core/board.h"

#include <string.h>

#include "boards/arm.h"
#include "boards/hid_link.h"
#include "boards/registers.h"
#include "core/counters.h"
#include "core/motor_law.h"

// Teensy 4.0 and 4.1 (i.MX RT1062). Loop and reports at 4 kHz over USB HID at high speed (a hub of
// full speed fetches every fourth report). Encoders: pins 2 and 3, 4 and 33, 30 and 31. References
// of current amplifiers: pins 8, 7, 9; their enabling: pin 10. Supply on pin 14, NTC on pin 15;
// without divider and sensor, connect both to ground. Lamp on pin 13. Registers and sections: NXP
// IMXRT1060RM revision 3. Pins of the encoders: the table of PaulStoffregen's and mjs513's
// libraries [S mjs513/Teensy-4.x-Quad-Encoder-Library QuadEncoder.h].

namespace thimble {
namespace firmware {
namespace {

constexpr uintptr_t kCcm = 0x400fc000;    // 14.7
constexpr uintptr_t kMux = 0x401f8000;    // 11.7
constexpr uintptr_t kGpio2 = 0x401bc000;  // 12.5
constexpr uintptr_t kXbar1 = 0x403bc000;  // 61.4: 16-bit selections
constexpr uintptr_t kEncoderUnit[kMotorsMax] = {0x403c8000, 0x403cc000,
                                                0x403d0000};  // 57.7, 16 bits
constexpr uintptr_t kPwm1 = 0x403dc000, kPwm2 = 0x403e0000;   // 55.8, 16 bits
constexpr uintptr_t kGpt1 = 0x401ec000;                       // 52.7
constexpr uintptr_t kAdc1 = 0x400c4000;                       // 66.8
constexpr uintptr_t kWdog3 = 0x400bc000;                      // 59.8
constexpr uintptr_t kReset = 0x400f8000;                      // 21.8
constexpr uintptr_t kUniqueId = 0x401f4410;                   // fuses, 22.6

constexpr uint32_t kEnablePin = 0, kLampPin = 3;  // port 2
constexpr uint16_t kPwmPeriod =
    6600;  // 20 kHz from a bus clock of 132 MHz; the share is what counts

WideCounter encoders[kMotorsMax];
bool restarted_before;

volatile uint16_t& reg16(uintptr_t base, uintptr_t offset) noexcept {
  return *reinterpret_cast<volatile uint16_t*>(base + offset);
}

/// Selects the function of a pad, by the offset of its register.
void set_pad(uintptr_t offset, uint32_t function) noexcept {
  reg(kMux, offset) = function;
}

/// Starts channel A or B of a PWM submodule, edge-aligned: on from 0 to its value.
void start_pwm(uintptr_t pwm, uintptr_t part) noexcept {
  const uintptr_t base = pwm + 0x60 * part;
  reg16(base, 0x02) = 0;               // INIT
  reg16(base, 0x0e) = kPwmPeriod - 1;  // VAL1
  reg16(base, 0x12) = 0;               // VAL2: A on
  reg16(base, 0x16) = kPwmPeriod / 2;  // VAL3: A off
  reg16(base, 0x1a) = 0;               // VAL4: B on
  reg16(base, 0x1e) = kPwmPeriod / 2;  // VAL5: B off
  reg16(base, 0x04) = 1 << 13;         // CTRL2: A and B are independent
  reg16(base, 0x06) = 1 << 10;         // CTRL: load at each period
  reg16(base, 0x2c) = 0;               // DISMAP0: no fault inputs
}

void set_reference(size_t motor, float share) noexcept {
  static constexpr struct {
    uintptr_t value, master;
    uint16_t load;
  } kOutput[kMotorsMax] = {{kPwm1 + 0x60 * 3 + 0x16, kPwm1 + 0x188, 1 << 3},
                           {kPwm1 + 0x60 * 3 + 0x1e, kPwm1 + 0x188, 1 << 3},
                           {kPwm2 + 0x60 * 2 + 0x1e, kPwm2 + 0x188, 1 << 2}};
  reg16(kOutput[motor].value, 0) = static_cast<uint16_t>(share * static_cast<float>(kPwmPeriod));
  reg16(kOutput[motor].master, 0) =
      static_cast<uint16_t>(reg16(kOutput[motor].master, 0) | kOutput[motor].load);
}

uint32_t convert(uint32_t channel) noexcept {
  reg(kAdc1, 0x00) = channel;
  while ((reg(kAdc1, 0x20) & 1) == 0) {
  }
  return reg(kAdc1, 0x24);
}

}  // namespace

extern "C" void early_start() {
  extern const struct Vectors vectors;
  reg(0xe000ed08) = reinterpret_cast<uintptr_t>(&vectors);
  // Instruction cache, because the image runs from the flash (Arm DDI 0403E, B2.2.7 and B3.2.8).
  reg(0xe000ef50) = 0;
  asm volatile("dsb\n isb" ::: "memory");
  reg(0xe000ed14) |= 1 << 17;
  asm volatile("dsb\n isb" ::: "memory");
}

namespace board {

void start() noexcept {
  restarted_before = (reg(kReset, 0x08) & 1 << 7) != 0;  // watchdog 3
  reg(kReset, 0x08) = 1 << 7;
  for (uintptr_t gate = 0x68; gate <= 0x84; gate += 4) reg(kCcm, gate) = 0xffffffff;
  // Timers from the crystal of 24 MHz (14.7.8).
  set_bits(reg(kCcm, 0x1c), 0x7f, 1 << 6);
  // Amplifiers disabled first.
  reg(kGpio2, 0x88) = 1u << kEnablePin | 1u << kLampPin;
  reg(kGpio2, 0x04) |= 1u << kEnablePin | 1u << kLampPin;
  set_pad(0x13c, 5);  // B0_00, pin 10
  set_pad(0x148, 5);  // B0_03, pin 13
  start_pwm(kPwm1, 3);
  start_pwm(kPwm2, 2);
  reg16(kPwm1, 0x180) = 1 << 11 | 1 << 7;  // OUTEN: A and B of submodule 3
  reg16(kPwm2, 0x180) = 1 << 6;            // B of submodule 2
  reg16(kPwm1, 0x188) = 1 << 11 | 1 << 3;  // MCTRL: run, load
  reg16(kPwm2, 0x188) = 1 << 10 | 1 << 2;
  set_pad(0x17c, 6);  // B1_00, pin 8: FlexPWM1 A3
  set_pad(0x180, 6);  // B1_01, pin 7: FlexPWM1 B3
  set_pad(0x168, 2);  // B0_11, pin 9: FlexPWM2 B2
  // Encoders through the crossbar: pads, the choice among pads, and inputs 66 and 67, 71 and 72, 76
  // and 77 of the crossbar (4.5).
  static constexpr struct {
    uint16_t pad, function, choice, input;
  } kSignal[2 * kMotorsMax] = {{0x24, 3, 0x61c, 6}, {0x28, 3, 0x620, 7},  {0x2c, 3, 0x624, 8},
                               {0x30, 3, 0x628, 9}, {0xa8, 1, 0x63c, 23}, {0xa4, 1, 0x638, 22}};
  for (size_t i = 0; i < 2 * kMotorsMax; ++i) {
    set_pad(kSignal[i].pad, kSignal[i].function);
    reg(kMux, kSignal[i].choice) = 0;
    const size_t output = 66 + 5 * (i / 2) + i % 2;
    const size_t shift = 8 * (output % 2);
    volatile uint16_t& selection = reg16(kXbar1, output / 2 * 2);
    selection = static_cast<uint16_t>((selection & ~(0xffu << shift)) | kSignal[i].input << shift);
  }
  for (const uintptr_t encoder : kEncoderUnit) {
    reg16(encoder, 0x02) = 3 << 8 | 2;  // FILT: 6 samples, every 2 bus clocks
    reg16(encoder, 0x00) = 1 << 11;     // CTRL: load the initial position, zero
  }
  // Time: free-running at 1 MHz.
  reg(kGpt1, 0x04) = 23;
  reg(kGpt1, 0x00) = 1 << 9 | 1 << 6 | 1;
  // Converter: 12 bits, long samples (66.8.6).
  reg(kAdc1, 0x44) = 2 << 2 | 1 << 4 | 1 << 5;
  // Watchdog 3 at 32 kHz: 50 ms (59.7.2).
  reg(kWdog3, 0x04) = 0xd928c520;
  reg(kWdog3, 0x08) = 1638;
  reg(kWdog3, 0x00) = 1 << 13 | 1 << 8 | 1 << 7 | 1 << 5;
  hid_link::Board board = {"teensy", {}, 4000, 4000};
  const uint32_t words[2] = {reg(kUniqueId), reg(kUniqueId, 0x10)};
  memcpy(board.serial, words, sizeof board.serial);
  hid_link::start(board);
}

bool restarted() noexcept {
  return restarted_before;
}

uint32_t now_us() noexcept {
  return reg(kGpt1, 0x24);
}

void sample(Inputs& inputs) noexcept {
  // The lower half of the position; at 4 kHz it moves far less than half its range.
  for (size_t i = 0; i < kMotorsMax; ++i) {
    inputs.counts[i] = encoders[i].take(reg16(kEncoderUnit[i], 0x10));
  }
  inputs.supply_mV = supply_mV(convert(7));
  inputs.temperature_dC = ntc_temperature(convert(8));
}

void apply(const Outputs& outputs) noexcept {
  if (!outputs.motors_on) reg(kGpio2, 0x88) = 1u << kEnablePin;
  for (size_t i = 0; i < kMotorsMax; ++i) {
    set_reference(i,
                  reference_of(outputs.amperes[i], kAmplifierRange, kReferenceLow, kReferenceHigh));
  }
  if (outputs.motors_on) reg(kGpio2, 0x84) = 1u << kEnablePin;
}

void lamp(bool lit) noexcept {
  reg(kGpio2, lit ? 0x84 : 0x88) = 1u << kLampPin;
}

void feed_watchdog() noexcept {
  reg(kWdog3, 0x04) = 0xb480a602;
}

}  // namespace board
}  // namespace firmware
}  // namespace thimble
