#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace thimble::fuzz {

/// Number of targets of `decode_anything`.
inline constexpr unsigned kTargets = 16;

/// Feeds bytes to one of the decoders; the first byte selects it. Every decoder must survive any
/// bytes, and an accepted message must have the same meaning after it was encoded again. Returns
/// whether the bytes were accepted. Aborts the process if a check fails.
bool decode_anything(std::span<const std::byte> bytes);

}  // namespace thimble::fuzz
