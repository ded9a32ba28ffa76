#include "observers/trace.h"

#include <gtest/gtest.h>

namespace thimble::session {
namespace {

void run(session::Trace& trace, std::uint64_t ticks) {
  driver::TickRecord record;
  for (record.tick = 0; record.tick < ticks; ++record.tick) trace.take(record);
}

TEST(Trace, KeepsEveryTickOfARunThatFits) {
  session::Trace trace(100, 100);
  run(trace, 100);
  ASSERT_EQ(trace.rows().size(), 100U);
  for (std::size_t i = 0; i < 100; ++i) EXPECT_EQ(trace.rows()[i].tick, i);
  EXPECT_EQ(trace.stride(), 1U);
  EXPECT_EQ(trace.dropped(), 0U);
}

TEST(Trace, KeepsEveryNthTickOfALongRunWithinItsRoom) {
  for (const std::uint64_t ticks : {101U, 199U, 200U, 201U, 1000U, 12345U}) {
    session::Trace trace(ticks, 100);
    run(trace, ticks);
    EXPECT_LE(trace.rows().size(), 100U);
    EXPECT_GT(trace.rows().size(), 100U / 2);
    EXPECT_EQ(trace.dropped(), 0U);
    for (std::size_t i = 0; i < trace.rows().size(); ++i) {
      EXPECT_EQ(trace.rows()[i].tick, i * trace.stride());
    }
  }
}

TEST(Trace, CountsTicksAfterTheExpectedEnd) {
  session::Trace trace(50, 100);
  run(trace, 80);
  EXPECT_EQ(trace.rows().size(), 50U);
  EXPECT_EQ(trace.dropped(), 30U);
}

TEST(Trace, CountsRowsAfterTheEndOfALongRun) {
  session::Trace trace(200, 100);
  run(trace, 300);
  EXPECT_EQ(trace.stride(), 2U);
  EXPECT_EQ(trace.rows().size(), 100U);
  EXPECT_EQ(trace.dropped(), 50U);
}

TEST(Trace, FillsItsRoomWhenTheLengthIsUnknown) {
  session::Trace trace(0, 10);
  run(trace, 25);
  EXPECT_EQ(trace.rows().size(), 10U);
  EXPECT_EQ(trace.dropped(), 15U);
}

}  // namespace
}  // namespace thimble::session
