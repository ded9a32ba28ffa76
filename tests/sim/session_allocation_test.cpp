#include <gtest/gtest.h>

#include "support/covered.h"
#include "support/heap_guard.h"
#include "support/meshes/elephant.h"
#include "support/shipped_scenes.h"

// The guard covers whole ticks of the demo's scene: simulated arm, codec, kinematics, contact,
// gate, snapshot, statistics and trace.

namespace thimble {
namespace {

TEST(ServoPath, AllocatesNothingInTenSecondsOfContact) {
  THIMBLE_NEEDS_MESHES();
  const auto session = support::open_elephant();
  ASSERT_TRUE(session);
  const std::atomic<bool> stop{false};
  driver::ServoEnd end{};
  EXPECT_EQ(support::heap_calls_of([&] { end = session->run(stop); }), 0);
  EXPECT_EQ(end, driver::ServoEnd::kDone);
  EXPECT_GT(session->statistics().contacts(), 0u);
}

class ServoPathOfScene : public ::testing::TestWithParam<std::string> {};

TEST_P(ServoPathOfScene, AllocatesNothing) {
  if (GetParam() == "elephant") THIMBLE_NEEDS_MESHES();
  session::SessionOptions options;
  options.mesh_folder = THIMBLE_MESHES;
  options.duration = 3;
  const auto opened = session::Session::open(support::scene_file(GetParam()), options);
  ASSERT_TRUE(opened) << opened.error().message;
  const std::atomic<bool> stop{false};
  driver::ServoEnd end{};
  EXPECT_EQ(support::heap_calls_of([&] { end = (*opened)->run(stop); }), 0);
  EXPECT_EQ(end, driver::ServoEnd::kDone);
  EXPECT_GT((*opened)->statistics().force_max(), 0.05);
  support::Covered("scenes").add(GetParam());
}

INSTANTIATE_TEST_SUITE_P(ByName, ServoPathOfScene,
                         ::testing::ValuesIn(support::scenes_of_one_arm()),
                         [](const auto& scene) { return scene.param; });

TEST(ServoPath, GuardDetectsOneAllocation) {
  // The negative control: a force law that allocates once, in one tick of many.
  int ticks = 0;
  const auto sloppy = [&](const driver::DeviceState&) noexcept {
    if (++ticks == 50) {
      int* volatile memory = new int(1);  // volatile, or the compiler removes the pair
      delete memory;
    }
    return driver::ForceCommand{};
  };
  EXPECT_EQ(support::heap_calls_of([&] {
              const driver::ForceLaw law(sloppy);
              for (int k = 0; k < 100; ++k) law(driver::DeviceState());
            }),
            2);  // one new, one delete
}

}  // namespace
}  // namespace thimble
