#include <gtest/gtest.h>

#include "observers/trace.h"
#include "support/heap_guard.h"
#include "thimble/session/run_statistics.h"

namespace thimble::app {
namespace {

TEST(Sinks, AllocateNothingPerTick) {
  session::RunStatistics statistics;
  session::Trace trace(500, 100);
  driver::TickRecord record;
  EXPECT_EQ(support::heap_calls_of([&] {
              for (int i = 0; i < 1000; ++i) {
                record.time_ns = i * 1'000'000LL + i * i;
                record.work_ns = 7LL * i * i;
                record.in_contact = i % 7 != 0;
                record.f_sent_W = {1.0 * i, 0, 0};
                statistics.take(record);
                trace.take(record);
              }
            }),
            0);
  EXPECT_EQ(statistics.ticks(), 1000U);
}

}  // namespace
}  // namespace thimble::app
