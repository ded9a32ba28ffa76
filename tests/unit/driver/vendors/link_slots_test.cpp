#include <gtest/gtest.h>

#include <atomic>
#include <string>
#include <thread>
#include <vector>

#include "support/open_gate.h"
#include "vendors/force_box.h"
#include "vendors/newest_slot.h"
#include "vendors/slot_link.h"
#include "vendors/vendor_library.h"

namespace thimble::driver {
namespace {

using Eigen::Vector3d;

TEST(NewestSlot, ReturnsTheNewestValueOnce) {
  NewestSlot<int> slot;
  int value = 0;
  EXPECT_FALSE(slot.take(value));
  slot.put(1);
  slot.put(2);
  ASSERT_TRUE(slot.take(value));
  EXPECT_EQ(value, 2);
  EXPECT_FALSE(slot.take(value));
}

TEST(NewestSlot, ConcurrentReadsAreCompleteAndOrdered) {
  struct Wide {
    std::array<int, 64> same{};
  };
  NewestSlot<Wide> slot;
  constexpr int kLast = 200'000;
  std::thread writer([&] {
    for (int i = 1; i <= kLast; ++i) {
      Wide value;
      value.same.fill(i);
      slot.put(value);
    }
  });
  int last = 0;
  bool whole = true, newer = true;
  while (last < kLast) {
    Wide value;
    if (!slot.take(value)) continue;
    for (const int number : value.same) whole = whole && number == value.same[0];
    newer = newer && value.same[0] > last;
    last = value.same[0];
  }
  writer.join();
  EXPECT_TRUE(whole);
  EXPECT_TRUE(newer);
}

TEST(ForceBox, KeepsAForceThatWaitsUnlessZeroComes) {
  ForceBox box;
  Vector3d f(9, 9, 9);
  EXPECT_FALSE(box.take(f));
  EXPECT_TRUE(box.put({1, 0, 0}));
  EXPECT_FALSE(box.put({2, 0, 0})) << "the loop must know that the previous force is sent";
  ASSERT_TRUE(box.take(f));
  EXPECT_EQ(f, Vector3d(1, 0, 0));
  EXPECT_FALSE(box.take(f));
  EXPECT_TRUE(box.put({3, 0, 0}));
  EXPECT_FALSE(box.put({0, 0, 0}));
  ASSERT_TRUE(box.take(f));
  EXPECT_EQ(f, Vector3d(0, 0, 0)) << "zero replaces the waiting force";
  EXPECT_TRUE(box.put({4, 0, 0}));
  ASSERT_TRUE(box.take(f));
  EXPECT_EQ(f, Vector3d(4, 0, 0));
}

TEST(ForceBox, ZeroIsSettledOnceTheOtherThreadHasIt) {
  ForceBox box;
  Vector3d f;
  EXPECT_TRUE(box.put({1, 0, 0}));
  EXPECT_FALSE(box.put({0, 0, 0}));
  EXPECT_FALSE(box.zero_settled()) << "the other thread may still send the previous force";
  ASSERT_TRUE(box.take(f));
  EXPECT_TRUE(box.zero_settled());
  EXPECT_TRUE(box.put({0, 0, 0}));
  EXPECT_TRUE(box.zero_settled()) << "another zero changes nothing";
  EXPECT_FALSE(box.put({0, 0, 0}));
  EXPECT_TRUE(box.zero_settled());
}

TEST(ForceBox, EveryAcceptedForceIsSentOnceInOrder) {
  ForceBox box;
  constexpr int kForces = 500;
  std::atomic<bool> done{false};
  int taken = 0;
  bool in_order = true;
  std::thread reader([&] {
    double last = 0;
    Vector3d f;
    while (true) {
      const bool over = done.load();
      if (box.take(f)) {
        in_order = in_order && f.x() > last && f.x() == f.y();
        last = f.x();
        ++taken;
      } else if (over) {
        return;
      } else {
        std::this_thread::yield();
      }
    }
  });
  int put = 0;
  for (int i = 1; put < kForces; ++i) {
    const bool taken_in = box.put({1.0 * i, 1.0 * i, 0});
    put += taken_in ? 1 : 0;
    if (!taken_in) std::this_thread::yield();
  }
  done = true;
  reader.join();
  EXPECT_EQ(taken, put);
  EXPECT_TRUE(in_order);
}

/// A link whose other thread is the test.
class OpenSlotLink final : public SlotLink {
 public:
  using SlotLink::refuse;
  using SlotLink::SlotLink;
  using SlotLink::take_force;
};

TEST(SlotLink, RefusedForceIsNeverSent) {
  VirtualClock clock;
  OpenSlotLink link({}, clock);
  const GatedForce force = support::open_gate().pass({0.5, 0, 0}, {0, 0, 0}, 0.009);
  ASSERT_GT(force.f_T_W().x(), 0.1);
  const auto write = [&] { return link.write(force, {}, Eigen::Matrix3d::Identity()).status; };
  Vector3d f;
  link.refuse(true);
  EXPECT_EQ(write(), LinkStatus::kRefused);
  link.refuse(false);
  EXPECT_FALSE(link.take_force(f) && !f.isZero(0)) << "the loop assumes that it was not sent";
  EXPECT_EQ(write(), LinkStatus::kOk);
  ASSERT_TRUE(link.take_force(f));
  EXPECT_EQ(f, force.f_T_W());
}

TEST(VendorLibrary, AbsentFilesAreListed) {
  const std::vector<std::string> files{"/nowhere/a.so", "/nowhere/b.so"};
  const auto opened = open_vendor_library(files, {}, "");
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().message,
            "None of these libraries was found: /nowhere/a.so, /nowhere/b.so.");
}

TEST(VendorLibrary, FirstFileThatIsNoLibraryIsNamed) {
  const std::vector<std::string> files{"/nowhere/a.so", "/proc/version", "/proc/filesystems"};
  const auto opened = open_vendor_library(files, {}, "");
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().message.find("Cannot open the library: /proc/version: "), 0U)
      << opened.error().message;
}

}  // namespace
}  // namespace thimble::driver
