#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace thimble::fuzz {

/// How many things `decode_anything` can try.
inline constexpr unsigned kTargets = 14;

/// Feeds bytes to one of the decoders; the first byte says which. Every decoder must survive any
/// bytes, and what it understood must mean the same after it was encoded again. Answers whether
/// the bytes were understood. Breaks off the process if a promise is broken.
bool decode_anything(std::span<const std::byte> bytes);

}  // namespace thimble::fuzz
