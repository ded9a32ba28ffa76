#include "report/extremes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "support/random.h"

namespace thimble::report {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// Returns the first row with the minimum of a column, by comparing all pairs of rows.
template <std::size_t kColumns>
std::size_t first_extreme(const std::vector<std::array<double, kColumns>>& rows, std::size_t k,
                          double sign) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (std::none_of(rows.begin(), rows.end(),
                     [&](const auto& row) { return sign * row[k] < sign * rows[i][k]; })) {
      return i;
    }
  }
  return rows.size();
}

TEST(Extremes, AreTheFirstRowsOfMinimumAndMaximum) {
  support::Random random(1);
  for (int round = 0; round < 200; ++round) {
    std::vector<std::array<double, 3>> rows(1 + random.bits() % 40);
    Extremes<3> extremes;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      for (double& value : rows[i]) value = std::round(random.uniform(-5, 5));  // many equal values
      extremes.take(rows[i], i);
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t minimum = first_extreme(rows, k, 1), maximum = first_extreme(rows, k, -1);
      EXPECT_EQ(extremes.places()[2 * k], minimum) << round;
      EXPECT_EQ(extremes.places()[2 * k + 1], maximum) << round;
      EXPECT_EQ(extremes.range(k), rows[maximum][k] - rows[minimum][k]) << round;
    }
  }
}

TEST(Extremes, IgnoreNaN) {
  Extremes<1> extremes;
  const std::array<double, 6> values{kNan, 2, kNan, 1, 3, kNan};
  for (std::size_t i = 0; i < values.size(); ++i) extremes.take({values[i]}, i);
  EXPECT_EQ(extremes.places(), (std::array<std::size_t, 2>{3, 4}));
  EXPECT_EQ(extremes.range(0), 2);
}

TEST(Extremes, ForgetRowsWhenCleared) {
  Extremes<1, std::string> extremes;
  extremes.take({-100}, "before");
  extremes.clear();
  extremes.take({1}, "least");
  extremes.take({2}, "most");
  EXPECT_EQ(extremes.places(), (std::array<std::string, 2>{"least", "most"}));
}

}  // namespace
}  // namespace thimble::report
