#pragma once

#include <cstddef>
#include <span>

namespace thimble::fuzz {

/// Damages the memory of a small run as the bytes specify, lets a viewer read all of it, and aborts
/// the process if a result is out of bounds. The first byte: odd, to correct the checksum, so that
/// the code behind it is reached. Then, repeated: place (4 bytes, over the whole memory), count (1
/// byte, at most 16), the bytes to write there. Returns whether the memory was accepted.
bool read_shared_memory(std::span<const std::byte> bytes);

}  // namespace thimble::fuzz
