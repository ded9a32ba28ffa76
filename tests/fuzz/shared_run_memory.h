#pragma once

#include <cstddef>
#include <span>

namespace thimble::fuzz {

/// Damages the memory of a small run as the bytes say, lets a viewer read all of it, and breaks off
/// the process if what it hands out is out of bounds. The first byte: odd, to put the checksum
/// right again, so that what lies behind it is reached. Then any number of: place (4 bytes, through
/// the whole memory), count (1, at most 16), the bytes to put there. Answers whether it was read.
bool read_shared_memory(std::span<const std::byte> bytes);

}  // namespace thimble::fuzz
