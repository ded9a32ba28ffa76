// A recording contains every option that changes the forces of a scene, so that a replay repeats
// them.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include "recording/run_choices.h"
#include "support/scratch.h"
#include "thimble/scene/scene_file.h"
#include "thimble/session/recording.h"
#include "thimble/session/session.h"

namespace thimble {
namespace {

class ReplayOptions : public ::testing::Test {
 protected:
  void SetUp() override { std::filesystem::current_path(THIMBLE_SOURCE_DIR); }

  /// Runs a session and calls `meanwhile` between the ticks. Returns its recording.
  template <class Meanwhile>
  static session::Recording recorded(const std::string& scene, session::SessionOptions options,
                                     Meanwhile&& meanwhile) {
    const auto path = support::scratch_folder() / "options.h5";
    std::filesystem::remove(path);
    options.record = path;
    auto opened = session::Session::open(scene, options);
    EXPECT_TRUE(opened) << opened.error().message;
    if (!opened) return {};
    session::Session& run = **opened;
    for (int tick = 0; !run.step(); ++tick) meanwhile(run, tick);
    EXPECT_TRUE(run.end_recording());
    auto read = session::read_recording(path);
    EXPECT_TRUE(read) << read.error().message;
    return read ? std::move(read).value() : session::Recording();
  }
  static session::Recording recorded(const std::string& scene, session::SessionOptions options) {
    return recorded(scene, std::move(options), [](session::Session&, int) {});
  }

  static void expect_repeats(const session::Recording& recording) {
    const auto repeatable = session::check_repeatable(recording);
    EXPECT_TRUE(repeatable) << repeatable.error().message;
    const auto replayed = session::replay(recording);
    ASSERT_TRUE(replayed) << replayed.error().message;
    EXPECT_GT(replayed->compared.ticks, 0U);
    EXPECT_EQ(replayed->compared.differing, 0U)
        << "first in tick " << replayed->compared.first.value_or(0) << ", by "
        << replayed->compared.largest << " N";
  }
};

TEST_F(ReplayOptions, DraftRepeats) {
  const auto recording = recorded("water_balloon", {.duration = 1.5, .quality = "draft"});
  EXPECT_NE(recording.info.options.find("quality: draft\n"), std::string::npos);
  expect_repeats(recording);
}

TEST_F(ReplayOptions, ReferenceRepeats) {
  expect_repeats(recorded("water_balloon", {.duration = 1.5, .quality = "reference"}));
}

TEST_F(ReplayOptions, BudgetRepeats) {
  const auto recording =
      recorded("water_balloon", {.duration = 1.5, .quality = "auto", .budget = 400.25});
  EXPECT_NE(recording.info.options.find("budget: 400.25\n"), std::string::npos);
  expect_repeats(recording);
}

TEST_F(ReplayOptions, RateFactorRepeats) {
  expect_repeats(recorded("honey", {.duration = 1, .rate_factor = 2}));
}

/// A copy of the scene with a mesh and two pictures, and its recording.
class ReplayOfFiles : public ReplayOptions {
 protected:
  void SetUp() override {
    ReplayOptions::SetUp();
    folder_ = support::scratch_folder() / "tissue";
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
    for (const char* name : {"tissue.yaml", "tissue.obj", "tissue_lumps.png", "tissue_ribs.png"}) {
      std::filesystem::copy_file(std::filesystem::path("app/scenes") / name, folder_ / name);
    }
    recording_ = recorded((folder_ / "tissue.yaml").string(), {.duration = 0.1});
  }
  /// Replaces one picture by the other.
  void change_picture() const {
    std::filesystem::copy_file(folder_ / "tissue_ribs.png", folder_ / "tissue_lumps.png",
                               std::filesystem::copy_options::overwrite_existing);
  }

  std::filesystem::path folder_;
  session::Recording recording_;
};

TEST_F(ReplayOfFiles, NamesAChangedPicture) {
  expect_repeats(recording_);
  change_picture();
  const auto repeatable = session::check_repeatable(recording_);
  ASSERT_FALSE(repeatable);
  EXPECT_NE(repeatable.error().message.find("tissue_lumps.png"), std::string::npos)
      << repeatable.error().message;
}

TEST_F(ReplayOfFiles, OldRecordingNamesTheFilesWithoutHashes) {
  EXPECT_EQ(session::unhashed_files(recording_), "");
  recording_.info.file_hashes.clear();
  change_picture();
  EXPECT_TRUE(session::check_repeatable(recording_));
  for (const char* name : {"tissue.obj", "tissue_lumps.png", "tissue_ribs.png"}) {
    EXPECT_NE(session::unhashed_files(recording_).find(name), std::string::npos) << name;
  }
  recording_.info.program = "an older build";
  const auto repeatable = session::check_repeatable(recording_);
  ASSERT_FALSE(repeatable);
  EXPECT_NE(repeatable.error().message.find("tissue_lumps.png"), std::string::npos)
      << repeatable.error().message;
}

TEST_F(ReplayOfFiles, PictureChangedBeforeTheRecordingHasNoHash) {
  auto opened = session::Session::open(folder_ / "tissue.yaml", {.duration = 0.1});
  ASSERT_TRUE(opened) << opened.error().message;
  change_picture();
  recording_.info = (*opened)->recording_info();
  EXPECT_FALSE(session::check_repeatable(recording_));
}

TEST_F(ReplayOptions, PlainRunHoldsNoOptions) {
  EXPECT_EQ(recorded("box", {.duration = 0.1}).info.options, "");
}

TEST_F(ReplayOptions, TurnedKnobRepeats) {
  const auto recording =
      recorded("rubber", {.duration = 3, .knobs = true}, [](session::Session& run, int tick) {
        const auto knobs = run.knobs();
        ASSERT_FALSE(knobs.empty());
        const auto stiffness = std::find_if(knobs.begin(), knobs.end(), [](const auto& knob) {
          return knob.name.find("stiffness") != std::string::npos;
        });
        ASSERT_NE(stiffness, knobs.end());
        // Changed, reversed during the change, and changed in contact.
        if (tick == 500) {
          EXPECT_TRUE(run.turn_knob(stiffness->name, stiffness->max));
        }
        if (tick == 510 || tick == 2000) {
          EXPECT_TRUE(run.turn_knob(stiffness->name, 0.5 * (stiffness->min + stiffness->max)));
        }
      });
  const auto turned = std::count_if(recording.ticks.begin(), recording.ticks.end(),
                                    [](const auto& tick) { return tick.setting >= 0; });
  EXPECT_EQ(turned, 2);  // the third has this value already
  expect_repeats(recording);
}

TEST_F(ReplayOptions, KnobsTurnedAtOnceRepeat) {
  const auto recording =
      recorded("rubber", {.duration = 3, .knobs = true}, [](session::Session& run, int tick) {
        if (tick != 1000) return;
        for (const session::Knob& knob : run.knobs()) {
          EXPECT_TRUE(run.turn_knob(knob.name, 0.5 * (knob.min + knob.max)));
        }
      });
  const auto turned = std::count_if(recording.ticks.begin(), recording.ticks.end(),
                                    [](const auto& tick) { return tick.setting >= 0; });
  EXPECT_GE(turned, 2);
  expect_repeats(recording);
}

TEST_F(ReplayOptions, CarriedWeightRepeats) {
  std::ifstream in("app/arms/vintage_phantom.yaml");
  std::string text((std::istreambuf_iterator<char>(in)), {});
  const auto arm = support::scratch_folder() / "carries.yaml";
  std::ofstream(arm) << text << "\ngravity_compensation:\n  weight: 0.5\n";
  const auto recording = recorded("box", {.duration = 2, .arm_file = arm});
  ASSERT_FALSE(recording.ticks.empty());
  EXPECT_NEAR(recording.ticks[10].f_wanted_W[2], 0.5, 1e-9);
  expect_repeats(recording);
}

TEST_F(ReplayOptions, LawOfAProgramIsNotRepeatable) {
  const auto path = support::scratch_folder() / "law.h5";
  auto opened = session::Session::open("box", {.duration = 0.1, .record = path});
  ASSERT_TRUE(opened);
  struct {
    driver::ForceCommand operator()(const driver::DeviceState&) noexcept {
      return {.f_T_W = {0, 0, 0.1}, .touch = {}};
    }
  } law;
  ASSERT_TRUE((*opened)->set_law(driver::ForceLaw(law)));
  (*opened)->run();
  ASSERT_TRUE((*opened)->end_recording());
  const auto recording = session::read_recording(path);
  ASSERT_TRUE(recording) << recording.error().message;
  const auto repeatable = session::check_repeatable(*recording);
  ASSERT_FALSE(repeatable);
  EXPECT_NE(repeatable.error().message.find("came from a program"), std::string::npos);
}

TEST_F(ReplayOptions, SceneThatAProgramChangedIsNotRepeatable) {
  const auto recording = recorded("box", {.duration = 0.1, .adjust = [](scene::Scene& scene) {
                                            scene.objects.front().stiffness = 100;
                                          }});
  const auto repeatable = session::check_repeatable(recording);
  ASSERT_FALSE(repeatable);
  EXPECT_NE(repeatable.error().message.find("a program changed the scene"), std::string::npos);
}

TEST_F(ReplayOptions, UnknownQualityIsRefused) {
  EXPECT_FALSE(session::Session::open("box", {.quality = "best"}));
}

TEST(RunChoices, ReadBackBitIdentically) {
  const session::RunChoices choices{
      .quality = "auto", .budget = 0.1 + 0.2, .rate_factor = 1.0 / 3, .adjusted = true};
  const auto read = session::run_choices(text_of(choices));
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->quality, "auto");
  EXPECT_EQ(read->budget, choices.budget);
  EXPECT_EQ(read->rate_factor, choices.rate_factor);
  EXPECT_TRUE(read->adjusted);
}

TEST(RunChoices, RejectUnknownOptions) {
  for (const char* text : {"gravity: 2\n", "quality: best\n", "budget: -1\n", "budget: nan\n",
                           "rate_factor: 1x\n", "quality\n", "adjusted: no\n"}) {
    EXPECT_FALSE(session::run_choices(text)) << text;
  }
}

}  // namespace
}  // namespace thimble
