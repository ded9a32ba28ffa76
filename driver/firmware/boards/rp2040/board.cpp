#include "core/board.h"

#include "boards/arm.h"
#include "boards/hid_link.h"
#include "boards/rp2040/registers.h"
#include "core/counters.h"
#include "core/motor_law.h"

// RP2040 (Raspberry Pi Pico): USB HID; encoders on GPIO 2 to 7 (A, B of each motor), counted by
// core 1; references of current amplifiers on GPIO 16, 18, 20 (PWM of 20 kHz), their enabling on
// GPIO 22; supply on GPIO 26, NTC on GPIO 27; lamp on GPIO 25. Without the divider and the sensor,
// connect both inputs to ground. The chip has no unique number; set it in kBoard.

namespace thimble {
namespace firmware {
namespace {

constexpr hid_link::Board kBoard = {"rp2040", {0, 0, 0, 0, 0, 0, 0, 1}, 1000, 1000};
constexpr uint32_t kFirstEncoderPin = 2, kEnablePin = 22, kLampPin = 25;
constexpr uint32_t kReferencePin[kMotorsMax] = {16, 18, 20};
constexpr uint32_t kPwmTop = 6249;           // 125 MHz / 6250 = 20 kHz [chosen: above hearing]
constexpr uint32_t kWatchdogLoad = 100'000;  // 50 ms; counts two per us (erratum RP2040-E1)

// Single-cycle input and output (2.3.1.7).
constexpr uintptr_t kGpioIn = 0x04, kOutSet = 0x14, kOutClear = 0x18, kOeSet = 0x24;
constexpr uintptr_t kFifoStatus = 0x50, kFifoWrite = 0x54, kFifoRead = 0x58;

Quadrature encoders[kMotorsMax];  // written by core 1
volatile bool missed_edge;
bool restarted_before;

void select_function(uint32_t pin, uint32_t function) noexcept {
  reg(kPadsBank0, 4 + 4 * pin) = 1 << 6 | 1 << 4;  // input enabled, 4 mA
  reg(kIoBank0, 4 + 8 * pin) = function;
}

void start_pll(uintptr_t pll, uint32_t multiplier, uint32_t divider1, uint32_t divider2) noexcept {
  reg(pll, 0) = 1;
  reg(pll, 8) = multiplier;
  reg(pll + kClearAlias, 4) = 1 << 0 | 1 << 5;  // power, oscillator
  while ((reg(pll, 0) & 1u << 31) == 0) {
  }
  reg(pll, 0x0c) = divider1 << 16 | divider2 << 12;
  reg(pll + kClearAlias, 4) = 1 << 3;
}

void start_clocks() noexcept {
  // Crystal of 12 MHz (2.16.3); the delay is 47 * 256 cycles.
  reg(kXosc, 0x00) = 0xaa0;
  reg(kXosc, 0x0c) = 47;
  reg(kXosc + kSetAlias, 0x00) = 0xfabu << 12;
  while ((reg(kXosc, 0x04) & 1u << 31) == 0) {
  }
  // Reference from the crystal, system clock from it meanwhile (2.15.7).
  reg(kClocks, 0x30) = 2;
  while ((reg(kClocks, 0x38) & 1u << 2) == 0) {
  }
  reg(kClocks, 0x3c) = 0;
  while ((reg(kClocks, 0x44) & 1) == 0) {
  }
  start_pll(kPllSys, 125, 6, 2);  // 1500 MHz / 12 = 125 MHz (2.18.2)
  start_pll(kPllUsb, 100, 5, 5);  // 1200 MHz / 25 = 48 MHz
  reg(kClocks, 0x3c) = 0 << 5;
  reg(kClocks, 0x3c) = 0 << 5 | 1;
  while ((reg(kClocks, 0x44) & 1u << 1) == 0) {
  }
  reg(kClocks, 0x54) = 1u << 11;            // USB from its PLL
  reg(kClocks, 0x60) = 1u << 11;            // converter from it too
  reg(kWatchdogUnit, 0x2c) = 1u << 9 | 12;  // ticks of 1 us for timer and watchdog (4.7.2)
}

/// Program of core 1: samples the encoders as fast as possible. [C: about 60 cycles per pass, so
/// that edges up to 2 MHz are counted]
void count_edges() noexcept {
  for (;;) {
    const uint32_t pins = reg(kSio, kGpioIn) >> kFirstEncoderPin;
    for (uint32_t i = 0; i < kMotorsMax; ++i) {
      const uint32_t ab = pins >> (2 * i);
      if (!encoders[i].take(static_cast<uint8_t>((ab & 1) << 1 | (ab >> 1 & 1)))) {
        missed_edge = true;
      }
    }
  }
}

/// Starts core 1 by the handshake of the ROM (2.8.2).
void start_core1(void (*program)()) noexcept {
  static uint32_t stack[256];
  const uint32_t words[6] = {0,
                             0,
                             1,
                             reg(0xe000ed08),
                             reinterpret_cast<uint32_t>(stack + 256),
                             reinterpret_cast<uint32_t>(program)};
  uint32_t drain = 0;
  for (int i = 0; i < 6;) {
    if (words[i] == 0) {
      while ((reg(kSio, kFifoStatus) & 1) != 0) drain = reg(kSio, kFifoRead);
      asm volatile("sev");
    }
    while ((reg(kSio, kFifoStatus) & 2) == 0) {
    }
    reg(kSio, kFifoWrite) = words[i];
    asm volatile("sev");
    while ((reg(kSio, kFifoStatus) & 1) == 0) asm volatile("wfe");
    i = reg(kSio, kFifoRead) == words[i] ? i + 1 : 0;
  }
  static_cast<void>(drain);
}

uint32_t convert(uint32_t channel) noexcept {
  reg(kAdc, 0) = channel << 12 | 1 << 2 | 1;
  while ((reg(kAdc, 0) & 1u << 8) == 0) {
  }
  return reg(kAdc, 4);
}

void set_reference(uint32_t pin, float share) noexcept {
  // Channel A of the slice of an even pin (4.5.2).
  reg(kPwm, 0x14 * (pin / 2 % 8) + 0x0c) =
      static_cast<uint32_t>(share * static_cast<float>(kPwmTop + 1));
}

}  // namespace

namespace board {

void start() noexcept {
  restarted_before = (reg(kWatchdogUnit, 8) & 1) != 0;  // by its timer
  start_clocks();
  constexpr uint32_t kUnits = 1 << 0 | 1 << 5 | 1 << 8 | 1 << 14 | 1 << 21 | 1 << 24;
  reg(kResets + kClearAlias, 0) = kUnits;
  while ((reg(kResets, 8) & kUnits) != kUnits) {
  }
  // Amplifiers disabled first.
  constexpr uint32_t kOutputs[] = {kEnablePin, kLampPin};
  for (const uint32_t pin : kOutputs) {
    reg(kSio, kOutClear) = 1u << pin;
    reg(kSio, kOeSet) = 1u << pin;
    select_function(pin, 5);
  }
  for (uint32_t pin = kFirstEncoderPin; pin < kFirstEncoderPin + 6; ++pin) {
    select_function(pin, 5);
    reg(kPadsBank0, 4 + 4 * pin) = 1 << 6 | 1 << 3 | 1 << 1;  // pull-up, Schmitt trigger
  }
  for (const uint32_t pin : kReferencePin) {
    const uintptr_t slice = 0x14 * (pin / 2 % 8);
    reg(kPwm, slice + 0x10) = kPwmTop;
    set_reference(pin, 0.5f);
    reg(kPwm, slice) = 1;
    select_function(pin, 4);
  }
  reg(kPadsBank0, 4 + 4 * 26) = 1u << 7;  // analog inputs: no digital output or input
  reg(kPadsBank0, 4 + 4 * 27) = 1u << 7;
  start_core1(count_edges);
  // The watchdog resets all but the oscillators (2.13.5, 4.7.6).
  reg(kPsm, 8) = 0x1fffc;
  reg(kWatchdogUnit, 4) = kWatchdogLoad;
  reg(kWatchdogUnit, 0) = 1u << 30;
  // Afterwards core 1 has seen the first levels of the encoders.
  for (const uint32_t from = now_us(); now_us() - from < 1000;) {
  }
  missed_edge = false;
  hid_link::start(kBoard);
}

bool restarted() noexcept {
  return restarted_before;
}

uint32_t now_us() noexcept {
  return reg(kTimer, 0x28);
}

void sample(Inputs& inputs) noexcept {
  for (size_t i = 0; i < kMotorsMax; ++i) inputs.counts[i] = encoders[i].count();
  inputs.supply_mV = supply_mV(convert(0));
  inputs.temperature_dC = ntc_temperature(convert(1));
  inputs.encoder_error = missed_edge;
  missed_edge = false;
}

void apply(const Outputs& outputs) noexcept {
  if (!outputs.motors_on) reg(kSio, kOutClear) = 1u << kEnablePin;
  for (size_t i = 0; i < kMotorsMax; ++i) {
    set_reference(kReferencePin[i],
                  reference_of(outputs.amperes[i], kAmplifierRange, kReferenceLow, kReferenceHigh));
  }
  if (outputs.motors_on) reg(kSio, kOutSet) = 1u << kEnablePin;
}

void lamp(bool lit) noexcept {
  reg(kSio, lit ? kOutSet : kOutClear) = 1u << kLampPin;
}

void feed_watchdog() noexcept {
  reg(kWatchdogUnit, 4) = kWatchdogLoad;
}

}  // namespace board
}  // namespace firmware
}  // namespace thimble
