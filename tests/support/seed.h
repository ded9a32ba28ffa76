#pragma once

#include <charconv>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <random>
#include <string_view>

#include "support/long_form.h"

namespace thimble::support {

/// Returns the value of THIMBLE_SEED; nothing if it is not set. A text that is not a whole number
/// ends the test program, because it must not pass for a repetition.
inline std::optional<std::uint64_t> asked_seed() {
  const char* const asked = std::getenv("THIMBLE_SEED");
  if (asked == nullptr || *asked == 0) return {};
  const std::string_view text(asked);
  std::uint64_t seed = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
  if (error == std::errc() && end == text.data() + text.size()) return seed;
  std::fprintf(stderr, "THIMBLE_SEED: expected a whole number, found \"%s\".\n", asked);
  std::exit(2);
}

/// Returns a seed that depends on both numbers (splitmix64 [S Steele, Lea, Flood 2014]).
constexpr std::uint64_t mixed_seed(std::uint64_t run, std::uint64_t fixed) {
  std::uint64_t z = fixed + (run + 1) * 0x9e3779b97f4a7c15U;
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
  return z ^ (z >> 31U);
}

/// Returns the seed of random cases. In the short form of the tests it is `fixed`. In the long form
/// (THIMBLE_LONG=1) it depends on `fixed` and on a number that each run of a test program draws and
/// prints. THIMBLE_SEED sets that number in both forms, and so repeats the cases.
inline std::uint64_t seed_of(std::uint64_t fixed) {
  static const std::optional<std::uint64_t> run = []() -> std::optional<std::uint64_t> {
    std::optional<std::uint64_t> number = asked_seed();
    if (!number && long_form()) number = std::random_device()();
    if (number) {
      // Printed before the cases run, so that a crash or a time limit cannot hide it.
      std::fprintf(stderr, "Random cases: THIMBLE_SEED=%llu repeats them.\n",
                   static_cast<unsigned long long>(*number));
    }
    return number;
  }();
  return run ? mixed_seed(*run, fixed) : fixed;
}

}  // namespace thimble::support
