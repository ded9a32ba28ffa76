// Every shipped scene at every quality, through the complete chain.
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <filesystem>
#include <string>

#include "support/covered.h"
#include "support/shipped_scenes.h"
#include "thimble/scene/quality.h"
#include "thimble/session/session.h"

namespace thimble {
namespace {

class QualityOfScene : public ::testing::TestWithParam<std::string> {};

TEST_P(QualityOfScene, RunsWithoutAFaultAndGivesNoEnergy) {
  const std::string name = GetParam();
  if (name == "elephant") THIMBLE_NEEDS_MESHES();
  // Fields act without contact.
  const bool field = name == "charges" || name == "honey";
  for (const auto quality :
       {scene::Quality::kDraft, scene::Quality::kAuto, scene::Quality::kReference}) {
    session::SessionOptions options;
    options.mesh_folder = THIMBLE_MESHES;
    options.duration = 2;
    options.rate_factor = scene::rate_factor_of(quality);
    options.adjust = [quality](scene::Scene& scene) { scene::apply_quality(quality, scene); };
    const auto opened = session::Session::open(support::scene_file(name), options);
    ASSERT_TRUE(opened.ok()) << opened.error().message;
    session::Session& session = **opened;
    EXPECT_EQ(session.run(std::atomic<bool>{false}), driver::ServoEnd::kDone)
        << static_cast<int>(quality);
    EXPECT_NEAR(static_cast<double>(session.ticks().size()), 2 * session.scene().rate, 2);
    EXPECT_GT(session.statistics().force_max(), 0.05) << static_cast<int>(quality);
    if (!field) {
      EXPECT_GT(session.statistics().contact_time(), 0.1) << static_cast<int>(quality);
      EXPECT_LT(session.statistics().energy_to_hand(), 1e-3) << static_cast<int>(quality);
    }
  }
  support::Covered("scenes").add(name);
}

INSTANTIATE_TEST_SUITE_P(ByName, QualityOfScene, ::testing::ValuesIn(support::scenes_of_one_arm()),
                         [](const auto& scene) { return scene.param; });

}  // namespace
}  // namespace thimble
