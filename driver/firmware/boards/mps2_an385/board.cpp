#include "boards/plant_link.h"
#include "boards/registers.h"

// MPS2 with the image AN385 (Cortex-M3), as QEMU emulates it (mps2-an385). UART0 leads to the host,
// UART1 to the plant. Addresses: Arm DAI 0385D, table 3-2; registers: Arm DDI 0479D (CMSDK).

namespace thimble {
namespace firmware {
namespace plant_link {
namespace {

// APB UART, DDI 0479D 4.3: DATA, STATE (bit 0: transmitter full, bit 1: receiver full), CTRL (bits
// 0 and 1: enable both, bit 3: interrupt of the receiver), INTCLEAR, BAUDDIV (at least 16).
constexpr uintptr_t kUart[2] = {0x40004000, 0x40005000};
constexpr uintptr_t kData = 0, kState = 4, kCtrl = 8, kIntClear = 12, kBaudDiv = 16;

// Receiver interrupts of UART 0 and 1 (Arm DAI 0385D, table 3-5), in the interrupt controller (Arm
// DDI 0403E, B3.4): set-enable and clear-pending.
constexpr uint32_t kReceiverInterrupts = 1 << 0 | 1 << 2;
constexpr uintptr_t kSetEnable = 0xe000e100, kClearPending = 0xe000e280;

// Watchdog, DDI 0479D 4.5: LOAD, CTRL (bits 0 and 1: interrupt, reset), LOCK.
constexpr uintptr_t kWatchdog = 0x40008000;
constexpr uintptr_t kLoad = 0, kWatchdogCtrl = 8, kLock = 0xc00;
constexpr uint32_t kUnlock = 0x1acce551;
constexpr uint32_t kClock_hz = 25000000;
// It restarts the chip after two periods without feeding. [chosen: 50 ms each, as the wire's own]
constexpr uint32_t kWatchdogLoad = kClock_hz / 20;

// SysTick, Arm DDI 0403E B3.3: control, reload, value; counts down 24 bits.
constexpr uintptr_t kSysTick = 0xe000e010;
uint32_t clock_now, clock_last;

// Is not initialised at a reset, so that it shows whether the firmware ran before. The board's
// register of reset causes is not emulated.
constexpr uint32_t kRan = 0x7468696d;
__attribute__((section(".noinit"))) volatile uint32_t ran;
bool restarted_before;

}  // namespace

void start() noexcept {
  restarted_before = ran == kRan;
  ran = kRan;
  for (const uintptr_t uart : kUart) {
    reg(uart, kBaudDiv) = 16;
    reg(uart, kCtrl) = 1 << 0 | 1 << 1 | 1 << 3;
  }
  reg(kSysTick, 4) = 0xffffff;
  reg(kSysTick, 8) = 0;
  reg(kSysTick, 0) = 5;
  // No handler runs; an interrupt only ends the wait.
  asm volatile("cpsid i");
  reg(kSetEnable) = kReceiverInterrupts;
  reg(kWatchdog, kLock) = kUnlock;
}

void wait() noexcept {
  // The plant's time stands still meanwhile, so the watchdog has its longest period. QEMU 7.2
  // cannot stop it.
  reg(kWatchdog, kLoad) = 0xffffffff;
  if (((reg(kUart[0], kState) | reg(kUart[1], kState)) & 2) == 0) asm volatile("wfi");
  // In this order: a byte that arrives between the two lines becomes pending again.
  reg(kClearPending) = kReceiverInterrupts;
  for (const uintptr_t uart : kUart) reg(uart, kIntClear) = 1 << 1;
  feed();
}

bool get(int port, uint8_t& byte) noexcept {
  if ((reg(kUart[port], kState) & 2) == 0) return false;
  byte = static_cast<uint8_t>(reg(kUart[port], kData));
  return true;
}

void put(int port, uint8_t byte) noexcept {
  while ((reg(kUart[port], kState) & 1) != 0) {
  }
  reg(kUart[port], kData) = byte;
}

uint32_t clock() noexcept {
  // Extended from 24 to 32 bits; called at least once in the 0.67 s after which the value wraps.
  const uint32_t value = reg(kSysTick, 8);
  clock_now += (clock_last - value) & 0xffffff;
  clock_last = value;
  return clock_now;
}

uint32_t clock_hz() noexcept {
  return kClock_hz;
}

void feed() noexcept {
  reg(kWatchdog, kLoad) = kWatchdogLoad;
  reg(kWatchdog, kIntClear) = 1;
  reg(kWatchdog, kWatchdogCtrl) = 3;
}

bool restarted() noexcept {
  return restarted_before;
}

}  // namespace plant_link
}  // namespace firmware
}  // namespace thimble
