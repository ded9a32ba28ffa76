#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

#include "simulated_arm.h"
#include "support/meshes/elephant.h"
#include "thimble/driver/real_time.h"
#include "thimble/scene/arm_simulation.h"

// The loop in real time with concurrent readers, for the thread sanitizer. Times are not checked,
// because the machine may be busy.

namespace thimble {
namespace {

TEST(WallClockRun, ReadersDoNotStallTheRun) {
  THIMBLE_NEEDS_MESHES();
  session::SessionOptions options;
  options.clock = session::ClockKind::kWall;
  options.duration = 2;
  options.mesh_folder = THIMBLE_MESHES;
  auto opened = session::Session::open(support::elephant_scene(), options);
  ASSERT_TRUE(opened) << opened.error().message;
  session::Session& session = **opened;

  const std::atomic<bool> stop{false};
  std::atomic<bool> ended{false};
  driver::ServoEnd end{};
  std::thread servo([&] {
    driver::enter_real_time();
    end = session.run(stop);
    ended.store(true);
  });
  std::vector<std::thread> readers;
  std::atomic<std::uint64_t> seen{0}, backwards{0};
  for (int reader = 0; reader < 2; ++reader) {
    readers.emplace_back([&] {
      driver::TickRecord record;
      std::uint64_t last = 0;
      while (!ended.load()) {
        if (session.newest().load(record)) {
          if (record.tick < last) backwards.fetch_add(1);
          if (record.tick > last) seen.fetch_add(1);
          last = record.tick;
        }
        std::this_thread::sleep_for(std::chrono::microseconds(300));
      }
    });
  }
  servo.join();
  for (auto& reader : readers) reader.join();

  EXPECT_GT(seen.load(), 0u);
  EXPECT_EQ(backwards.load(), 0u);
  EXPECT_EQ(session.statistics().ticks(), session.newest().count());
  // If the machine pauses for 100 ms, the arm's watchdog fires and the loop must report that fault.
  if (end != driver::ServoEnd::kDone) {
    EXPECT_EQ(session.device().fault(), driver::Fault::kLoopStalled);
  }
  EXPECT_EQ(session.simulation()->board_arm()->firmware().currents().cwiseAbs().maxCoeff(), 0);
}

}  // namespace
}  // namespace thimble
