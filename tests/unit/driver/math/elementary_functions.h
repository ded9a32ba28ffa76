#pragma once

#include <bit>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "math/elementary.h"
#include "support/random.h"

namespace thimble::math {

/// A function under test with a generator of its arguments; a function of one argument uses the
/// first.
struct Trial {
  std::string name;
  std::function<double(double, double)> function;
  std::function<double(support::Random&)> x, y;
  std::uint64_t hash;  ///< Hash of the results for 20,000 arguments.
};

inline auto between(double low, double high) {
  return [=](support::Random& random) { return random.uniform(low, high); };
}

/// Draws every exponent equally often, with either sign.
inline auto of_size(double low, double high) {
  return [=](support::Random& random) {
    const double power = random.uniform(low, high);
    const double part = random.uniform(1, 2);
    const double sign = (random.bits() & 1) != 0 ? 1 : -1;
    return sign * std::ldexp(part, static_cast<int>(std::floor(power)));
  };
}

/// Draws any 64 bits, including NaN and denormal numbers.
inline double any_bits(support::Random& random) {
  return std::bit_cast<double>(random.bits());
}

inline double positive_bits(support::Random& random) {
  return std::abs(any_bits(random));
}

inline double near_1(support::Random& random) {
  return 1 + of_size(-52, -4)(random);
}

inline double just_below_1(support::Random& random) {
  return 1 - std::abs(of_size(-53, -2)(random));
}

/// Every function over the arguments of a simulation, over all magnitudes, and in difficult ranges.
inline std::vector<Trial> trials() {
  const auto one = [](double (*f)(double)) { return [f](double x, double) { return f(x); }; };
  const auto none = between(0, 0);
  return {
      {"sin", one(sin), between(-7, 7), none, 0x4d49d8b6fcd76135},
      {"sin", one(sin), of_size(-1074, 1024), none, 0xd80ad604f3350f8d},
      {"cos", one(cos), between(-7, 7), none, 0x8eb4a64972ed6c2},
      {"cos", one(cos), of_size(-1074, 1024), none, 0x7ec13492eba57c72},
      {"tan", one(tan), between(-7, 7), none, 0x97e25a4e9ef1cf1d},
      {"tan", one(tan), any_bits, none, 0x75afcb91bb0d41dd},
      {"asin", one(asin), between(-1, 1), none, 0x6be0c5fcfc88c1f0},
      {"asin", one(asin), of_size(-80, 1), none, 0x89bc6291d989f0c2},
      {"asin", one(asin), just_below_1, none, 0xcc1c38127186ed3b},
      {"acos", one(acos), between(-1, 1), none, 0x7a2b85cf7d95515a},
      {"acos", one(acos), of_size(-80, 1), none, 0x7b3c827ce8cb79ae},
      {"acos", one(acos), just_below_1, none, 0x6cff33b63ae3979f},
      {"atan2", atan2, between(-1, 1), between(-1, 1), 0x94ff5c8e0e02da91},
      {"atan2", atan2, of_size(-1074, 1024), of_size(-1074, 1024), 0x3660435ee903b961},
      {"atan2", atan2, of_size(-35, 35), of_size(-35, 35), 0xf9204deb14573b1e},
      {"atan2", atan2, of_size(-1074, -1015), of_size(-1074, -1015), 0x6f7d756064d0fe1e},
      {"exp", one(exp), between(-20, 20), none, 0x6b6558e59e565699},
      {"exp", one(exp), of_size(-60, 11), none, 0x7bd00b8983ae80db},
      {"exp", one(exp), between(-746, -707), none, 0x1905b1b2bacc404f},
      {"exp2", one(exp2), between(-1080, 1030), none, 0x9ef5c18578658103},
      {"exp2", one(exp2), of_size(-60, 3), none, 0x43984d1b1001cf8d},
      {"expm1", one(expm1), between(-3, 3), none, 0x6590121d05db50af},
      {"expm1", one(expm1), of_size(-70, 11), none, 0x40e10acb35ce6aa5},
      {"tanh", one(tanh), of_size(-70, 6), none, 0x3d297d3869e4a7dd},
      {"log", one(log), positive_bits, none, 0x962f53b5a22c9817},
      {"log", one(log), near_1, none, 0x29e9644f96724554},
      {"log", one(log), between(0.25, 4), none, 0x9b91c68b1a3823e4},
      {"pow", pow, between(0, 10), between(-10, 10), 0x8e4d9c5a93743933},
      {"pow", pow, positive_bits, of_size(-12, 8), 0xe411416d9999b1fb},
      {"hypot", hypot, between(-1, 1), between(-1, 1), 0x445c0f7806107739},
      {"hypot", hypot, of_size(-30, 30), of_size(-30, 30), 0xa1355303ff5aa27f},
      {"hypot", hypot, of_size(-1074, -1015), of_size(-1074, -1015), 0x89997dfce0f6215},
      {"hypot", hypot, any_bits, any_bits, 0xcd41a6098efbb3e0},
      {"cbrt", one(cbrt), between(-8, 8), none, 0x6fe1a56b1731bcbf},
      {"cbrt", one(cbrt), any_bits, none, 0x229dbd09225d3818},
  };
}

}  // namespace thimble::math
