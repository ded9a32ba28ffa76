#pragma once

#include <stdint.h>

#include "boards/registers.h"

namespace thimble {
namespace firmware {

/// Access of a driver to the registers of its chip, and to memory that it shares with a peripheral.
/// A driver has it as a template parameter, so that tests can give it a model of the peripheral.
struct ChipAccess {
  static uint32_t read(uintptr_t address) noexcept { return reg(address); }
  static void write(uintptr_t address, uint32_t value) noexcept { reg(address) = value; }
  /// Returns the address at which a peripheral finds an object in memory.
  static uint32_t bus_address(const volatile void* object) noexcept {
    return static_cast<uint32_t>(reinterpret_cast<uintptr_t>(object));
  }
  /// Completes all writes to memory before the next access to a register (Arm DDI 0403E, A3.7.3).
  static void complete_writes() noexcept { asm volatile("dsb" ::: "memory"); }
  /// Waits until a controller with a slower clock has seen the last write: 12 cycles, which is
  /// enough for one of 48 MHz at 125 MHz [S RP2040 datasheet, 4.1.2.5.1].
  static void wait_cycles() noexcept {
    for (int i = 0; i < 12; ++i) asm volatile("nop");
  }
};

}  // namespace firmware
}  // namespace thimble
