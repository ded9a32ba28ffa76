// A key of the reference that a file cannot use is never an unknown key: the mistake says what the
// key requires.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "read_scene.h"
#include "scene_keys.h"
#include "thimble/render/effect/effect_table.h"
#include "thimble/render/field/field_table.h"

namespace thimble::scene {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPlane = "  - {name: o, plane: {}, stiffness: 100}\n";
constexpr const char* kPath = "hand: {path: [{t: 0, at: [0, 0, 0]}]}\n";

std::string scene_text(const std::string& objects, const std::string& hand) {
  return "name: test\narm: vintage_phantom\nduration: 1\nobjects:\n" + objects + hand;
}

std::string mistakes_of_scene(const std::string& text) {
  auto yaml = YamlFile::parse(text, "scene.yaml");
  if (!yaml) return yaml.error().message;
  const auto scene = read_scene(*yaml, "scene.yaml", {});
  return scene ? "" : scene.error().message;
}

std::string mistakes_of_arm(const std::string& text) {
  auto yaml = YamlFile::parse(text, "arm.yaml");
  if (!yaml) return yaml.error().message;
  const auto arm = read_arm(*yaml);
  return arm ? "" : arm.error().message;
}

/// A text with one map of a place; `@` is where a further key is inserted.
using Variant = std::pair<std::string, std::string>;

std::vector<Variant> scene_variants() {
  std::vector<Variant> variants = {{"", scene_text(kPlane, kPath) + "@: x\n"}};
  const auto add_object = [&](const std::string& place, const std::string& keys) {
    variants.emplace_back(place, scene_text("  - {name: o, " + keys + "}\n", kPath));
  };
  for (const char* form :
       {"plane: {}", "sphere: {radius: 0.1}", "box: {sides: [1, 1, 1]}",
        "cylinder: {radius: 0.1, height: 0.1}", "torus: {radius: 0.1, tube: 0.01}"}) {
    add_object("objects[]", std::string(form) + ", stiffness: 1, @: x");
  }
  add_object("objects[]", "stiffness: 1, @: x");
  add_object("objects[].contact", "mesh: none.off, stiffness: 1, contact: {@: x}");
  for (const render::FieldKind& kind : render::field_table()) {
    add_object("objects[]", fmt::format("field: {}, @: x", kind.name));
  }
  for (const render::EffectKind& kind : render::effect_table()) {
    add_object(fmt::format("effects[] {}: {}", kind.group, kind.name),
               fmt::format("plane: {{}}, stiffness: 1, effects: [{{{}: {}, @: x}}]", kind.group,
                           kind.name));
  }
  for (const char* target : {"point: [0, 0, 0]", "from: [0, 0, 0]", "point: [0, 0, 0], to: x"}) {
    add_object("objects[] field: magnetic_snap.targets[]",
               fmt::format("field: magnetic_snap, targets: [{{{}, @: x}}]", target));
  }
  add_object("objects[].body.motion", "plane: {}, stiffness: 1, body: {motion: {mass: 1, @: x}}");
  for (const char* body : {"dent", "plastic", "snap"}) {
    add_object(std::string("objects[].body.") + body,
               fmt::format("plane: {{}}, stiffness: 1, body: {{{}: {{@: x}}}}", body));
  }
  add_object("objects[].body.dent", "plane: {}, stiffness: 1, body: {dent: {region: whole, @: x}}");
  const auto add_hand = [&](const std::string& place, const std::string& keys) {
    variants.emplace_back(place, scene_text(kPlane, "hand: {" + keys + "}\n"));
  };
  add_hand("hand", "path: [{t: 0, at: [0, 0, 0]}], @: x");
  add_hand("hand", "bag: none.db3, @: x");
  add_hand("hand", "@: x");
  for (const char* target :
       {"at: [0, 0, 0]", "on: o, near: [0, 0, 0]", "stop: true", "at: [0, 0, 0], on: o"}) {
    add_hand("hand.path[]", fmt::format("path: [{{t: 0, {}, @: x}}]", target));
  }
  return variants;
}

/// Checks each key of the variant's place.
template <class Read>
void expect_explained(const Variant& variant, const std::vector<KeyNote>& keys, Read read) {
  int count = 0;
  for (const KeyNote& note : keys) {
    if (note.place != variant.first) continue;
    ++count;
    std::string text = variant.second;
    text.replace(text.find('@'), 1, note.key);
    const std::string mistakes = read(text);
    EXPECT_EQ(mistakes.find(note.key + ": unknown key"), std::string::npos)
        << variant.second << mistakes;
  }
  EXPECT_GT(count, 0) << variant.first;
}

TEST(UnusedKeys, OfScenesAreExplained) {
  const auto keys = scene_keys();
  ASSERT_TRUE(keys) << keys.error().message;
  for (const Variant& variant : scene_variants()) {
    expect_explained(variant, *keys, mistakes_of_scene);
  }
}

TEST(UnusedKeys, OfArmsAreExplained) {
  const auto keys = arm_keys();
  int files = 0;
  for (const auto& file : fs::directory_iterator(fs::path(THIMBLE_SOURCE_DIR) / "app/arms")) {
    if (file.path().extension() != ".yaml") continue;
    ++files;
    std::ostringstream stream;
    stream << std::ifstream(file.path()).rdbuf();
    const std::string text = '\n' + stream.str();
    expect_explained({"", "@: x" + text}, keys, mistakes_of_arm);
    for (const std::string section : {"joints", "simulation", "gravity_compensation"}) {
      const std::size_t begin = text.find('\n' + section + ":\n");
      std::string with = text + section + ": {@: x}\n";
      if (begin != std::string::npos) {
        with = text;
        with.insert(begin + section.size() + 3, "  @: x\n");
      }
      expect_explained({section, with}, keys, mistakes_of_arm);
    }
  }
  EXPECT_GE(files, 5);
}

TEST(UnusedKeys, SayWhatTheyRequire) {
  const auto of_object = [](const std::string& keys) {
    return mistakes_of_scene(scene_text("  - {name: o, " + keys + "}\n", kPath));
  };
  EXPECT_EQ(of_object("sphere: {radius: 0.1}, stiffness: 1, repair: true"),
            "scene.yaml:5: repair: needs mesh.");
  EXPECT_EQ(of_object("sphere: {radius: 0.1}, stiffness: 1, budget: 16"),
            "scene.yaml:5: budget: needs mesh.");
  EXPECT_EQ(of_object("field: gravity, mass: 1, stiffness: 1"),
            "scene.yaml:5: stiffness: needs a surface: a mesh or a shape.");
  EXPECT_EQ(of_object("plane: {}, stiffness: 1, body: {motion: {mass: 1, hold_damping: 1}}"),
            "scene.yaml:5: hold_damping: needs hold, the stiffness of the grip in N/m.");
  EXPECT_EQ(of_object("plane: {}, stiffness: 1, body: {motion: {mass: 1, density: 900}}"),
            "scene.yaml:5: mass: cannot be combined with density.");
  EXPECT_EQ(mistakes_of_scene(scene_text(kPlane, kPath) + "faults: apart\n"),
            "scene.yaml:7: faults: needs arms, a list of two arms or more.");
  EXPECT_EQ(mistakes_of_scene(
                scene_text(kPlane, "hand: {path: [{t: 0, at: [0, 0, 0], press: 0.001}]}\n")),
            "scene.yaml:6: press: needs on, an object, instead of at.");
}

TEST(UnusedKeys, ObjectsAndHandsListTheirChoices) {
  EXPECT_EQ(mistakes_of_scene(scene_text("  - {name: o, stiffness: 1}\n", kPath)),
            "scene.yaml:5: expected one of mesh, plane, sphere, box, cylinder, capsule, cone, "
            "torus and field, found none.");
  EXPECT_EQ(mistakes_of_scene(scene_text("  - {name: o, mash: a.off, stiffness: 1}\n", kPath)),
            "scene.yaml:5: expected one of mesh, plane, sphere, box, cylinder, capsule, cone, "
            "torus and field, found none.\n"
            "scene.yaml:5: mash: unknown key (did you mean \"mesh\"?).");
  EXPECT_EQ(mistakes_of_scene(scene_text(kPlane, "hand: {}\n")),
            "scene.yaml:6: hand: expected either path or bag, found neither.");
  EXPECT_EQ(mistakes_of_scene(scene_text(kPlane, "")), "scene.yaml:1: hand: is missing.");
}

}  // namespace
}  // namespace thimble::scene
