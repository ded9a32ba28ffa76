#pragma once

#include <cstddef>
#include <span>

namespace thimble::driver {

/// Size of a packet of a full-speed FTDI converter, bytes, and of the modem and line status at its
/// beginning [S libnifalcon, libftdi].
inline constexpr std::size_t kFtdiPacketSize = 64;
inline constexpr std::size_t kFtdiStatusSize = 2;

/// Calls `take(std::span<const std::byte>)` with the payload of each packet of a transfer, without
/// status bytes. Total: a packet too short for status bytes has no payload. Real-time: safe if
/// `take` is.
template <class Take>
void for_each_ftdi_packet(std::span<const std::byte> transfer, Take&& take) noexcept {
  while (transfer.size() > kFtdiStatusSize) {
    const std::size_t size = transfer.size() < kFtdiPacketSize ? transfer.size() : kFtdiPacketSize;
    if (size > kFtdiStatusSize) {
      take(transfer.subspan(kFtdiStatusSize, size - kFtdiStatusSize));
    }
    transfer = transfer.subspan(size);
  }
}

}  // namespace thimble::driver
