#include <gtest/gtest.h>

#include "board/sim_transport.h"
#include "support/heap_guard.h"
#include "vintage_simulation.h"

namespace thimble::device_sim {
namespace {

TEST(SimulatedArm, DoesNotAllocateAfterConstruction) {
  SimulatedArmSettings settings = phantom_like();
  settings.hand.tremor_amplitude = 1e-3;
  settings.wire = {.delay_in_ns = 200'000, .delay_out_ns = 300'000};
  SimulatedArm arm =
      SimulatedArm::make(
          support::vintage_model(), settings,
          HandPath::make({{0.0, home_tip()}, {0.5, home_tip() + Eigen::Vector3d(0.5, 0, 0)}})
              .value())
          .value();
  driver::VirtualClock clock;
  SimTransport transport(clock, arm);

  std::array<std::byte, driver::kReportCapacity> buffer;
  const auto message = drive_message(700, -900, 400);
  EXPECT_EQ(support::heap_calls_of([&] {
              for (int k = 0; k < 2000; ++k) {
                // Includes missed reports, a silence that fires the watchdog, wrong messages and
                // the stop.
                transport.read_latest(buffer, clock.now_ns() + (k % 7) * 300'000);
                if (k < 1000) transport.write(message);
                if (k % 50 == 0) transport.write(std::span<const std::byte>(buffer).first(3));
                clock.sleep_until_ns(clock.now_ns() + 400'000);
              }
              transport.unplug();
              transport.read_latest(buffer, 0);
            }),
            0);
  EXPECT_GT(arm.plant().stops(), 0U);
  EXPECT_GT(arm.firmware().counters().watchdog_fired, 0U);
}

}  // namespace
}  // namespace thimble::device_sim
