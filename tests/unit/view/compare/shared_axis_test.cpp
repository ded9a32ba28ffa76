#include "view/compare/shared_axis.h"

#include <gtest/gtest.h>

namespace thimble::view {
namespace {

/// Recordings of 2 s and 3 s, on clocks that began long ago.
SharedAxis two() {
  SharedAxis axis;
  axis.add_run({10, 12});
  axis.add_run({100.5, 103.5});
  return axis;
}

TEST(SharedAxis, BeginsWithEachFirstTickAndEndsWithTheLongest) {
  SharedAxis axis = two();
  EXPECT_EQ(axis.span().begin, 0);
  EXPECT_EQ(axis.span().end, 3);
  EXPECT_EQ(axis.longest(), 1U);
  axis.add_signal(2.5);
  EXPECT_EQ(axis.span().end, 3);
  axis.add_signal(7);
  EXPECT_EQ(axis.span().end, 7);
  EXPECT_EQ(axis.longest(), 1U);
}

TEST(SharedAxis, ShorterRecordingStandsAtItsEnd) {
  const SharedAxis axis = two();
  EXPECT_EQ(axis.time_in(0, 0.5), 10.5);
  EXPECT_EQ(axis.time_in(1, 0.5), 101);
  EXPECT_FALSE(axis.has_ended(0, 2));
  EXPECT_TRUE(axis.has_ended(0, 2.001));
  EXPECT_EQ(axis.time_in(0, 2.5), 12);
  EXPECT_FALSE(axis.has_ended(1, 2.5));
  EXPECT_FALSE(axis.has_ended(1, axis.span().end));
}

TEST(SharedAxis, ConvertsBothWays) {
  const SharedAxis axis = two();
  for (const double time : {0.0, 0.25, 1.75}) {
    for (std::size_t run = 0; run < axis.runs(); ++run) {
      EXPECT_DOUBLE_EQ(axis.time_of(run, axis.time_in(run, time)), time);
    }
  }
}

}  // namespace
}  // namespace thimble::view
