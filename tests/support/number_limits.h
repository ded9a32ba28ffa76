#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <string>

namespace thimble::support {

/// Limits of a number in a file: `piece` of the file is replaced by `before`, the number and
/// `after`.
struct NumberLimits {
  const char *piece, *before, *after;
  double min, max;
};

/// Expects that a number is accepted at its limits and refused beyond them.
/// `mistake_with(piece, text)` returns the mistakes in the file with this piece replaced.
template <class MistakeWith>
void expect_accepted_up_to_limits(const NumberLimits& key, const MistakeWith& mistake_with) {
  const auto is_refused = [&](double value) {
    std::ostringstream text;
    text.precision(12);
    text << key.before << value << key.after;
    return mistake_with(key.piece, text.str()).find(": expected a number from ") !=
           std::string::npos;
  };
  EXPECT_FALSE(is_refused(key.min)) << key.before << key.min;
  EXPECT_FALSE(is_refused(key.max)) << key.before << key.max;
  EXPECT_TRUE(is_refused(key.min - 1e-6 * std::abs(key.max))) << key.before << " below";
  EXPECT_TRUE(is_refused(key.max + 1e-6 * std::abs(key.max))) << key.before << " above";
}

}  // namespace thimble::support
