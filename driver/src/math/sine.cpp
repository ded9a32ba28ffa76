#include <cmath>

#include "math/elementary.h"
#include "math/wide.h"

namespace thimble::math {
namespace {

/// Error bound of a sine to 61 bits, with a bit in reserve.
constexpr double kSineDoubt = 0x1p-60;

__extension__ using TwoWords = unsigned __int128;

/// An angle as steps of pi / 64 and a remainder of 106 bits.
struct FarAngle {
  std::uint64_t step = 0;
  DoubleDouble rest;
};

FarAngle parts_of(double angle) noexcept {
  const double shifted = angle * 0x1.45f306dc9c883p+4 + kWhole;
  const double steps = shifted - kWhole;
  DoubleDouble rest = exact_sum(angle - steps * kSineStep[0], -(steps * kSineStep[1]));
  for (int i = 2; i < 7; ++i) rest = rest + -(steps * kSineStep[i]);
  return {std::bit_cast<std::uint64_t>(shifted) & 127, rest};
}

/// For an angle beyond `kNearAngle`: 256 bits of 1 / (2 pi), from the first bit whose product with
/// the angle is not an integer number of turns [PayneHanek].
FarAngle parts_of_far(double angle) noexcept {
  const std::uint64_t bits = std::bit_cast<std::uint64_t>(angle);
  const auto exponent = static_cast<int>(bits >> 52 & 2047) - 1075;
  const std::uint64_t mantissa = (bits & 0xfffffffffffff) | 0x10000000000000;
  const auto from = static_cast<unsigned>(exponent + 64);
  std::uint64_t turns[4];
  TwoWords carry = 0;
  for (unsigned i = 4; i-- > 0;) {
    const unsigned word = from / 64 + i, shift = from % 64;
    const std::uint64_t of_table =
        shift == 0 ? kPerTurn[word] : kPerTurn[word] << shift | kPerTurn[word + 1] >> (64 - shift);
    carry += static_cast<TwoWords>(mantissa) * of_table;
    turns[i] = static_cast<std::uint64_t>(carry);
    carry >>= 64;
  }
  const std::uint64_t step = (turns[0] + (std::uint64_t{1} << 56)) >> 57;
  turns[0] -= step << 57;
  // The remainder is below half a step, of either sign.
  const bool less = turns[0] >> 63 != 0;
  if (less) {
    for (std::uint64_t& word : turns) word = ~word;  // 2^-256 of a turn too small
  }
  DoubleDouble rest;
  for (int i = 3; i >= 0; --i) {
    const double unit =
        std::bit_cast<double>(static_cast<std::uint64_t>(1023 - 64 * (i + 1)) << 52);
    const auto upper = static_cast<double>(turns[i] >> 32) * 0x1p32;
    rest = rest + (upper * unit);
    rest = rest + static_cast<double>(turns[i] & 0xffffffff) * unit;
  }
  rest = rest * kTwoPi;
  FarAngle found{step & 127, less ? -rest : rest};
  if (angle < 0) found = {(128 - found.step) & 127, -found.rest};
  return found;
}

DoubleDouble far_sine(std::uint64_t step, DoubleDouble sine, DoubleDouble cosine_less_1) noexcept {
  const DoubleDouble s = kSines[step], c = kSines[step + 32];
  return s + (s * cosine_less_1 + c * sine);
}

/// NaN for infinity and NaN, as in <cmath>.
double no_angle(double angle) noexcept {
  return angle - angle;
}

/// Returns whether `v` rounds to the same double for every relative error of `v` up to `doubt`.
bool is_sure(DoubleDouble v, double doubt) noexcept {
  const double wrong = doubt * v.hi;
  return v.hi + (v.lo - wrong) == v.hi + (v.lo + wrong);
}

}  // namespace

WideSineCosine wide_sine_cosine(double angle) noexcept {
  const FarAngle parts = std::abs(angle) <= kNearAngle ? parts_of(angle) : parts_of_far(angle);
  const DoubleDouble r2 = parts.rest * parts.rest;
  DoubleDouble sine = kInverseFactorials[17], cosine = kInverseFactorials[18];
  for (int n = 15; n >= 3; n -= 2) sine = kInverseFactorials[n] - sine * r2;
  for (int n = 16; n >= 2; n -= 2) cosine = kInverseFactorials[n] - cosine * r2;
  sine = parts.rest - sine * r2 * parts.rest;
  cosine = -(cosine * r2);
  return {far_sine(parts.step, sine, cosine), far_sine((parts.step + 32) & 127, sine, cosine)};
}

WideSineCosine wide_sine_cosine(DoubleDouble angle) noexcept {
  // The second part adds less than 2^-53 of the angle, so its square suffices.
  const auto [sine, cosine] = wide_sine_cosine(angle.hi);
  const DoubleDouble small = {angle.lo, 0}, less = exact_product(angle.lo, -angle.lo / 2);
  return {sine + (cosine * small + sine * less), cosine + (cosine * less - sine * small)};
}

double sin(double angle) noexcept {
  const double size = std::abs(angle);
  if (size <= kNearAngle) {
    if (size <= 0x1p-26) return angle;  // angle^3 / 6 is below half of its last place
    const NearAngle near = near_angle(angle);
    const DoubleDouble sine = near_sine(near.step, near, near_turn(near));
    if (near.good && is_sure(sine, kSineDoubt)) return sine.hi;
  } else if (!std::isfinite(angle)) {
    return no_angle(angle);
  }
  return wide_sine_cosine(angle).sine.hi;
}

double cos(double angle) noexcept {
  const double size = std::abs(angle);
  if (size <= kNearAngle) {
    if (size <= 0x1p-27) return 1;
    const NearAngle near = near_angle(angle);
    const DoubleDouble cosine = near_sine((near.step + 32) & 127, near, near_turn(near));
    if (near.good && is_sure(cosine, kSineDoubt)) return cosine.hi;
  } else if (!std::isfinite(angle)) {
    return no_angle(angle);
  }
  return wide_sine_cosine(angle).cosine.hi;
}

SineCosine sin_cos(double angle) noexcept {
  const double size = std::abs(angle);
  if (size <= kNearAngle) {
    if (size <= 0x1p-27) return {angle, 1};
    const NearAngle near = quick_angle(angle);
    if (near.good) return quick_sine_cosine(near);
  } else if (!std::isfinite(angle)) {
    return {no_angle(angle), no_angle(angle)};
  }
  const WideSineCosine both = wide_sine_cosine(angle);
  return {both.sine.hi, both.cosine.hi};
}

double tan(double angle) noexcept {
  if (std::abs(angle) <= 0x1p-27) return angle;
  if (!std::isfinite(angle)) return no_angle(angle);
  const WideSineCosine both = wide_sine_cosine(angle);
  return (both.sine / both.cosine).hi;
}

}  // namespace thimble::math
