#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "thimble/device_sim/sim_transport.h"
#include "vintage_simulation.h"

namespace {
std::atomic<std::uint64_t> allocations{0};

void* counted(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc();
}
}  // namespace

void* operator new(std::size_t size) {
  return counted(size);
}
void* operator new[](std::size_t size) {
  return counted(size);
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete[](void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace thimble::device_sim {
namespace {

TEST(SimulatedArm, NeverAllocatesOnceItIsBuilt) {
  const std::uint64_t at_start = allocations;
  SimulatedArmSettings settings = phantom_like();
  settings.hand.tremor_amplitude = 1e-3;
  settings.wire = {.delay_in_ns = 200'000, .delay_out_ns = 300'000};
  SimulatedArm arm(support::vintage_model(), settings,
                   HandPath({{0.0, home_tip()}, {0.5, home_tip() + Eigen::Vector3d(0.5, 0, 0)}}));
  driver::VirtualClock clock;
  SimTransport transport(clock, arm);
  // The counter works: building the path allocated.
  const std::uint64_t built = allocations;
  ASSERT_GT(built, at_start);

  std::array<std::byte, driver::kReportCapacity> buffer;
  const auto message = drive_message(700, -900, 400);
  for (int k = 0; k < 2000; ++k) {
    // Includes missed reports, a silence that fires the watchdog, wrong messages and the stop.
    transport.read_latest(buffer, clock.now_ns() + (k % 7) * 300'000);
    if (k < 1000) transport.write(message);
    if (k % 50 == 0) transport.write(std::span<const std::byte>(buffer).first(3));
    clock.sleep_until_ns(clock.now_ns() + 400'000);
  }
  transport.unplug();
  transport.read_latest(buffer, 0);
  const std::uint64_t after = allocations;
  EXPECT_EQ(after, built);
  EXPECT_GT(arm.plant().stops(), 0U);
  EXPECT_GT(arm.firmware().counters().watchdog_fired, 0U);
}

}  // namespace
}  // namespace thimble::device_sim
