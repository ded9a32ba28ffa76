#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <memory>
#include <new>

#include "run_statistics.h"
#include "trace.h"

namespace {

std::atomic<long> allocations{0};

}  // namespace

// Replaces the program's allocator by one that counts.
void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size > 0 ? size : 1)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace thimble::app {
namespace {

TEST(AllocationCount, SeesAnAllocation) {
  const long before = allocations;
  const auto something = std::make_unique<std::atomic<int>>(1);
  EXPECT_EQ(allocations, before + 1);
}

TEST(Sinks, AllocateNothingPerTick) {
  RunStatistics statistics;
  Trace trace(500, 100);
  driver::TickRecord record;
  const long before = allocations;
  for (int i = 0; i < 1000; ++i) {
    record.time_ns = i * 1'000'000LL + i * i;
    record.work_ns = 7LL * i * i;
    record.in_contact = i % 7 != 0;
    record.f_sent_W = {1.0 * i, 0, 0};
    statistics(record);
    trace(record);
  }
  EXPECT_EQ(allocations, before);
  EXPECT_EQ(statistics.ticks(), 1000U);
}

}  // namespace
}  // namespace thimble::app
