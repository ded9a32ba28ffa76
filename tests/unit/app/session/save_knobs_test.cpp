#include "share/steer/save_knobs.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <memory>
#include <string>

#include "files/edit_scene.h"
#include "share/shared_run.h"
#include "share/turn_knob.h"
#include "support/scratch.h"
#include "text_file.h"
#include "thimble/session/session.h"

namespace thimble::session {
namespace {

namespace fs = std::filesystem;
const fs::path kSources(THIMBLE_SOURCE_DIR);

/// Runs of scene files of the user, with the user's scene folder.
class SaveKnobs : public ::testing::Test {
 protected:
  SaveKnobs() {
    fs::create_directories(folder_);
    setenv("XDG_DATA_HOME", (folder_ / "data").c_str(), 1);
  }
  ~SaveKnobs() override {
    unsetenv("XDG_DATA_HOME");
    fs::remove_all(folder_);
  }

  fs::path own(const std::string& name) const {
    std::string text = scene::text_of(kSources / "app/scenes" / (name + ".yaml"));
    const fs::path file = folder_ / (name + ".yaml");
    std::ofstream(file) << text;
    return file;
  }

  /// Shares a run of a scene and returns its viewer.
  SharedReader& view(const fs::path& file) {
    reader_.reset();
    session_ = Session::prepare(file, {.share = true}).value();
    reader_ = SharedReader::over(session_->shared()->memory().again().value()).value();
    return *reader_;
  }

  double knob(const std::string& name) const {
    for (std::size_t i = 0; i < reader_->scene().knobs.size(); ++i) {
      if (reader_->scene().knobs[i].name == name) return reader_->knob(i);
    }
    ADD_FAILURE() << "no knob " << name;
    return 0;
  }

  fs::path folder_ = support::scratch_folder() / "saved";
  std::unique_ptr<Session> session_;
  std::unique_ptr<SharedReader> reader_;
};

TEST_F(SaveKnobs, SavesACopyWithTheSceneAndKeepsComments) {
  const fs::path file = own("rubber");
  const std::string before = scene::text_of(file);
  SharedReader& reader = view(file);
  EXPECT_FALSE(save_knobs(reader)) << "none was turned";
  ASSERT_TRUE(turn_knob(reader, "ball: stiffness=321.5"));
  ASSERT_TRUE(turn_knob(reader, "ball: friction coefficient=0.4"));
  const auto saved = save_knobs(reader);
  ASSERT_TRUE(saved) << saved.error().message;
  EXPECT_EQ(saved->file, folder_ / "rubber-turned.yaml");
  EXPECT_EQ(saved->written.size(), 2u);
  EXPECT_TRUE(saved->absent.empty());
  EXPECT_NE(saved->text().find("ball: stiffness = 321.5 N/m"), std::string::npos);
  EXPECT_EQ(scene::text_of(file), before);
  std::string expected = before;
  for (const auto& [was, is] : {std::pair("stiffness: 400 ", "stiffness: 321.5 "),
                                std::pair(" coefficient: 0.8 ", " coefficient: 0.4 "),
                                std::pair("static_coefficient: 1 ", "static_coefficient: 0.5 ")}) {
    expected.replace(expected.find(was), std::string(was).size(), is);
  }
  EXPECT_EQ(scene::text_of(saved->file), expected) << "only three numbers differ";
  view(saved->file);
  EXPECT_EQ(knob("ball: stiffness"), 321.5);
  EXPECT_EQ(knob("ball: friction coefficient"), 0.4);
  EXPECT_EQ(knob("ball: damping"), 2);
}

TEST_F(SaveKnobs, ReplacesAFileOnlyOnRequest) {
  const fs::path file = own("honey");
  SharedReader& reader = view(file);
  ASSERT_TRUE(turn_knob(reader, "honey: damping=3"));
  EXPECT_EQ(save_knobs(reader)->file, folder_ / "honey-turned.yaml");
  EXPECT_EQ(save_knobs(reader)->file, folder_ / "honey-turned-2.yaml");
  const auto there = save_knobs(reader, {.file = folder_ / "honey-turned.yaml", .over = false});
  ASSERT_FALSE(there);
  EXPECT_NE(there.error().message.find("already exists"), std::string::npos);
  const auto over = save_knobs(reader, {.file = {}, .over = true});
  ASSERT_TRUE(over) << over.error().message;
  EXPECT_EQ(over->file, file);
  EXPECT_NE(scene::text_of(file).find("damping: 3 "), std::string::npos);
}

TEST_F(SaveKnobs, NeverOverwritesAShippedScene) {
  const fs::path shipped = kSources / "app/scenes/clay.yaml";
  const std::string before = scene::text_of(shipped);
  SharedReader& reader = view(shipped);
  ASSERT_TRUE(turn_knob(reader, "ball: stiffness=500"));
  const auto over = save_knobs(reader, {.file = {}, .over = true});
  ASSERT_FALSE(over);
  EXPECT_NE(over.error().message.find("is shipped with Thimble"), std::string::npos);
  const auto saved = save_knobs(reader);
  ASSERT_TRUE(saved) << saved.error().message;
  EXPECT_EQ(saved->file, folder_ / "data/thimble/scenes/clay-turned.yaml");
  EXPECT_EQ(scene::text_of(shipped), before);
  view(saved->file);  // with its mesh and its arm, which are in other folders
  EXPECT_EQ(knob("ball: stiffness"), 500);
}

TEST_F(SaveKnobs, ReportsKnobsWithoutAKey) {
  SharedReader& reader = view(own("sandpaper"));
  ASSERT_TRUE(turn_knob(reader, "ribs: texture gain=0.5"));
  const auto none = save_knobs(reader);
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().message.find("no key for ribs: texture gain = 0.5"), std::string::npos);
  ASSERT_TRUE(turn_knob(reader, "sandpaper: texture roughness=1e-5"));
  ASSERT_TRUE(turn_knob(reader, "ribs: stiffness=700"));
  const auto saved = save_knobs(reader);
  ASSERT_TRUE(saved) << saved.error().message;
  EXPECT_EQ(saved->absent, std::vector<std::string>{"ribs: texture gain = 0.5"});
  EXPECT_NE(saved->text().find("ribs: texture gain = 0.5 is not saved"), std::string::npos);
  view(saved->file);
  EXPECT_EQ(knob("sandpaper: texture roughness"), 1e-5);
  EXPECT_EQ(knob("sandpaper: stiffness"), 800) << "another object's key of the same name";
  EXPECT_EQ(knob("ribs: stiffness"), 700);
}

TEST(EditScene, ChangesOnlyTheNamedEffect) {
  const std::string text =
      "objects:\n"
      "  - {name: ü, stiffness: 400, effects: [{texture: a, height: 1}, {texture: b, height: 2}]}\n"
      "  - name: b   # height: 2\n"
      "    stiffness: \"400\"\n";
  const auto edited = scene::put_numbers(
      text, {{.object = "ü", .group = "texture", .key = "height", .which = 2, .value = 3e-7},
             {.object = "ü", .group = "", .key = "stiffness", .value = 12},
             {.object = "b", .group = "", .key = "stiffness", .value = 12},
             {.object = "c", .group = "", .key = "stiffness", .value = 12}});
  ASSERT_TRUE(edited);
  EXPECT_EQ(edited->text,
            "objects:\n"
            "  - {name: ü, stiffness: 12, effects: [{texture: a, height: 1}, {texture: b, height: "
            "3e-07}]}\n"
            "  - name: b   # height: 2\n"
            "    stiffness: \"400\"\n");
  EXPECT_EQ(edited->absent, (std::vector<std::size_t>{2, 3}))
      << "quoted values are unchanged and reported";
  EXPECT_FALSE(scene::put_numbers("a: [", {}));
}

}  // namespace
}  // namespace thimble::session
