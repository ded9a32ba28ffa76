#include "thimble/driver/result.h"

#include <gtest/gtest.h>

#include <memory>

namespace thimble::driver {
namespace {

TEST(Result, HoldsAValueOrAnError) {
  const Result<int> good = 3;
  const Result<int> bad = Error{"No arm is plugged in."};
  EXPECT_TRUE(good.ok());
  EXPECT_EQ(*good, 3);
  EXPECT_FALSE(bad.ok());
  EXPECT_EQ(bad.error().message, "No arm is plugged in.");
  EXPECT_THROW((void)bad.value(), std::bad_variant_access);
}

TEST(Result, MovesItsValueOut) {
  Result<std::unique_ptr<int>> result = std::make_unique<int>(7);
  const std::unique_ptr<int> taken = std::move(result).value();
  EXPECT_EQ(*taken, 7);
}

TEST(Result, VoidResultReportsSuccess) {
  EXPECT_TRUE(Result<void>().ok());
  EXPECT_EQ(Result<void>(Error{"It did not."}).error().message, "It did not.");
}

}  // namespace
}  // namespace thimble::driver
