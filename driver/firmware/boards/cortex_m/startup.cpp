#include <stddef.h>
#include <stdint.h>
#include <string.h>

// Start of a Cortex-M processor: vector table, memory, constructors, main. The linker script of the
// board defines the symbols.

extern "C" {
extern uint32_t stack_top[], data_begin[], data_end[], data_source[], bss_begin[], bss_end[];
extern void (*init_begin[])(), (*init_end[])();
[[noreturn]] void reset_handler();
[[noreturn]] void fault_handler();
int main();
}

// Called at the very beginning, before memory is initialised: switches the motors off and sets up
// clocks that the memory needs. A board may leave it out.
extern "C" void early_start() __attribute__((weak));
extern "C" void early_start() {}

// An unexpected exception: restart, so that the pins of the amplifiers return to their reset state.
// Application Interrupt and Reset Control Register, key 0x05fa, SYSRESETREQ [S Arm DDI 0403E,
// B3.2.6].
extern "C" void fault_handler() {
  *reinterpret_cast<volatile uint32_t*>(0xe000ed0c) = 0x05fa0004;
  for (;;) {
  }
}

// The interrupt that cannot be disabled, for a board whose watchdog warns by it.
extern "C" void warning_handler() __attribute__((weak));
extern "C" void warning_handler() {
  fault_handler();
}

extern "C" void reset_handler() {
#ifdef __ARM_FP
  // Access to the floating-point unit (Arm DDI 0403E, B3.2.20).
  *reinterpret_cast<volatile uint32_t*>(0xe000ed88) |= 0xfu << 20;
  asm volatile("dsb\n isb" ::: "memory");
#endif
  early_start();
  memcpy(
      data_begin, data_source,
      static_cast<size_t>(reinterpret_cast<char*>(data_end) - reinterpret_cast<char*>(data_begin)));
  memset(
      bss_begin, 0,
      static_cast<size_t>(reinterpret_cast<char*>(bss_end) - reinterpret_cast<char*>(bss_begin)));
  for (auto constructor = init_begin; constructor != init_end; ++constructor) (*constructor)();
  main();
  fault_handler();
}

// Interrupts of peripherals, for a board that enables some.
extern "C" void interrupt_handler() __attribute__((weak));
extern "C" void interrupt_handler() {
  fault_handler();
}

// Stack pointer, 15 system exceptions [S Arm DDI 0403E, B1.5.3], and the interrupts of the chip,
// all of which lead to one function.
#define THIMBLE_FOUR_INTERRUPTS \
  interrupt_handler, interrupt_handler, interrupt_handler, interrupt_handler
#define THIMBLE_INTERRUPTS_16 \
  THIMBLE_FOUR_INTERRUPTS, THIMBLE_FOUR_INTERRUPTS, THIMBLE_FOUR_INTERRUPTS, THIMBLE_FOUR_INTERRUPTS
using Handler = void (*)();
struct Vectors {
  uint32_t* stack;
  Handler handlers[15 + 48];
};
extern "C" const Vectors vectors;
__attribute__((section(".vectors"), used)) const Vectors vectors = {
    stack_top,
    {reset_handler, warning_handler, fault_handler, fault_handler, fault_handler, fault_handler,
     nullptr, nullptr, nullptr, nullptr, fault_handler, fault_handler, nullptr, fault_handler,
     fault_handler, THIMBLE_INTERRUPTS_16, THIMBLE_INTERRUPTS_16, THIMBLE_INTERRUPTS_16}};
