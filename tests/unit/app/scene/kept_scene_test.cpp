#include "files/kept_scene.h"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <fstream>
#include <set>

#include "files/scene_inputs.h"
#include "support/scratch.h"
#include "text_file.h"
#include "thimble/scene/scene_file.h"

namespace thimble::scene {
namespace {

namespace fs = std::filesystem;

const fs::path kInto = support::scratch_folder() / "kept_scenes";

const char* const kTwoBalls =
    "# a comment\n"
    "name: two balls\n"
    "arm: arm.yaml\n"
    "objects:\n"
    "  - name: ball\n"
    "    mesh: ball.off\n"
    "    stiffness: 500\n"
    "    effects:\n"
    "      - {friction: bristle, coefficient: 0.5}\n"
    "      - {texture: sandpaper, wavelength: 0.002}\n"
    "  - {name: rate, mesh: cgal:cow.off, stiffness: 1}\n"
    "rate: 1000\n";

driver::Result<fs::path> keep(const std::vector<SceneChange>& changes,
                              const fs::path& beside = "/nowhere") {
  return keep_scene(kTwoBalls, changes, beside, kInto);
}

YAML::Node kept(const std::vector<SceneChange>& changes) {
  const auto file = keep(changes);
  EXPECT_TRUE(file) << file.error().message;
  return file ? YAML::LoadFile(file->string()) : YAML::Node();
}

TEST(KeptScene, EmptyEditKeepsText) {
  const auto file = keep({});
  ASSERT_TRUE(file);
  EXPECT_EQ(text_of(*file), kTwoBalls);
  EXPECT_EQ(file->filename().string().substr(0, 10), "two_balls-");
  EXPECT_EQ(keep({}).value(), *file);
  EXPECT_NE(keep({{"rate", "2000"}}).value(), *file);
}

TEST(KeptScene, ChangesOnlyTheNamedPlace) {
  const YAML::Node all = kept({{"ball.stiffness", "300"},
                               {"ball.effects.friction.coefficient", "0.25"},
                               {"objects.1.stiffness", "2"},
                               {"ball.effects.1.wavelength", "0.003"},
                               {"ball.position", "[0, 0, 0.1]"},
                               {"rate", "2000"}});
  const YAML::Node ball = all["objects"][0];
  EXPECT_EQ(ball["stiffness"].as<int>(), 300);
  EXPECT_EQ(ball["effects"][0]["coefficient"].as<double>(), 0.25);
  EXPECT_EQ(ball["effects"][0]["friction"].as<std::string>(), "bristle");
  EXPECT_EQ(ball["effects"][1]["wavelength"].as<double>(), 0.003);
  EXPECT_EQ(ball["position"][2].as<double>(), 0.1);
  EXPECT_EQ(all["objects"][1]["stiffness"].as<int>(), 2);
  // A key of the scene takes precedence over an object of that name.
  EXPECT_EQ(all["rate"].as<int>(), 2000);
  EXPECT_EQ(all["name"].as<std::string>(), "two balls");
  EXPECT_EQ(all["objects"].size(), 2U);
}

TEST(KeptScene, ReplacesAWholeItemOfAList) {
  const YAML::Node all = kept({{"ball.effects.texture", "{texture: grating}"}});
  EXPECT_EQ(all["objects"][0]["effects"][1]["texture"].as<std::string>(), "grating");
  EXPECT_FALSE(all["objects"][0]["effects"][1]["wavelength"]);
}

TEST(KeptScene, UnknownPlaceListsTheKnownOnes) {
  const auto said = [](const std::string& place) {
    const auto file = keep({{place, "1"}});
    return file ? std::string() : file.error().message;
  };
  EXPECT_NE(said("cube.stiffness").find("no \"cube\" there"), std::string::npos);
  EXPECT_NE(said("cube.stiffness").find("of objects ball, rate"), std::string::npos)
      << said("cube.stiffness");
  EXPECT_NE(said("ball.effects.5.x").find("no \"5\" there; there is 0, 1"), std::string::npos)
      << said("ball.effects.5.x");
  EXPECT_NE(said("ball.stiffness.x").find("no \"x\""), std::string::npos);
  EXPECT_FALSE(keep({{"", "1"}}));
  EXPECT_FALSE(keep({{"ball.", "1"}}));
  EXPECT_FALSE(keep({{"ball.stiffness", "[1, "}}));
}

TEST(KeptScene, MakesFileNamesAbsolute) {
  const fs::path folder = support::scratch_folder() / "kept_beside";
  fs::create_directories(folder);
  std::ofstream(folder / "ball.off") << "OFF\n";
  std::ofstream(folder / "arm.yaml") << "name: a\n";
  const YAML::Node all = YAML::LoadFile(keep({}, folder).value().string());
  EXPECT_EQ(all["arm"].as<std::string>(), (folder / "arm.yaml").string());
  EXPECT_EQ(all["objects"][0]["mesh"].as<std::string>(), (folder / "ball.off").string());
  EXPECT_EQ(all["objects"][1]["mesh"].as<std::string>(), "cgal:cow.off");
}

TEST(KeptScene, RejectsInvalidScenesAndReadOnlyFolders) {
  for (const char* text : {"", "- a\n- b\n", "a: [1, \n", "a: 1\n---\nb: 2\n"}) {
    EXPECT_FALSE(keep_scene(text, {}, "/nowhere", kInto)) << text;
  }
  EXPECT_NE(
      keep_scene("a: [1, \n", {}, "/nowhere", kInto).error().message.find("the scene's text:"),
      std::string::npos);
  const auto nowhere = keep_scene(kTwoBalls, {}, "/nowhere", "/proc/thimble");
  ASSERT_FALSE(nowhere);
  EXPECT_NE(nowhere.error().message.find("XDG_STATE_HOME"), std::string::npos);
}

TEST(CopiedScene, RunsAnywhereIfItCameWithThimble) {
  const fs::path copy = support::scratch_folder() / "copies" / "mine.yaml";
  fs::create_directories(copy.parent_path());
  for (const ShippedFile& shipped : shipped_scenes()) {
    fs::copy_file(shipped.path, copy, fs::copy_options::overwrite_existing);
    const auto original = load_scene(shipped.path, {.several_arms = true});
    if (!original && original.error().message.find("is a scan") != std::string::npos) continue;
    ASSERT_TRUE(original.ok()) << original.error().message;
    const auto copied = load_scene(copy, {.several_arms = true});
    ASSERT_TRUE(copied.ok()) << copied.error().message;
    EXPECT_EQ(fs::weakly_canonical(copied->arms.front().arm_file),
              fs::weakly_canonical(original->arms.front().arm_file));
    for (std::size_t i = 0; i < original->objects.size(); ++i) {
      EXPECT_EQ(fs::weakly_canonical(copied->objects[i].mesh_file),
                fs::weakly_canonical(original->objects[i].mesh_file));
    }
  }
}

TEST(SceneInputs, AreAllFilesThatALineNames) {
  const fs::path folder = support::scratch_folder() / "scene_inputs";
  fs::create_directories(folder);
  for (const char* name : {"arm.yaml", "ball.off", "height map.png"}) {
    std::ofstream(folder / name) << "content";
  }
  std::ofstream(folder / "scene.yaml") << "arm: arm.yaml\nmesh: height map.png\n"
                                          "objects: [{mesh: absent.off, map: ball.off}]\n";
  std::set<fs::path> expected;
  for (const char* name : {"scene.yaml", "arm.yaml", "height map.png", "ball.off"}) {
    expected.insert(folder / name);
  }
  const auto inputs = scene_inputs(folder / "scene.yaml");
  EXPECT_EQ(std::set<fs::path>(inputs.begin(), inputs.end()), expected);
}

}  // namespace
}  // namespace thimble::scene
