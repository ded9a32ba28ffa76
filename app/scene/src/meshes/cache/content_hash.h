#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>

#include "thimble/driver/export.h"

namespace thimble::scene {

/// Hash of the contents of a file: its size, and two polynomials modulo the prime 2^61 - 1.
///
/// The bytes are words of 7 bytes, the coefficients of a polynomial; a sum is its value at a
/// constant. Two different files of n bytes have the same value at no more than n/7 of the 2^61
/// constants. So for files that do not depend on the two constants, both sums are equal with a
/// probability of at most (n / 7 / 2^61)^2: 2^-77 at 38 MB, 2^-63 at 4 GiB, the largest mesh file.
/// Not cryptographic: a file can be made on purpose that has the hash of another.
struct ContentHash {
  std::uint64_t bytes = 0;
  std::array<std::uint64_t, 2> sums{};
  bool operator==(const ContentHash&) const = default;
};

/// Returns the hash of a regular file; none if it cannot be read. 10 ms for 38 MB [measured].
/// Real-time: never from the servo thread.
THIMBLE_EXPORT std::optional<ContentHash> content_hash(const std::filesystem::path& file);

}  // namespace thimble::scene
