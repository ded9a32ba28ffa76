#include "core/board.h"

#include <string.h>

#include "boards/arm.h"
#include "boards/hid_link.h"
#include "boards/registers.h"
#include "core/counters.h"
#include "core/motor_law.h"

// STM32F405 with a crystal of 8 MHz, at 168 MHz. Loop at 4 kHz, reports at 1 kHz over USB HID at
// full speed (PA11, PA12). Encoders: TIM5 (PA0, PA1), TIM2 (PA15, PB3), TIM3 (PB4, PB5). References
// of current amplifiers: TIM1 (PA8, PA9, PA10), their enabling on PC8. Supply on PC0, NTC on PC1;
// without divider and sensor, connect both to ground. Lamp on PC13. Registers and sections: ST
// RM0090 revision 19; pins: STM32F405 datasheet, table 9.

namespace thimble {
namespace firmware {
namespace {

constexpr uintptr_t kRcc = 0x40023800;                                              // 7.3
constexpr uintptr_t kFlash = 0x40023c00;                                            // 3.9
constexpr uintptr_t kGpioA = 0x40020000, kGpioB = 0x40020400, kGpioC = 0x40020800;  // 8.4
constexpr uintptr_t kTim1 = 0x40010000;                                             // 17.4
constexpr uintptr_t kTim2 = 0x40000000, kTim3 = 0x40000400, kTim5 = 0x40000c00;     // 18.4
constexpr uintptr_t kTim7 = 0x40001400;                                             // 20.4
constexpr uintptr_t kAdc1 = 0x40012000;                                             // 13.13
constexpr uintptr_t kIwdg = 0x40003000;                                             // 21.4
constexpr uintptr_t kUniqueId = 0x1fff7a10;                                         // 39.1

constexpr uintptr_t kMode = 0x00, kSpeed = 0x08, kPull = 0x0c, kSetReset = 0x18, kAlternate = 0x20;
constexpr uintptr_t kCr1 = 0x00, kSmcr = 0x08, kEgr = 0x14, kCcmr1 = 0x18, kCcmr2 = 0x1c;
constexpr uintptr_t kCcer = 0x20, kCount = 0x24, kPrescaler = 0x28, kReload = 0x2c, kCcr1 = 0x34;
constexpr uintptr_t kBdtr = 0x44;

constexpr uint32_t kEnablePin = 8, kLampPin = 13;  // port C
constexpr uint32_t kPwmPeriod = 8400;              // 168 MHz / 8400 = 20 kHz

WideCounter clock_us, third_encoder;
bool restarted_before;

enum PinMode : uint32_t { kInput = 0, kOutput = 1, kAlternateMode = 2, kAnalog = 3 };

void set_pin(uintptr_t port, uint32_t pin, PinMode mode, uint32_t alternate = 0) noexcept {
  set_bits(reg(port, kAlternate + 4 * (pin / 8)), 15u << 4 * (pin % 8), alternate << 4 * (pin % 8));
  set_bits(reg(port, kSpeed), 3u << 2 * pin, 2u << 2 * pin);
  set_bits(reg(port, kMode), 3u << 2 * pin, mode << 2 * pin);
}

void start_clocks() noexcept {
  // Crystal, then PLL: 8 MHz / 8 * 336 / 2 = 168 MHz, / 7 = 48 MHz for USB; buses at 42 and 84 MHz
  // (7.3.1 to 7.3.3).
  reg(kRcc, 0x00) |= 1 << 16;
  while ((reg(kRcc, 0x00) & 1 << 17) == 0) {
  }
  reg(kRcc, 0x04) = 8 | 336 << 6 | 0 << 16 | 1 << 22 | 7 << 24;
  reg(kRcc, 0x00) |= 1 << 24;
  while ((reg(kRcc, 0x00) & 1 << 25) == 0) {
  }
  reg(kFlash, 0x00) = 1 << 10 | 1 << 9 | 1 << 8 | 5;  // caches, prefetch, 5 wait states
  reg(kRcc, 0x08) = 5 << 10 | 4 << 13;
  set_bits(reg(kRcc, 0x08), 3, 2);
  while ((reg(kRcc, 0x08) & 3 << 2) != 2 << 2) {
  }
  reg(kRcc, 0x30) |= 1 << 0 | 1 << 1 | 1 << 2;           // ports A, B, C
  reg(kRcc, 0x40) |= 1 << 0 | 1 << 1 | 1 << 3 | 1 << 5;  // TIM2, TIM3, TIM5, TIM7
  reg(kRcc, 0x44) |= 1 << 0 | 1 << 8;                    // TIM1, ADC1
  reg(kRcc, 0x34) |= 1 << 7;                             // OTG_FS
}

/// Encoder mode 3: both edges of both signals, with a filter of 8 samples (18.3.12).
void start_encoder(uintptr_t timer, uint32_t range) noexcept {
  reg(timer, kReload) = range;
  reg(timer, kCcmr1) = 1 << 0 | 3 << 4 | 1 << 8 | 3 << 12;
  reg(timer, kSmcr) = 3;
  reg(timer, kCr1) = 1;
}

uint32_t convert(uint32_t channel) noexcept {
  reg(kAdc1, 0x34) = channel;
  reg(kAdc1, 0x08) = 1 << 0 | 1 << 30;
  // 15 cycles of sampling and 12 of conversion at 21 MHz: 1.3 us.
  while ((reg(kAdc1, 0x00) & 1 << 1) == 0) {
  }
  return reg(kAdc1, 0x4c);
}

}  // namespace

namespace board {

void start() noexcept {
  restarted_before = (reg(kRcc, 0x74) & 1 << 29) != 0;  // independent watchdog (7.3.21)
  reg(kRcc, 0x74) |= 1 << 24;
  start_clocks();
  // Amplifiers disabled first.
  reg(kGpioC, kSetReset) = 1u << (16 + kEnablePin) | 1u << (16 + kLampPin);
  set_pin(kGpioC, kEnablePin, kOutput);
  set_pin(kGpioC, kLampPin, kOutput);
  // PWM mode 1 on channels 1 to 3 (17.3.10).
  reg(kTim1, kReload) = kPwmPeriod - 1;
  reg(kTim1, kCcmr1) = 6 << 4 | 1 << 3 | 6 << 12 | 1 << 11;
  reg(kTim1, kCcmr2) = 6 << 4 | 1 << 3;
  for (uintptr_t i = 0; i < kMotorsMax; ++i) reg(kTim1, kCcr1 + 4 * i) = kPwmPeriod / 2;
  reg(kTim1, kEgr) = 1;
  reg(kTim1, kCcer) = 1 << 0 | 1 << 4 | 1 << 8;
  reg(kTim1, kBdtr) = 1 << 15;
  reg(kTim1, kCr1) = 1 << 7 | 1;
  for (uint32_t pin = 8; pin <= 10; ++pin) set_pin(kGpioA, pin, kAlternateMode, 1);
  set_pin(kGpioA, 0, kAlternateMode, 2);
  set_pin(kGpioA, 1, kAlternateMode, 2);
  set_pin(kGpioA, 15, kAlternateMode, 1);
  set_pin(kGpioB, 3, kAlternateMode, 1);
  set_pin(kGpioB, 4, kAlternateMode, 2);
  set_pin(kGpioB, 5, kAlternateMode, 2);
  set_bits(reg(kGpioA, kPull), 3u << 30 | 15u, 1u << 30 | 5u);  // pull-ups of the encoders
  set_bits(reg(kGpioB, kPull), 63u << 6, 21u << 6);
  start_encoder(kTim5, 0xffffffff);
  start_encoder(kTim2, 0xffffffff);
  start_encoder(kTim3, 0xffff);
  reg(kTim7, kPrescaler) = 83;  // 84 MHz / 84 = 1 MHz
  reg(kTim7, kReload) = 0xffff;
  reg(kTim7, kEgr) = 1;
  reg(kTim7, kCr1) = 1;
  set_pin(kGpioC, 0, kAnalog);
  set_pin(kGpioC, 1, kAnalog);
  reg(kAdc1, 0x0c) = 1 << 0 | 1 << 3;  // channels 10 and 11 are sampled for 15 cycles
  reg(kAdc1, 0x304) = 1 << 16;         // clock of 84 MHz / 4; 36 MHz are allowed (13.13.16)
  reg(kAdc1, 0x08) = 1;
  set_pin(kGpioA, 11, kAlternateMode, 10);
  set_pin(kGpioA, 12, kAlternateMode, 10);
  // Of 96 bits of the unique number, the position on the wafer and its number.
  hid_link::Board board = {"f405", {}, 4000, 1000};
  memcpy(board.serial, reinterpret_cast<const void*>(kUniqueId), sizeof board.serial);
  hid_link::start(board);
  // Watchdog, after the start of the USB core, which may take 25 ms: 32 kHz / 4, 400 counts: 50 ms
  // (21.3).
  reg(kIwdg, 0x00) = 0xcccc;
  reg(kIwdg, 0x00) = 0x5555;
  reg(kIwdg, 0x04) = 0;
  reg(kIwdg, 0x08) = 400;
}

bool restarted() noexcept {
  return restarted_before;
}

uint32_t now_us() noexcept {
  return static_cast<uint32_t>(clock_us.take(static_cast<uint16_t>(reg(kTim7, kCount))));
}

void sample(Inputs& inputs) noexcept {
  inputs.counts[0] = static_cast<int32_t>(reg(kTim5, kCount));
  inputs.counts[1] = static_cast<int32_t>(reg(kTim2, kCount));
  inputs.counts[2] = third_encoder.take(static_cast<uint16_t>(reg(kTim3, kCount)));
  inputs.supply_mV = supply_mV(convert(10));
  inputs.temperature_dC = ntc_temperature(convert(11));
}

void apply(const Outputs& outputs) noexcept {
  if (!outputs.motors_on) reg(kGpioC, kSetReset) = 1u << (16 + kEnablePin);
  for (size_t i = 0; i < kMotorsMax; ++i) {
    const float share =
        reference_of(outputs.amperes[i], kAmplifierRange, kReferenceLow, kReferenceHigh);
    reg(kTim1, kCcr1 + 4 * i) = static_cast<uint32_t>(share * static_cast<float>(kPwmPeriod));
  }
  if (outputs.motors_on) reg(kGpioC, kSetReset) = 1u << kEnablePin;
}

void lamp(bool lit) noexcept {
  reg(kGpioC, kSetReset) = lit ? 1u << kLampPin : 1u << (16 + kLampPin);
}

void feed_watchdog() noexcept {
  reg(kIwdg, 0x00) = 0xaaaa;
}

}  // namespace board
}  // namespace firmware
}  // namespace thimble
