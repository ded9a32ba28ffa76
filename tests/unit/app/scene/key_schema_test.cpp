// The JSON Schema of scene and arm files: it lists the keys of the readers, accepts the files that
// come with Thimble, and rejects wrong keys, types and values.
#include "keys/key_schema.h"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <fstream>
#include <optional>
#include <set>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "keys/key_meanings.h"
#include "scene_keys.h"
#include "yaml/yaml_words.h"

namespace thimble::scene {
namespace {

namespace fs = std::filesystem;

bool is_plain(const YAML::Node& value) {
  return value.IsScalar() && value.Tag() != "!";
}

std::optional<double> number_of(const YAML::Node& value) {
  return is_plain(value) ? to_number(value.Scalar()) : std::nullopt;
}

bool has_type(const YAML::Node& value, const std::string& type) {
  if (type == "object") return value.IsMap();
  if (type == "array") return value.IsSequence();
  if (type == "string") return value.IsScalar();
  if (type == "number") return number_of(value).has_value();
  if (type == "integer") return is_plain(value) && to_whole(value.Scalar()).has_value();
  const bool is_bool = value.IsScalar() && (value.Scalar() == "true" || value.Scalar() == "false");
  return type == "boolean" && is_plain(value) && is_bool;
}

bool equals(const YAML::Node& value, const YAML::Node& allowed) {
  const auto number = number_of(allowed);
  if (number) return number_of(value) == number;
  return value.IsScalar() && value.Scalar() == allowed.Scalar();
}

std::string flaw_of(const YAML::Node& schema, const YAML::Node& value);

/// Returns how many of a list of schemas a value satisfies.
int satisfied(const YAML::Node& schemas, const YAML::Node& value) {
  int count = 0;
  for (const auto& one : schemas) count += flaw_of(one, value).empty();
  return count;
}

std::string flaw_of_map(const YAML::Node& schema, const YAML::Node& value) {
  if (schema["required"]) {
    for (const auto& key : schema["required"]) {
      if (!value[key.Scalar()]) return key.Scalar() + " is missing";
    }
  }
  if (schema["dependentRequired"]) {
    for (const auto& pair : schema["dependentRequired"]) {
      if (!value[pair.first.Scalar()]) continue;
      for (const auto& key : pair.second) {
        if (!value[key.Scalar()]) return key.Scalar() + " is missing";
      }
    }
  }
  for (const auto& pair : value) {
    const std::string key = pair.first.Scalar();
    const bool listed = schema["properties"] && schema["properties"][key];
    if (!listed && schema["additionalProperties"]) return key + " is unknown";
    if (!listed) continue;
    const std::string flaw = flaw_of(schema["properties"][key], pair.second);
    if (!flaw.empty()) return key + ": " + flaw;
  }
  return {};
}

std::string flaw_of_list(const YAML::Node& schema, const YAML::Node& value) {
  if (schema["minItems"] && value.size() < schema["minItems"].as<std::size_t>()) return "too short";
  if (schema["maxItems"] && value.size() > schema["maxItems"].as<std::size_t>()) return "too long";
  for (std::size_t i = 0; i < value.size(); ++i) {
    const YAML::Node item = schema["prefixItems"] ? schema["prefixItems"][i] : schema["items"];
    if (!item) continue;
    const std::string flaw = flaw_of(item, value[i]);
    if (!flaw.empty()) return flaw;
  }
  return {};
}

/// Returns the first reason why a value does not satisfy a schema, or an empty text. It knows the
/// keywords that `key_schema` writes.
std::string flaw_of(const YAML::Node& schema, const YAML::Node& value) {
  if (schema.IsScalar()) return schema.Scalar() == "true" ? "" : "not allowed";
  if (const YAML::Node type = schema["type"]) {
    bool fits = type.IsScalar() && has_type(value, type.Scalar());
    for (const auto& one : type) fits = fits || has_type(value, one.Scalar());
    if (!fits) return "wrong type";
  }
  if (schema["minLength"] && value.Scalar().empty()) return "empty text";
  if (schema["minimum"] && *number_of(value) < *number_of(schema["minimum"])) return "too small";
  if (schema["maximum"] && *number_of(value) > *number_of(schema["maximum"])) return "too large";
  if (schema["const"] && !equals(value, schema["const"])) return "another word";
  if (schema["enum"]) {
    bool listed = false;
    for (const auto& one : schema["enum"]) listed = listed || equals(value, one);
    if (!listed) return "not one of the choices";
  }
  if (value.IsMap()) {
    if (const std::string flaw = flaw_of_map(schema, value); !flaw.empty()) return flaw;
  }
  if (value.IsSequence()) {
    if (const std::string flaw = flaw_of_list(schema, value); !flaw.empty()) return flaw;
  }
  if (schema["not"] && flaw_of(schema["not"], value).empty()) return "a forbidden combination";
  if (schema["anyOf"] && satisfied(schema["anyOf"], value) == 0) return "none of the forms";
  if (schema["oneOf"] && satisfied(schema["oneOf"], value) != 1) return "not exactly one form";
  if (schema["if"] && flaw_of(schema["if"], value).empty()) {
    if (const std::string flaw = flaw_of(schema["then"], value); !flaw.empty()) return flaw;
  }
  for (const auto& one : schema["allOf"]) {
    if (const std::string flaw = flaw_of(one, value); !flaw.empty()) return flaw;
  }
  return {};
}

/// Returns the keys of a schema as "place/key".
void collect_keys(const YAML::Node& schema, const std::string& place, std::set<std::string>& keys) {
  for (const auto& pair : schema["properties"]) {
    if (!pair.second.IsMap()) continue;  // described elsewhere
    const std::string key = pair.first.Scalar();
    keys.insert(place + '/' + key);
    const std::string below = place.empty() ? key : place + '.' + key;
    if (pair.second["properties"]) collect_keys(pair.second, below, keys);
    const YAML::Node items = pair.second["items"];
    if (items && items["properties"]) collect_keys(items, below + "[]", keys);
  }
  for (const auto& part : schema["allOf"]) {
    if (!part["then"]) continue;
    std::string of = place;
    for (const auto& pair : part["if"]["properties"]) {
      of = place.substr(place.rfind('.') + 1) + ' ' + pair.first.Scalar() + ": " +
           pair.second[pair.second["const"] ? "const" : "title"].Scalar();
    }
    collect_keys(part["then"], of, keys);
  }
}

std::set<std::string> keys_in(const std::vector<KeyNote>& notes) {
  std::set<std::string> keys;
  for (const KeyNote& note : notes) keys.insert(note.place + '/' + note.key);
  return keys;
}

YAML::Node scene_schema() {
  static const std::string kText = key_schema(scene_keys().value(), "scene");
  return YAML::Load(kText);
}

YAML::Node arm_schema() {
  static const std::string kText = key_schema(arm_keys(), "arm");
  return YAML::Load(kText);
}

int check_files(const fs::path& folder, const YAML::Node& schema) {
  int files = 0;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".yaml") continue;
    ++files;
    EXPECT_EQ(flaw_of(schema, YAML::LoadFile(entry.path())), "") << entry.path();
  }
  return files;
}

/// Returns the complete scenes among the YAML blocks of the guide.
std::vector<std::string> guide_scenes() {
  std::vector<std::string> scenes;
  for (const auto& entry :
       fs::directory_iterator(fs::path(THIMBLE_SOURCE_DIR) / "app/guide/pages")) {
    if (entry.path().extension() != ".md") continue;
    std::ifstream page(entry.path());
    std::string line, block;
    bool inside = false;
    while (std::getline(page, line)) {
      if (line == "```yaml") {
        inside = true;
        block.clear();
      } else if (line == "```") {
        if (inside && block.starts_with("name: ") && block.find("\nobjects:") != block.npos) {
          scenes.push_back(block);
        }
        inside = false;
      } else if (inside) {
        block += line + '\n';
      }
    }
  }
  return scenes;
}

void check_meanings(const std::vector<KeyNote>& notes, std::span<const KeyMeaning> meanings) {
  std::set<const KeyMeaning*> used;
  for (const KeyNote& note : notes) {
    const std::string name = note.place + '/' + note.key;
    used.insert(meaning_of(meanings, note.place, note.key));
    EXPECT_TRUE(note.meaning.ends_with('.')) << name << ": " << note.meaning;
    EXPECT_EQ(note.meaning.find(". "), std::string::npos) << name << ": " << note.meaning;
    std::istringstream words(note.meaning);
    int count = 0;
    for (std::string word; words >> word;) ++count;
    EXPECT_LE(count, 22) << name << ": " << note.meaning;
  }
  for (const KeyMeaning& meaning : meanings) {
    EXPECT_EQ(used.count(&meaning), 1U) << "not a key: " << meaning.place << '/' << meaning.key;
  }
}

TEST(KeyMeanings, AreOneSentenceForEachKey) {
  check_meanings(scene_keys().value(), scene_meanings());
  check_meanings(arm_keys(), arm_meanings());
}

TEST(KeySchema, ListsTheKeysOfTheReaders) {
  std::set<std::string> scene, arm;
  collect_keys(scene_schema(), "", scene);
  collect_keys(arm_schema(), "", arm);
  EXPECT_EQ(scene, keys_in(scene_keys().value()));
  EXPECT_EQ(arm, keys_in(arm_keys()));
}

TEST(KeySchema, AcceptsTheShippedFiles) {
  EXPECT_GE(check_files(fs::path(THIMBLE_SOURCE_DIR) / "app/scenes", scene_schema()), 13);
  EXPECT_GE(check_files(fs::path(THIMBLE_SOURCE_DIR) / "app/arms", arm_schema()), 5);
}

TEST(KeySchema, AcceptsTheScenesOfTheGuide) {
  const auto scenes = guide_scenes();
  EXPECT_GE(scenes.size(), 2U);
  for (const std::string& scene : scenes) {
    EXPECT_EQ(flaw_of(scene_schema(), YAML::Load(scene)), "") << scene;
  }
}

/// Scene with one line replaced.
std::string flaw_with(const std::string& line, const std::string& instead) {
  std::string text =
      "name: a\n"
      "arm: vintage_phantom\n"
      "duration: 3\n"
      "objects:\n"
      "  - name: ball\n"
      "    sphere: {radius: 0.03}\n"
      "    stiffness: 800\n"
      "    effects: [{friction: bristle, coefficient: 0.5}]\n"
      "    body: {motion: {mass: 0.1, velocity: [0, 0, 1]}}\n"
      "  - {name: weight, field: gravity, mass: 0.1}\n"
      "hand: {path: [{t: 0, at: [0, 0, 0.03]}, {t: 1, on: ball, near: [0, 0, 0]}]}\n";
  if (!line.empty()) {
    const std::size_t at = text.find(line);
    EXPECT_NE(at, std::string::npos) << line;
    text.replace(at, line.size(), instead);
  }
  return flaw_of(scene_schema(), YAML::Load(text));
}

TEST(KeySchema, RejectsWrongKeys) {
  EXPECT_EQ(flaw_with("", ""), "");
  EXPECT_NE(flaw_with("duration:", "durration:"), "");
  EXPECT_NE(flaw_with("stiffness:", "stifness:"), "");
  EXPECT_NE(flaw_with("radius:", "size:"), "");
  EXPECT_NE(flaw_with("coefficient:", "wavelength:"), "");  // a key of another effect
  EXPECT_NE(flaw_with("field: gravity,", "field: gravity, stiffness: 1,"), "");
  EXPECT_NE(flaw_with("t: 0,", "time: 0,"), "");
}

TEST(KeySchema, RejectsWrongTypes) {
  EXPECT_NE(flaw_with("800", "soft"), "");
  EXPECT_NE(flaw_with("{radius: 0.03}", "0.03"), "");
  EXPECT_NE(flaw_with("friction: bristle", "friction: brush"), "");
  EXPECT_NE(flaw_with("[0, 0, 1]", "[0, 1]"), "");
  EXPECT_NE(flaw_with("name: a", "name: ''"), "");
}

TEST(KeySchema, RejectsValuesBeyondTheirLimits) {
  EXPECT_NE(flaw_with("800", "-1"), "");
  EXPECT_NE(flaw_with("800", "100001"), "");
  EXPECT_EQ(flaw_with("800", "100000"), "");
  EXPECT_NE(flaw_with("0.5", "6"), "");
  EXPECT_NE(flaw_with("[0, 0, 0.03]", "[0, 0, 3]"), "");
  EXPECT_NE(flaw_with("mass: 0.1}", "mass: 11}"), "");
}

TEST(KeySchema, RejectsMissingAndConflictingKeys) {
  EXPECT_NE(flaw_with("duration: 3\n", ""), "");
  EXPECT_NE(flaw_with("arm: vintage_phantom\n", ""), "");
  EXPECT_NE(flaw_with("    stiffness: 800\n", ""), "");
  EXPECT_NE(flaw_with(", near: [0, 0, 0]", ""), "");
  EXPECT_NE(flaw_with("    sphere:", "    plane: {}\n    sphere:"), "");
  EXPECT_NE(flaw_with("friction: bristle", "friction: bristle, texture: sandpaper"), "");
}

// A limit that grows with the rate must not mark a valid file.
TEST(KeySchema, HasTheLimitsOfTheHighestRate) {
  EXPECT_EQ(flaw_with("friction: bristle", "friction: paper, corner_frequency: 2000"), "");
}

}  // namespace
}  // namespace thimble::scene
