#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "wires/wire_description.h"

namespace thimble::driver {

/// Computes check values of messages. Real-time: safe after construction.
class WireChecksum {
 public:
  WireChecksum() = default;

  /// Constructs the table of a CRC. `rule` must be checked (compile_wire).
  explicit WireChecksum(const WireCheckText& rule) noexcept
      : kind_(rule.kind),
        bits_(static_cast<unsigned>(8 * rule.bytes())),
        mask_(bits_ >= 32 ? 0xffffffffU : (1U << bits_) - 1),
        initial_(rule.initial),
        final_(rule.final_xor),
        reflected_(rule.reflected) {
    if (kind_ < WireCheck::kCrc8) return;
    std::uint32_t polynomial = rule.polynomial;
    if (reflected_) {
      polynomial = 0;
      for (unsigned i = 0; i < bits_; ++i) {
        if (((rule.polynomial >> i) & 1U) != 0) polynomial |= 1U << (bits_ - 1 - i);
      }
    }
    for (std::uint32_t byte = 0; byte < table_.size(); ++byte) {
      std::uint32_t value = reflected_ ? byte : byte << (bits_ - 8);
      for (int i = 0; i < 8; ++i) {
        const bool carry = reflected_ ? (value & 1U) != 0 : ((value >> (bits_ - 1)) & 1U) != 0;
        value = reflected_ ? value >> 1 : value << 1;
        if (carry) value ^= polynomial;
      }
      table_[byte] = value & mask_;
    }
  }

  /// Returns the check value of bytes.
  std::uint32_t of(std::span<const std::byte> bytes) const noexcept {
    std::uint32_t value = initial_;
    switch (kind_) {
      case WireCheck::kNone:
        return 0;
      case WireCheck::kSum8:
        for (const std::byte byte : bytes) value += std::to_integer<std::uint32_t>(byte);
        break;
      case WireCheck::kXor8:
        for (const std::byte byte : bytes) value ^= std::to_integer<std::uint32_t>(byte);
        break;
      case WireCheck::kCrc8:
      case WireCheck::kCrc16:
      case WireCheck::kCrc32:
        if (reflected_) {
          for (const std::byte byte : bytes) {
            value = (value >> 8) ^ table_[(value ^ std::to_integer<std::uint32_t>(byte)) & 0xffU];
          }
        } else {
          const unsigned shift = bits_ - 8;
          for (const std::byte byte : bytes) {
            value = (value << 8) ^
                    table_[((value >> shift) ^ std::to_integer<std::uint32_t>(byte)) & 0xffU];
          }
        }
        break;
    }
    return (value ^ final_) & mask_;
  }

 private:
  WireCheck kind_ = WireCheck::kNone;
  unsigned bits_ = 0;
  std::uint32_t mask_ = 0, initial_ = 0, final_ = 0;
  bool reflected_ = false;
  std::array<std::uint32_t, 256> table_{};
};

}  // namespace thimble::driver
