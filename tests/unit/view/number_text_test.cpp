#include "view/number_text.h"

#include <gtest/gtest.h>

#include <limits>

namespace thimble::view {
namespace {

TEST(NumberText, HasConstantWidth) {
  for (const double force : {0.0, 1e-5, 0.0042, 0.0999, 0.1, 1.234, -7.5, 99.99}) {
    EXPECT_EQ(force_text(force).size(), 9U) << force;
    EXPECT_EQ(length_text(force * 1e-2).size(), 9U) << force;
  }
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(force_text(kNone).size(), 9U);
  EXPECT_EQ(length_text(-std::numeric_limits<double>::infinity()).size(), 9U);
}

TEST(NumberText, HasAReadableUnit) {
  EXPECT_EQ(length_text(0.00234), "  2.34 mm");
  EXPECT_EQ(length_text(0.0000123), "  12.3 um");
  EXPECT_EQ(length_text(0), "  0.00 mm");
  EXPECT_EQ(force_text(1.5), "  1.50 N ");
  EXPECT_EQ(force_text(-0.0421), " -42.1 mN");
  EXPECT_EQ(plain_force(0.05), "50 mN");
  EXPECT_EQ(plain_force(2), "2 N");
  EXPECT_STREQ(read_unit("m", 5e-4).name, "um");
  EXPECT_STREQ(read_unit("m", 0.1).name, "mm");
  EXPECT_STREQ(read_unit("N", 0.05).name, "mN");
  EXPECT_EQ(read_unit("N/m", 1e-4).name, nullptr);
}

}  // namespace
}  // namespace thimble::view
