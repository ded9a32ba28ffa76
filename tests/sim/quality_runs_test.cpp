// Every shipped scene at every quality, from the wire up.
#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <string>

#include "thimble/scene/quality.h"
#include "thimble/session/session.h"

namespace thimble {
namespace {

class QualityOfScene : public ::testing::TestWithParam<const char*> {};

TEST_P(QualityOfScene, RunsWithoutAFaultAndGivesNoEnergy) {
  const auto file = std::filesystem::path(THIMBLE_SOURCE_DIR) / "app/scenes" /
                    (std::string(GetParam()) + ".yaml");
  for (const auto quality :
       {scene::Quality::kDraft, scene::Quality::kAuto, scene::Quality::kReference}) {
    session::SessionOptions options;
    options.duration = 2;
    options.rate_factor = scene::rate_factor_of(quality);
    options.adjust = [quality](scene::Scene& scene) { scene::apply_quality(quality, scene); };
    const auto opened = session::Session::open(file, options);
    ASSERT_TRUE(opened.ok()) << opened.error().message;
    session::Session& session = **opened;
    EXPECT_EQ(session.run(std::atomic<bool>{false}), driver::ServoEnd::kDone)
        << static_cast<int>(quality);
    EXPECT_NEAR(static_cast<double>(session.ticks().size()), 2 * session.scene().rate, 2);
    EXPECT_GT(session.statistics().contact_time(), 0.1) << static_cast<int>(quality);
    EXPECT_LT(session.statistics().energy_to_hand(), 1e-3) << static_cast<int>(quality);
  }
}

INSTANTIATE_TEST_SUITE_P(ByName, QualityOfScene,
                         ::testing::Values("box", "clay", "clay_tablet", "floating_block", "ice",
                                           "rubber", "sandpaper", "soft_coarse", "tin_can",
                                           "trampoline", "water_balloon"),
                         [](const auto& scene) { return std::string(scene.param); });

}  // namespace
}  // namespace thimble
