#include "layout_hash.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstdint>

#include "thimble/driver/snapshot.h"

namespace thimble::driver::layout_test {

enum class Kind : std::uint8_t { kOne, kTwo };
enum class Swapped : std::uint8_t { kTwo, kOne };

struct Plain {
  double a;
  std::int32_t b;
  std::atomic<std::uint32_t> c;
  Snapshot<std::array<double, 3>> d;
  Kind e;
};
struct OtherName {
  double a;
  std::int32_t bb;
  std::atomic<std::uint32_t> c;
  Snapshot<std::array<double, 3>> d;
  Kind e;
};
struct OtherType {
  double a;
  std::uint32_t b;
  std::atomic<std::uint32_t> c;
  Snapshot<std::array<double, 3>> d;
  Kind e;
};
struct OtherPlace {
  double a;
  alignas(8) std::int32_t b;
  alignas(8) std::atomic<std::uint32_t> c;
  Snapshot<std::array<double, 3>> d;
  Kind e;
};
struct OtherInside {
  double a;
  std::int32_t b;
  std::atomic<std::uint32_t> c;
  Snapshot<std::array<double, 3>> d;
  Swapped e;
};
struct Same {
  double a;
  std::int32_t b;
  std::atomic<std::uint32_t> c;
  Snapshot<std::array<double, 3>> d;
  Kind e;
};

}  // namespace thimble::driver::layout_test

THIMBLE_LAYOUT_ENUM(thimble::driver::layout_test::Kind, kOne, kTwo)
THIMBLE_LAYOUT_ENUM(thimble::driver::layout_test::Swapped, kTwo, kOne)
THIMBLE_LAYOUT(thimble::driver::layout_test::Plain, a, b, c, d, e)
THIMBLE_LAYOUT(thimble::driver::layout_test::OtherName, a, bb, c, d, e)
THIMBLE_LAYOUT(thimble::driver::layout_test::OtherType, a, b, c, d, e)
THIMBLE_LAYOUT(thimble::driver::layout_test::OtherPlace, a, b, c, d, e)
THIMBLE_LAYOUT(thimble::driver::layout_test::OtherInside, a, b, c, d, e)
THIMBLE_LAYOUT(thimble::driver::layout_test::Same, a, b, c, d, e)

namespace thimble::driver::layout_test {
namespace {

TEST(LayoutHash, SameFieldsHaveSameHash) {
  EXPECT_EQ(layout_hash<Plain>(), layout_hash<Same>());
}

TEST(LayoutHash, DependsOnName) {
  ASSERT_EQ(sizeof(Plain), sizeof(OtherName));
  EXPECT_NE(layout_hash<Plain>(), layout_hash<OtherName>());
}

TEST(LayoutHash, DependsOnType) {
  ASSERT_EQ(sizeof(Plain), sizeof(OtherType));
  EXPECT_NE(layout_hash<Plain>(), layout_hash<OtherType>());
}

TEST(LayoutHash, DependsOnOffset) {
  EXPECT_NE(layout_hash<Plain>(), layout_hash<OtherPlace>());
}

TEST(LayoutHash, DependsOnEnumerators) {
  ASSERT_EQ(sizeof(Plain), sizeof(OtherInside));
  EXPECT_NE(layout_hash<Plain>(), layout_hash<OtherInside>());
}

TEST(LayoutHash, CountsFieldsThatAreNotDescribed) {
  EXPECT_TRUE((layout_detail::has_fields<Plain, 5>()));
  EXPECT_FALSE((layout_detail::has_fields<Plain, 4>()));
}

}  // namespace
}  // namespace thimble::driver::layout_test
