#include <gtest/gtest.h>

#include "math/tables.h"
#include "support/long_form.h"
#include "unit/driver/math/elementary_functions.h"

#ifdef THIMBLE_MPFR
#include <mpfr.h>

namespace thimble::math {
namespace {

/// A number of MPFR.
class Number {
 public:
  explicit Number(int bits) { mpfr_init2(value_, bits); }
  ~Number() { mpfr_clear(value_); }
  Number(const Number&) = delete;
  Number& operator=(const Number&) = delete;
  operator mpfr_ptr() { return value_; }  // NOLINT

 private:
  mpfr_t value_;
};

/// Returns the double nearest to the true value of the function with this name.
class Nearest {
 public:
  Nearest() {
    mpfr_set_emin(-1073);  // that of a double, including denormal numbers
    mpfr_set_emax(1024);
  }

  double of(const std::string& name, double x, double y) {
    mpfr_set_d(x_, x, MPFR_RNDN);
    mpfr_set_d(y_, y, MPFR_RNDN);
    const int side = rounded(name);
    mpfr_subnormalize(result_, side, MPFR_RNDN);
    return mpfr_get_d(result_, MPFR_RNDN);
  }

 private:
  int rounded(const std::string& name) {
    if (name == "atan2") return mpfr_atan2(result_, x_, y_, MPFR_RNDN);
    if (name == "hypot") return mpfr_hypot(result_, x_, y_, MPFR_RNDN);
    if (name == "pow") return mpfr_pow(result_, x_, y_, MPFR_RNDN);
    using Function = int (*)(mpfr_ptr, mpfr_srcptr, mpfr_rnd_t);
    static const std::pair<const char*, Function> kFunctions[] = {
        {"sin", mpfr_sin},   {"cos", mpfr_cos}, {"tan", mpfr_tan},   {"asin", mpfr_asin},
        {"acos", mpfr_acos}, {"exp", mpfr_exp}, {"exp2", mpfr_exp2}, {"expm1", mpfr_expm1},
        {"tanh", mpfr_tanh}, {"log", mpfr_log}, {"cbrt", mpfr_cbrt}};
    for (const auto& [known, function] : kFunctions) {
      if (name == known) return function(result_, x_, MPFR_RNDN);
    }
    ADD_FAILURE() << name;
    return 0;
  }

  Number x_{53}, y_{53}, result_{53};
};

TEST(ElementaryByMpfr, EveryResultIsTheDoubleNearestToTheTrueValue) {
  Nearest nearest;
  const int count = support::long_form() ? 1'000'000 : 10'000;
  for (const Trial& trial : trials()) {
    support::Random random(2026);
    int wrong = 0;
    for (int i = 0; i < count; ++i) {
      const double x = trial.x(random);
      const double y = trial.y(random);
      const double found = trial.function(x, y);
      const double wanted = nearest.of(trial.name, x, y);
      const bool same = std::bit_cast<std::uint64_t>(found) == std::bit_cast<std::uint64_t>(wanted);
      if (same || (std::isnan(found) && std::isnan(wanted))) continue;
      if (wrong++ == 0) {
        ADD_FAILURE() << std::hexfloat << trial.name << "(" << x << ", " << y << ") = " << found
                      << ", not " << wanted;
      }
    }
    EXPECT_EQ(wrong, 0) << trial.name << ", of " << count;
  }
}

TEST(ElementaryByMpfr, SineAndCosineAreWithinTheirBound) {
  Number x(53), sine(200), cosine(200);
  const auto units = [](Number& value, double found) {
    int exponent = 0;
    std::frexp(mpfr_get_d(value, MPFR_RNDN), &exponent);
    mpfr_sub_d(value, value, found, MPFR_RNDN);
    return std::abs(std::ldexp(mpfr_get_d(value, MPFR_RNDN), 53 - exponent));
  };
  mpfr_set_emin(-4000);
  support::Random random(2027);
  const int count = support::long_form() ? 3'000'000 : 30'000;
  double worst = 0;
  for (const auto& draw : {of_size(-40, 20), of_size(-3, 3)}) {
    for (int i = 0; i < count; ++i) {
      const double angle = draw(random);
      const auto found = sin_cos(angle);
      mpfr_set_d(x, angle, MPFR_RNDN);
      mpfr_sin_cos(sine, cosine, x, MPFR_RNDN);
      worst = std::max({worst, units(sine, found.sine), units(cosine, found.cosine)});
    }
  }
  EXPECT_LT(worst, 1.2);
  EXPECT_GT(worst, 0.5) << "if it were as accurate as sin and cos, it could replace them";
}

TEST(ElementaryByMpfr, QuarterTurnsAreReducedExactly) {
  // The double nearest to a multiple of pi / 2: the remainder is minimal.
  Nearest nearest;
  Number multiple(1200);
  support::Random random(5);
  for (int i = 0; i < 3000; ++i) {
    mpfr_set_emax(4000);
    mpfr_const_pi(multiple, MPFR_RNDN);
    mpfr_mul_d(multiple, multiple, std::floor(random.uniform(1, 0x1p52)), MPFR_RNDN);
    mpfr_mul_2si(multiple, multiple, i % 970 - 52, MPFR_RNDN);
    const double angle = mpfr_get_d(multiple, MPFR_RNDN);
    mpfr_set_emax(1024);
    EXPECT_EQ(sin(angle), nearest.of("sin", angle, 0)) << std::hexfloat << angle;
    EXPECT_EQ(cos(angle), nearest.of("cos", angle, 0)) << std::hexfloat << angle;
  }
  // The worst case of all doubles [Muller].
  const double worst = 0x1.6ac5b262ca1ffp+849;
  EXPECT_EQ(cos(worst), nearest.of("cos", worst, 0));
  EXPECT_EQ(tan(worst), nearest.of("tan", worst, 0));
}

/// Returns whether a constant of two doubles is `number`: the nearest double, and the double
/// nearest to the rest.
void expect_pair(const DoubleDouble& found, Number& number, const std::string& what) {
  const double high = mpfr_get_d(number, MPFR_RNDN);
  EXPECT_EQ(found.hi, high) << what;
  mpfr_sub_d(number, number, high, MPFR_RNDN);
  EXPECT_EQ(found.lo, mpfr_get_d(number, MPFR_RNDN)) << what;
}

TEST(ElementaryByMpfr, TablesMatchTheirDefinitions) {
  mpfr_set_emin(-5000);
  mpfr_set_emax(5000);
  Number x(1500), pi(1500);
  mpfr_const_pi(pi, MPFR_RNDN);
  for (unsigned i = 0; i < 160; ++i) {
    if (i % 64 == 0) continue;  // exactly 0
    mpfr_mul_ui(x, pi, i, MPFR_RNDN);
    mpfr_div_ui(x, x, 64, MPFR_RNDN);
    mpfr_sin(x, x, MPFR_RNDN);
    expect_pair(kSines[i], x, "sine " + std::to_string(i));
  }
  for (unsigned i = 0; i < 64; ++i) {
    mpfr_set_ui(x, i, MPFR_RNDN);
    mpfr_div_ui(x, x, 64, MPFR_RNDN);
    mpfr_exp2(x, x, MPFR_RNDN);
    expect_pair(kPowers[i], x, "power " + std::to_string(i));
  }
  for (unsigned i = 0; i < 9; ++i) {
    mpfr_set_ui(x, i, MPFR_RNDN);
    mpfr_div_ui(x, x, 8, MPFR_RNDN);
    mpfr_atan(x, x, MPFR_RNDN);
    EXPECT_EQ(kArcs[i], mpfr_get_d(x, MPFR_RNDN));
  }
  for (unsigned i = 0; i < 21; ++i) {
    mpfr_fac_ui(x, i, MPFR_RNDN);
    mpfr_ui_div(x, 1, x, MPFR_RNDN);
    expect_pair(kInverseFactorials[i], x, "factorial " + std::to_string(i));
  }
  for (unsigned i = 0; i < 12; ++i) {
    mpfr_set_ui(x, 2 * i + 1, MPFR_RNDN);
    mpfr_ui_div(x, 1, x, MPFR_RNDN);
    expect_pair(kOddInverses[i], x, "odd " + std::to_string(i));
  }
  mpfr_div_ui(x, pi, 64, MPFR_RNDN);
  for (const double part : kSineStep) mpfr_sub_d(x, x, part, MPFR_RNDN);
  EXPECT_LT(std::abs(mpfr_get_d(x, MPFR_RNDN)), 0x1p-230);
  mpfr_const_log2(x, MPFR_RNDN);
  mpfr_div_ui(x, x, 64, MPFR_RNDN);
  for (const double part : kPowerStep) mpfr_sub_d(x, x, part, MPFR_RNDN);
  EXPECT_LT(std::abs(mpfr_get_d(x, MPFR_RNDN)), 0x1p-160);
  mpfr_mul_ui(x, pi, 2, MPFR_RNDN);
  mpfr_ui_div(x, 1, x, MPFR_RNDN);
  for (const std::uint64_t word : kPerTurn) {
    EXPECT_EQ(mpfr_get_uj(x, MPFR_RNDZ), word);
    mpfr_frac(x, x, MPFR_RNDN);
    mpfr_mul_2ui(x, x, 64, MPFR_RNDN);
  }
  mpfr_set(x, pi, MPFR_RNDN);
  expect_pair(kPi, x, "pi");
  mpfr_div_ui(x, pi, 2, MPFR_RNDN);
  expect_pair(kHalfPi, x, "pi / 2");
  mpfr_mul_ui(x, pi, 2, MPFR_RNDN);
  expect_pair(kTwoPi, x, "2 pi");
  mpfr_const_log2(x, MPFR_RNDN);
  expect_pair(kLn2, x, "ln(2)");
}

}  // namespace
}  // namespace thimble::math
#else
TEST(ElementaryByMpfr, EveryResultIsTheDoubleNearestToTheTrueValue) {
  GTEST_SKIP() << "install libmpfr-dev, which computes the true values";
}
#endif
