#include "view/run_buttons.h"

#include <gtest/gtest.h>
#include <imgui.h>

#include <cstdlib>
#include <fstream>
#include <memory>
#include <optional>

#include "share/shared_run.h"
#include "support/scratch.h"
#include "view/scene_menu.h"

namespace thimble::view {
namespace {

namespace fs = std::filesystem;

bool lists(const std::vector<SceneChoice>& scenes, const fs::path& file) {
  for (const SceneChoice& scene : scenes) {
    std::error_code missing;
    if (fs::equivalent(scene.file, file, missing)) return true;
  }
  return false;
}

TEST(SceneMenu, ListsShippedUserAndNeighbouringScenes) {
  const fs::path folder = support::scratch_folder() / "menu";
  const fs::path own = folder / "data/thimble/scenes/mine.yaml";
  fs::create_directories(own.parent_path());
  setenv("XDG_DATA_HOME", (folder / "data").c_str(), 1);
  std::ofstream(own) << "description: Mine.\nobjects: []\nhand: {}\n";
  std::ofstream(folder / "beside.yaml") << "objects: []\nhand: {}\n";
  std::ofstream(folder / "arm.yaml") << "wire: {}\n";
  std::ofstream(folder / ".hidden.yaml") << "objects: []\nhand: {}\n";
  const fs::path shipped = fs::path(THIMBLE_SOURCE_DIR) / "app/scenes/honey.yaml";
  const SceneChoices found = find_scenes(folder / "beside.yaml");
  EXPECT_TRUE(lists(found.shipped, shipped));
  EXPECT_FALSE(lists(found.shipped, own));
  ASSERT_EQ(found.own.size(), 1u);
  EXPECT_TRUE(lists(found.own, own));
  EXPECT_EQ(found.own[0].about, "Mine.");
  ASSERT_EQ(found.neighbours.size(), 1u) << "arm files and hidden files are not scenes";
  EXPECT_EQ(found.neighbours[0].name, "beside");
  EXPECT_TRUE(find_scenes(shipped).neighbours.empty()) << "shipped scenes are listed separately";
  unsetenv("XDG_DATA_HOME");
}

TEST(RunButtons, CountPausedTicksSeparately) {
  session::SharedReader::Counters counters;
  counters.ticks = 1200;
  counters.missed = 3;
  EXPECT_EQ(counted(counters), "1200 ticks, 3 periods missed");
  counters.paused = 40;
  EXPECT_EQ(counted(counters), "1200 ticks, 3 periods missed, 40 paused");
}

TEST(RunButtons, AreDrawnForAnyRunAndExplainWhyPhysicalArmRefuses) {
  ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = {400, 300};
  io.IniFilename = nullptr;
  unsigned char* pixels = nullptr;
  int width = 0, height = 0;
  io.Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
  for (const char* device : {"sim", "polhem_1"}) {
    session::SharedScene scene;
    scene.period_ns = 1'000'000;
    scene.arms.front().device = device;
    scene.paced = scene.restarts = true;
    const auto run = session::SharedRun::create("", scene, 8).value();
    const auto reader = session::SharedReader::over(run->memory().again().value()).value();
    run->set_state(session::RunState::kRunning);
    RunButtons buttons;
    ImGui::NewFrame();
    ImGui::Begin("panel");
    buttons.draw(*reader);
    ImGui::End();
    ImGui::EndFrame();
    EXPECT_EQ(buttons.take_message(), "");
    const bool real = std::string(device) != "sim";
    buttons.take_key('B', false, false, *reader);
    EXPECT_EQ(buttons.take_message().find("physical arm (polhem_1)") != std::string::npos, real);
    EXPECT_EQ(run->restart_request_after(0).has_value(), !real);
    buttons.take_key(',', false, false, *reader);
    EXPECT_EQ(run->speed_wanted(), real ? std::nullopt : std::optional(1 / 1.25));
    buttons.take_key('L', false, false, *reader);
    EXPECT_EQ(run->loop_asked(), !real);
    static_cast<void>(buttons.take_message());
    run->set_state(session::RunState::kPaused);
    buttons.take_key('N', false, true, *reader);
    EXPECT_EQ(run->steps_asked(), real ? 0u : 100u);
  }
  ImGui::DestroyContext();
}

/// A run that has ended, on an arm of this device.
struct EndedRun {
  explicit EndedRun(const char* device) {
    session::SharedScene scene;
    scene.period_ns = 1'000'000;
    scene.arms.front().device = device;
    scene.paced = scene.restarts = true;
    run = session::SharedRun::create("", scene, 8).value();
    reader = session::SharedReader::over(run->memory().again().value()).value();
    run->set_state(session::RunState::kEnded);
  }
  std::unique_ptr<session::SharedRun> run;
  std::unique_ptr<session::SharedReader> reader;
};

TEST(RunButtons, EndedRunIsStartedAgainIfTheWindowCan) {
  const EndedRun ended("sim");
  RunButtons buttons;
  buttons.take_key('B', false, false, *ended.reader);
  EXPECT_FALSE(buttons.take_run_again());
  buttons.set_can_run_again(true);
  buttons.take_key('B', false, false, *ended.reader);
  EXPECT_TRUE(buttons.take_run_again());
  EXPECT_FALSE(buttons.take_run_again()) << "asked once";
}

TEST(RunButtons, EndedRunOfARealArmNamesTheTerminal) {
  const EndedRun ended("polhem_1");
  RunButtons buttons;
  buttons.set_can_run_again(true);
  EXPECT_FALSE(buttons.offers_run_again(*ended.reader));
  buttons.take_key('B', false, false, *ended.reader);
  EXPECT_FALSE(buttons.take_run_again());
  EXPECT_NE(buttons.take_message().find("started in a terminal"), std::string::npos);
}

}  // namespace
}  // namespace thimble::view
