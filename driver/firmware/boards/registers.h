#pragma once

#include <stdint.h>

namespace thimble {
namespace firmware {

/// Returns a register of 32 bits. Boards state the base addresses and offsets with the section of
/// the reference manual.
inline volatile uint32_t& reg(uintptr_t base, uintptr_t offset = 0) noexcept {
  return *reinterpret_cast<volatile uint32_t*>(base + offset);
}

/// Replaces the bits of `mask` in a register by `value`.
inline void set_bits(volatile uint32_t& target, uint32_t mask, uint32_t value) noexcept {
  target = (target & ~mask) | value;
}

}  // namespace firmware
}  // namespace thimble
