#include <string.h>

#include "core/board.h"
#include "core/cobs.h"
#include "core/motor_law.h"
#include "core/serial_link.h"

// Hapkit board: ATmega328P at 16 MHz, one motor on a bridge, an analog magnet sensor, a UART at
// 1 Mbit/s. Registers: Microchip DS40002061B, section 36; interrupts: section 16.1. Pins: PWM on
// PD5, direction on PB0, sensor on ADC2 [S sergiosierram/hapkit_ros]. The board measures neither
// supply nor temperature. Program the fuse of the brown-out detector to 4.3 V (section 11.1): its
// reset switches the motor off.

namespace thimble {
namespace firmware {
namespace {

volatile uint8_t& reg8(uintptr_t address) noexcept {
  return *reinterpret_cast<volatile uint8_t*>(address);
}
volatile uint16_t& reg16(uintptr_t address) noexcept {
  return *reinterpret_cast<volatile uint16_t*>(address);
}

constexpr uintptr_t kPinB = 0x23, kDdrB = 0x24, kPortB = 0x25, kDdrD = 0x2a, kPortD = 0x2b;
constexpr uintptr_t kTimer0CtrlA = 0x44, kTimer0CtrlB = 0x45, kTimer0CompareB = 0x48;
constexpr uintptr_t kMcuStatus = 0x54, kWatchdogTimer = 0x60;
constexpr uintptr_t kTimer1Flags = 0x36, kTimer1Mask = 0x6f, kTimer1CtrlB = 0x81;
constexpr uintptr_t kTimer1Count = 0x84, kTimer1CompareA = 0x88;
constexpr uintptr_t kAdcData = 0x78, kAdcCtrl = 0x7a, kAdcMux = 0x7c;
constexpr uintptr_t kUartStatus = 0xc0, kUartCtrl = 0xc1, kUartFormat = 0xc2, kUartRate = 0xc4,
                    kUartData = 0xc6;

constexpr uint8_t kDirection = 1 << 0;  // PB0
constexpr uint8_t kLamp = 1 << 5;       // PB5
constexpr uint8_t kPwm = 1 << 5;        // PD5

// The sensor repeats after half a turn of its magnet; it then jumps by this number of steps of the
// converter: from 980 to 15 [S sergiosierram/hapkit_ros, OFFSET and OFFSET_NEG].
constexpr int16_t kSensorPeriod = 965;
// Bridge and motor of the kit. [chosen: a motor of 2 ohm on 12 V; measure yours]
constexpr float kResistance = 2, kSupply = 12;
VoltageMotor motor_of_kit() noexcept {
  VoltageMotor motor;
  motor.resistance = kResistance;
  motor.supply = kSupply;
  return motor;
}

// Received bytes, and the frame that is being sent with the next one. A queue of bytes would cost a
// tenth of the processor's time.
ByteQueue<128> received;
FrameReader reader;
struct Frame {
  uint8_t bytes[kFrameMax];
  volatile uint8_t length, sent;
};
Frame frames[2];
Frame* volatile sending = frames;
volatile uint32_t periods_us;  // time of the last tick
uint32_t seen_us;
uint8_t reset_cause __attribute__((section(".noinit")));
int32_t position;
int16_t last_raw;
bool sampled;
float applied;
bool applied_on;

struct Locked {
  Locked() noexcept : status(reg8(0x5f)) { asm volatile("cli" ::: "memory"); }
  ~Locked() {
    asm volatile("" ::: "memory");
    reg8(0x5f) = status;
  }
  const uint8_t status;
};

}  // namespace

// Before the start of C++: the cause of the reset, and the watchdog off, which keeps running after
// its own reset (section 11.3.2).
extern "C" void save_reset_cause() __attribute__((naked, used, section(".init3")));
extern "C" void save_reset_cause() {
  reset_cause = reg8(kMcuStatus);
  reg8(kMcuStatus) = 0;
  reg8(kWatchdogTimer) = 1 << 4 | 1 << 3;
  reg8(kWatchdogTimer) = 0;
}

// Timer 1 compare match A, UART receive complete, UART data register empty.
extern "C" void __vector_11() __attribute__((signal, used));
extern "C" void __vector_11() {
  periods_us += 1000;
}
extern "C" void __vector_18() __attribute__((signal, used));
extern "C" void __vector_18() {
  received.push(reg8(kUartData));
}
extern "C" void __vector_19() __attribute__((signal, used));
extern "C" void __vector_19() {
  Frame* frame = sending;
  const uint8_t at = frame->sent;
  reg8(kUartData) = frame->bytes[at];
  const uint8_t next = static_cast<uint8_t>(at + 1);
  frame->sent = next;
  if (next != frame->length) return;
  frame->length = 0;
  frame = frame == frames ? frames + 1 : frames;
  sending = frame;
  if (frame->length == 0) reg8(kUartCtrl) = static_cast<uint8_t>(reg8(kUartCtrl) & ~(1 << 5));
}

namespace board {

void start() noexcept {
  // Motor off: the pin is a low output until the first PWM.
  reg8(kPortD) = 0;
  reg8(kDdrD) = kPwm;
  reg8(kPortB) = 0;
  reg8(kDdrB) = kDirection | kLamp;
  // Timer 0: fast PWM of 62.5 kHz, output B not connected yet (section 15.9).
  reg8(kTimer0CtrlA) = 3;
  reg8(kTimer0CtrlB) = 1;
  // Timer 1: compare match at 1 kHz, counting at 2 MHz (section 16.11).
  reg16(kTimer1CompareA) = 1999;
  reg8(kTimer1CtrlB) = 1 << 3 | 2;
  reg8(kTimer1Mask) = 1 << 1;
  // Converter: supply as the reference, channel 2, 125 kHz (section 24.9).
  reg8(kAdcMux) = 1 << 6 | 2;
  reg8(kAdcCtrl) = 1 << 7 | 1 << 6 | 7;
  // UART: 1 Mbit/s (double speed, 16 MHz / 8 / 2), 8 bits, receiver with interrupt (section 20.11).
  reg8(kUartStatus) = 1 << 1;
  reg16(kUartRate) = 1;
  reg8(kUartFormat) = 3 << 1;
  reg8(kUartCtrl) = 1 << 7 | 1 << 4 | 1 << 3;
  // Watchdog: restart after 64 ms (section 11.9.2).
  reg8(kWatchdogTimer) = 1 << 4 | 1 << 3;
  reg8(kWatchdogTimer) = 1 << 3 | 2;
  asm volatile("sei");
}

ArmConfig config() noexcept {
  ArmConfig arm;
  arm.motors = 1;
  arm.geometry = Geometry::kPaddle;
  arm.current_max_mA = 1000;
  // Steps of the converter per turn of the magnet, which sits on the motor.
  arm.counts_per_turn[0] = 2 * kSensorPeriod;
  arm.counts_per_turn[1] = arm.counts_per_turn[2] = 0;
  // Sector and drive pulley, 0.074 m and 0.005 m [S sergiosierram/hapkit_ros].
  arm.ratio[0] = 0.074f / 0.005f;
  arm.ratio[1] = arm.ratio[2] = 0;
  memcpy(arm.board, "hapkit", 6);
  return arm;
}

bool restarted() noexcept {
  return (reset_cause & (1 << 3)) != 0;
}

uint32_t now_us() noexcept {
  const Locked locked;
  uint32_t whole = periods_us;
  const uint16_t part = reg16(kTimer1Count);
  // A period may have ended since the interrupts were disabled.
  if ((reg8(kTimer1Flags) & (1 << 1)) != 0 && part < 1000) whole += 1000;
  return whole + part / 2;
}

bool tick_due() noexcept {
  uint32_t now;
  {
    const Locked locked;
    now = periods_us;
  }
  if (now == seen_us) return false;
  seen_us = now;
  return true;
}

void sample(Inputs& inputs) noexcept {
  // The conversion that the previous loop started has ended, and the next one is started.
  const int16_t raw = static_cast<int16_t>(reg16(kAdcData));
  reg8(kAdcCtrl) = static_cast<uint8_t>(reg8(kAdcCtrl) | 1 << 6);
  int16_t step = sampled ? static_cast<int16_t>(raw - last_raw) : int16_t(0);
  if (step > kSensorPeriod / 2) step = static_cast<int16_t>(step - kSensorPeriod);
  if (step < -kSensorPeriod / 2) step = static_cast<int16_t>(step + kSensorPeriod);
  last_raw = raw;
  sampled = true;
  position += step;
  inputs.counts[0] = position;
}

void apply(const Outputs& outputs) noexcept {
  if (outputs.amperes[0] == applied && outputs.motors_on == applied_on) return;
  applied = outputs.amperes[0];
  applied_on = outputs.motors_on;
  const float duty = duty_of(motor_of_kit(), applied, 0);
  const uint8_t level = static_cast<uint8_t>(255.0f * (duty < 0 ? -duty : duty));
  if (!outputs.motors_on || level == 0) {
    // A compare value of zero would still give a short pulse (section 15.7.3).
    reg8(kTimer0CtrlA) = 3;
    return;
  }
  reg8(kPortB) =
      static_cast<uint8_t>(duty < 0 ? reg8(kPortB) | kDirection : reg8(kPortB) & ~kDirection);
  reg8(kTimer0CompareB) = level;
  reg8(kTimer0CtrlA) = 1 << 5 | 3;
}

void lamp(bool lit) noexcept {
  const bool now = (reg8(kPortB) & kLamp) != 0;
  if (now != lit) reg8(kPinB) = kLamp;  // writing a one toggles the pin (section 14.2.2)
}

void feed_watchdog() noexcept {
  asm volatile("wdr");
}

bool connected() noexcept {
  return true;
}

size_t receive(uint8_t* message) noexcept {
  uint8_t byte;
  while (received.pop(byte)) {
    const size_t size = reader.take(byte);
    if (size == 0 || size > kHidReportSize) continue;
    memcpy(message, reader.content(), size);
    return size;
  }
  return 0;
}

namespace {

void transmit(const uint8_t* message, size_t size) noexcept {
  // The frame that is not being sent, unless both are free or both are in use.
  Frame* frame = sending;
  if (frame->length != 0) frame = frame == frames ? frames + 1 : frames;
  if (frame->length != 0) return;
  const uint8_t length = static_cast<uint8_t>(encode_frame(message, size, frame->bytes));
  const Locked locked;
  frame->sent = 0;
  frame->length = length;
  if (sending->length == 0) sending = frame;
  reg8(kUartCtrl) = static_cast<uint8_t>(reg8(kUartCtrl) | 1 << 5);
}

}  // namespace

void send(const uint8_t* state) noexcept {
  transmit(state, kStateSize);
}

void describe(const uint8_t* description) noexcept {
  transmit(description, kDescriptionSize);
}

}  // namespace board
}  // namespace firmware
}  // namespace thimble
