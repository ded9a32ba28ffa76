// Suspend of the computer during a run. A separate program, because it replaces the clock functions
// of the C library.
#include <dlfcn.h>
#include <gtest/gtest.h>
#include <time.h>

#include <atomic>
#include <cstdint>
#include <vector>

#include "support/moved_arm.h"
#include "thimble/driver/clock.h"
#include "thimble/driver/device.h"
#include "thimble/driver/servo_loop.h"

namespace {

std::atomic<std::int64_t> slept_ns{0};

}  // namespace

// Replaces the function of the C library: CLOCK_BOOTTIME is ahead of CLOCK_MONOTONIC by the time of
// the suspend.
extern "C" int clock_gettime(clockid_t id, timespec* now) noexcept {
  using Original = int (*)(clockid_t, timespec*);
  static const auto original = reinterpret_cast<Original>(dlsym(RTLD_NEXT, "clock_gettime"));
  const bool boot = id == CLOCK_BOOTTIME;
  const int status = original(boot ? CLOCK_MONOTONIC : id, now);
  if (!boot || status != 0) return status;
  const std::int64_t ns = now->tv_nsec + slept_ns.load();
  now->tv_sec += ns / 1'000'000'000;
  now->tv_nsec = ns % 1'000'000'000;
  return 0;
}

extern "C" int clock_nanosleep(clockid_t id, int flags, const timespec* until,
                               timespec* rest) noexcept {
  using Original = int (*)(clockid_t, int, const timespec*, timespec*);
  static const auto original = reinterpret_cast<Original>(dlsym(RTLD_NEXT, "clock_nanosleep"));
  if (id != CLOCK_BOOTTIME) return original(id, flags, until, rest);
  timespec shifted = *until;
  std::int64_t ns = shifted.tv_sec * 1'000'000'000 + shifted.tv_nsec - slept_ns.load();
  if (ns < 0) ns = 0;
  shifted.tv_sec = ns / 1'000'000'000;
  shifted.tv_nsec = ns % 1'000'000'000;
  return original(CLOCK_MONOTONIC, flags, &shifted, rest);
}

namespace thimble::driver::suspend_test {
namespace {

/// Counts the ticks and suspends the computer after one of them.
struct Sleep {
  std::uint64_t after = 400;
  std::int64_t lasts_ns = 0;
  std::vector<TickRecord> ticks{};
  void operator()(const TickRecord& record) noexcept {
    if (ticks.size() < ticks.capacity()) ticks.push_back(record);
    if (ticks.size() == after) slept_ns += lasts_ns;
  }
};

/// Presses with 3.4 N in real time; the computer is suspended in between.
class SuspendTest : public ::testing::Test {
 protected:
  void press(std::int64_t lasts_ns) {
    WallClock clock(0);
    // The machine may also be delayed, which does not matter here.
    DeviceSettings settings = support::moved_settings();
    settings.limits.stall_ns = 900'000'000;
    settings.limits.watchdog_ns = 1'000'000'000;
    auto opened =
        Device::open(std::make_unique<support::MovedArm>(moved_), settings, clock.now_ns());
    ASSERT_TRUE(opened);
    device_ = std::move(opened).value();
    ASSERT_TRUE(device_->activate());
    sleep_.lasts_ns = lasts_ns;
    sleep_.ticks.reserve(500);
    auto law = [](const DeviceState&) noexcept {
      return ForceCommand{.f_T_W = {3.4, 0, 0}, .touch = {}};
    };
    ServoLoop loop(*device_, clock, ForceLaw(law), TickSink(sleep_),
                   {.continue_after_faults = true});
    const std::atomic<bool> stop{false};
    while (sleep_.ticks.size() < sleep_.ticks.capacity()) loop.tick(stop);
  }

  support::Moved moved_;
  std::unique_ptr<Device> device_;
  Sleep sleep_;
};

TEST_F(SuspendTest, NoForceAfterWaking) {
  for (const std::int64_t lasts_ns :
       {std::int64_t{2'000'000'000}, std::int64_t{3'600'000'000'000}}) {
    sleep_ = Sleep();
    press(lasts_ns);
    ASSERT_GT(sleep_.ticks[sleep_.after - 1].f_sent_W[0], 0.1);
    for (std::size_t i = sleep_.after; i < sleep_.ticks.size(); ++i) {
      EXPECT_EQ(sleep_.ticks[i].f_sent_W[0], 0) << i;
      EXPECT_EQ(sleep_.ticks[i].fault, Fault::kSuspended) << i;
    }
  }
}

TEST_F(SuspendTest, ForceComesBackOnceActivated) {
  press(2'000'000'000);
  ASSERT_EQ(device_->fault(), Fault::kSuspended);
  EXPECT_TRUE(device_->activate());
  EXPECT_EQ(device_->fault(), Fault::kNone);
}

TEST_F(SuspendTest, LateTickWithoutSleepIsNoSuspend) {
  press(0);
  EXPECT_NE(device_->fault(), Fault::kSuspended);
}

TEST(WallClock, AdvancesDuringSuspend) {
  const WallClock clock(0);
  const std::int64_t before = clock.now_ns();
  slept_ns += 3'600'000'000'000;
  EXPECT_GE(clock.now_ns() - before, 3'600'000'000'000);
  EXPECT_NEAR(static_cast<double>(clock.asleep_ns()), 3.6e12, 1e6);
}

TEST(WallClock, KnowsThatTheComputerIsAwake) {
  const WallClock clock(0);
  EXPECT_LT(std::abs(clock.asleep_ns()), 1'000'000);
}

TEST(WallClock, SleepsUntilItsOwnTime) {
  slept_ns += 7'000'000'000;
  WallClock clock(0);
  const std::int64_t until = clock.now_ns() + 5'000'000;
  clock.sleep_until_ns(until);
  EXPECT_GE(clock.now_ns(), until);
}

}  // namespace
}  // namespace thimble::driver::suspend_test
