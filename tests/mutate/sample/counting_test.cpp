#include "counting/counting.h"

#include <gtest/gtest.h>

TEST(Counting, StaysWithinTheBound) {
  EXPECT_EQ(limited(3, 5), 3);
  EXPECT_EQ(limited(7, 5), 5);
}

TEST(Counting, CountsToN) {
  EXPECT_EQ(counted(4), 4);
  EXPECT_EQ(counted(0), 0);
}

TEST(Counting, ReturnsTheLength) {
  const char text[] = "four";
  EXPECT_EQ(length(text, text + 4), 4);
}

TEST(Counting, IsCalled) {
  doubled(2);
}
