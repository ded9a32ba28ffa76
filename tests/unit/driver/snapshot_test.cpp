#include "thimble/driver/snapshot.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

namespace thimble::driver {
namespace {

/// A value whose parts must agree, so that a torn read is detected.
struct Value {
  std::uint64_t number = 0;
  std::array<std::uint64_t, 40> copies{};
  std::uint32_t odd_size = 0;
};

Value value_of(std::uint64_t number) {
  Value value{.number = number, .copies = {}, .odd_size = static_cast<std::uint32_t>(number)};
  value.copies.fill(~number);
  return value;
}

bool whole(const Value& value) {
  for (const auto copy : value.copies) {
    if (copy != ~value.number) return false;
  }
  return value.odd_size == static_cast<std::uint32_t>(value.number);
}

TEST(Snapshot, IsEmptyBeforeTheFirstStore) {
  Snapshot<Value> snapshot;
  Value value = value_of(5);
  EXPECT_FALSE(snapshot.load(value));
  EXPECT_EQ(value.number, 5u);
}

TEST(Snapshot, ShowsTheNewestValue) {
  Snapshot<Value> snapshot;
  snapshot.store(value_of(1));
  snapshot.store(value_of(2));
  Value value;
  ASSERT_TRUE(snapshot.load(value));
  EXPECT_EQ(value.number, 2u);
  EXPECT_EQ(snapshot.count(), 2u);
}

TEST(Snapshot, ConcurrentReadsAreConsistentAndOrdered) {
  constexpr std::uint64_t kStores = 200'000;
  Snapshot<Value> snapshot;
  std::atomic<bool> done{false};
  std::atomic<int> torn{0}, backwards{0}, seen{0};
  std::vector<std::thread> readers;
  for (int reader = 0; reader < 3; ++reader) {
    readers.emplace_back([&] {
      std::uint64_t last = 0;
      while (!done.load()) {
        Value value;
        if (!snapshot.load(value)) continue;
        if (!whole(value)) torn.fetch_add(1);
        if (value.number < last) backwards.fetch_add(1);
        if (value.number != last) seen.fetch_add(1);
        last = value.number;
      }
    });
  }
  for (std::uint64_t i = 1; i <= kStores; ++i) {
    snapshot.store(value_of(i));
    if (i % 64 == 0) std::this_thread::yield();  // let readers in, also on one core
  }
  done.store(true);
  for (auto& reader : readers) reader.join();
  EXPECT_EQ(torn.load(), 0);
  EXPECT_EQ(backwards.load(), 0);
  EXPECT_GT(seen.load(), 0);
  EXPECT_EQ(snapshot.count(), kStores);
}

}  // namespace
}  // namespace thimble::driver
