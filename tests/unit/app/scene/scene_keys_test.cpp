// The reference of keys matches the readers: it has every key of the shipped files, with unit,
// limits and default.
#include "scene_keys.h"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace thimble::scene {
namespace {

bool has(const std::vector<KeyNote>& keys, const std::string& place, const std::string& key) {
  return std::any_of(keys.begin(), keys.end(),
                     [&](const KeyNote& note) { return note.place == place && note.key == key; });
}

/// Collects the keys of a file that are missing in the reference.
void collect_unknown(const YAML::Node& node, const std::string& place,
                     const std::vector<KeyNote>& keys, std::set<std::string>& unknown) {
  if (node.IsSequence()) {
    for (const YAML::Node& entry : node) {
      if (entry.IsMap()) collect_unknown(entry, place + "[]", keys, unknown);
    }
    return;
  }
  if (!node.IsMap()) return;
  std::string here = place;
  if (place == "objects[].effects[]") {
    for (const char* group : {"friction", "texture", "adhesion"}) {
      if (node[group]) here = std::string("effects[] ") + group + ": " + node[group].Scalar();
    }
  }
  if (place == "objects[]" && node["field"]) here = "objects[] field: " + node["field"].Scalar();
  for (const auto& pair : node) {
    const std::string key = pair.first.Scalar();
    if (!has(keys, here, key) && !has(keys, place, key)) unknown.insert(here + "/" + key);
    collect_unknown(pair.second, here.empty() ? key : here + "." + key, keys, unknown);
  }
}

std::set<std::string> unknown_in(const std::filesystem::path& folder,
                                 const std::vector<KeyNote>& keys, int& files) {
  std::set<std::string> unknown;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".yaml") continue;
    ++files;
    collect_unknown(YAML::LoadFile(entry.path()), "", keys, unknown);
  }
  return unknown;
}

TEST(SceneKeys, HaveEveryKeyOfEveryShippedScene) {
  const auto keys = scene_keys();
  ASSERT_TRUE(keys) << keys.error().message;
  int files = 0;
  EXPECT_EQ(unknown_in(std::filesystem::path(THIMBLE_SOURCE_DIR) / "app/scenes", *keys, files),
            std::set<std::string>{});
  EXPECT_GE(files, 13);
}

TEST(SceneKeys, HaveEveryKeyOfEveryShippedArm) {
  const auto keys = arm_keys();
  int files = 0;
  EXPECT_EQ(unknown_in(std::filesystem::path(THIMBLE_SOURCE_DIR) / "app/arms", keys, files),
            std::set<std::string>{});
  EXPECT_GE(files, 5);
}

TEST(SceneKeys, HaveMeaningUnitLimitsAndDefault) {
  const auto keys = scene_keys();
  ASSERT_TRUE(keys);
  const std::string text = key_text(*keys, "rate");
  EXPECT_NE(text.find("a number from 10 to 100000 Hz; default 1000"), std::string::npos) << text;
  EXPECT_NE(key_text(*keys, "stiffness").find("a number from 0 to 100000 N/m; sometimes required"),
            std::string::npos);
  EXPECT_NE(key_text(*keys, "search").find("optional"), std::string::npos);
  EXPECT_NE(text.find("\n                         Rate of the servo loop.\n"), std::string::npos)
      << text;
  EXPECT_EQ(key_text(*keys, "colour"), "");
}

TEST(SceneKeys, DistinguishRequiredAndSometimesRequired) {
  const auto keys = scene_keys();
  ASSERT_TRUE(keys);
  EXPECT_NE(key_text(*keys, "duration").find("; required"), std::string::npos);
  EXPECT_NE(key_text(*keys, "near").find("; sometimes required"), std::string::npos);
  EXPECT_NE(key_text(arm_keys(), "geometry").find("; sometimes required"), std::string::npos);
}

// Keys that exclude each other, a key in an optional map, and keys of a list.
TEST(SceneKeys, IncludeKeysThatDependOnOthers) {
  const auto keys = scene_keys();
  ASSERT_TRUE(keys);
  EXPECT_TRUE(has(*keys, "objects[]", "size"));
  EXPECT_TRUE(has(*keys, "objects[]", "scale"));
  EXPECT_TRUE(has(*keys, "objects[].open", "thickness"));
  EXPECT_TRUE(has(*keys, "objects[].contact", "profile"));
  EXPECT_TRUE(has(*keys, "effects[] friction: bristle", "stiffness"));
  EXPECT_TRUE(has(*keys, "effects[] friction: bristle", "z_max"));
  EXPECT_TRUE(has(*keys, "objects[] field: charges.charges[]", "position"));
  EXPECT_TRUE(has(*keys, "hand.path[]", "press"));
  EXPECT_TRUE(has(*keys, "gate", "energy"));
}

}  // namespace
}  // namespace thimble::scene
