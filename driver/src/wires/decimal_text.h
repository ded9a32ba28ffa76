#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>

namespace thimble::driver {

// Decimal numbers with a fraction in text messages ("-0.250"). Independent of the locale; no
// exponents. Real-time: safe.

/// Powers of ten of at most nine digits.
inline constexpr std::array<double, 10> kPowersOfTen{1e0, 1e1, 1e2, 1e3, 1e4,
                                                     1e5, 1e6, 1e7, 1e8, 1e9};

/// Reads a number of at most nine digits before and nine after the point. Returns the place after
/// it; null if there is none.
inline const char* read_decimal(const char* at, const char* end, double& number) noexcept {
  const bool negative = at != end && *at == '-';
  if (negative) ++at;
  std::int64_t digits = 0;
  int before = 0, after = 0;
  for (; at != end && *at >= '0' && *at <= '9'; ++at) {
    if (++before > 9) return nullptr;
    digits = 10 * digits + (*at - '0');
  }
  if (at != end && *at == '.') {
    for (++at; at != end && *at >= '0' && *at <= '9'; ++at) {
      if (++after > 9) return nullptr;
      digits = 10 * digits + (*at - '0');
    }
  }
  if (before + after == 0) return nullptr;
  const double value = static_cast<double>(digits) / kPowersOfTen[static_cast<std::size_t>(after)];
  number = negative ? -value : value;
  return at;
}

/// Writes a number below 1e9 with `decimals` digits (0 to 9) after the point; returns the place
/// after it. A number for which there is no room is not written.
inline char* write_decimal(char* at, char* end, double number, unsigned decimals) noexcept {
  const double bounded = std::clamp(number, -1e9, 1e9);
  const double scaled = std::abs(bounded) * kPowersOfTen[decimals] + 0.5;
  auto digits = static_cast<std::uint64_t>(scaled);
  constexpr std::ptrdiff_t kLongest = 24;
  if (end - at < kLongest) return at;
  if (number < 0 && digits != 0) *at++ = '-';
  const auto unit = static_cast<std::uint64_t>(kPowersOfTen[decimals]);
  at = std::to_chars(at, end, digits / unit).ptr;
  if (decimals == 0) return at;
  *at++ = '.';
  digits %= unit;
  for (std::uint64_t place = unit / 10; place > 0; place /= 10) {
    *at++ = static_cast<char>('0' + digits / place % 10);
  }
  return at;
}

}  // namespace thimble::driver
