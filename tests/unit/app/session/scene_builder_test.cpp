// Scenes made in code: they run bit-identically to the same scenes in files, are written as files
// that read back equal, and have the checks and messages of files.
#include "thimble/scene/scene_builder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "support/meshes/shapes.h"
#include "support/run_hash.h"
#include "support/scratch.h"
#include "text_file.h"
#include "thimble/render/mesh/mesh_file.h"
#include "thimble/render/surface/surface_response.h"
#include "thimble/scene/scene_objects.h"
#include "thimble/scene/shipped_files.h"
#include "thimble/session/recording.h"
#include "thimble/session/session.h"
#include "yaml/yaml_node.h"
#include "yaml/yaml_words.h"

namespace thimble {
namespace {

using Eigen::Vector3d;
using scene::SceneBuilder;
using scene::SceneMap;
using scene::SceneValue;
using session::Session;
using session::SessionOptions;

class SceneBuilderTest : public ::testing::Test {
 protected:
  void SetUp() override { std::filesystem::current_path(THIMBLE_SOURCE_DIR); }

  /// Returns the hash of all arms of a run of 2 s; fails the test if there is none, or no contact.
  template <class Scene>
  static std::uint64_t hash_of(const Scene& scene) {
    auto run =
        Session::open(scene, {.duration = 2, .mesh_folder = THIMBLE_MESHES, .several_arms = true});
    if (!run) {
      ADD_FAILURE() << run.error().message;
      return 0;
    }
    (*run)->run();
    support::RunHash hash;
    bool touched = false;
    for (std::size_t arm = 0; arm < (*run)->arms(); ++arm) {
      for (const driver::TickRecord& tick : (*run)->ticks(arm)) {
        hash.add(tick);
        touched = touched || tick.in_contact;
      }
    }
    EXPECT_TRUE(touched);
    return hash.value();
  }
  static std::string error_of(const SceneBuilder& scene) {
    const auto built = scene.build();
    return built ? "no error" : built.error().message;
  }
  /// Returns a valid scene with a ball.
  static SceneBuilder ball() {
    SceneBuilder scene("ball");
    scene.arm("vintage_phantom").duration(2);
    scene.object("ball").sphere(0.03).position({0, 0, -0.03}).stiffness(500).damping(1);
    scene.hand().at(0, {0, 0, 0.02}).on(1, "ball", {0, 0, 0}, 0.004).at(2, {0, 0, 0.02});
    return scene;
  }
  /// Returns a valid scene with a mesh in memory; its hand presses the mesh.
  static SceneBuilder mesh_scene(render::TriangleMesh mesh) {
    SceneBuilder scene("own mesh");
    scene.arm("vintage_phantom").duration(2);
    scene.object("body").mesh(std::move(mesh)).position({0, 0, -0.02}).stiffness(500).damping(1);
    scene.hand().at(0, {0, 0, 0.03}).on(1, "body", {0, 0, 0.02}, 0.004).at(2, {0, 0, 0.03});
    return scene;
  }
};

TEST_F(SceneBuilderTest, ShapesGiveTheForcesOfTheFile) {
  SceneBuilder scene("box");
  scene.arm("vintage_phantom").duration(8).seed(1);
  scene.object("entry_face")
      .set("box", SceneMap{{"sides", Vector3d(0.03, 0.03, 0.03)}, {"form", "entry_face"}})
      .position({0, -0.04, 0})
      .stiffness(300)
      .damping(1);
  scene.object("wedges")
      .set("box", SceneMap{{"sides", Vector3d(0.03, 0.03, 0.03)}, {"form", "wedges"}})
      .position({0, 0.04, 0})
      .stiffness(300)
      .damping(1);
  scene.hand()
      .at(0, {0, -0.04, 0.03})
      .at(1, {0, -0.04, 0.008}, true)
      .at(2.5, {0, -0.023, 0.008}, true)
      .at(3.5, {0, -0.01, 0.03});
  EXPECT_EQ(hash_of(scene), hash_of("box"));
}

TEST_F(SceneBuilderTest, FrictionGivesTheForcesOfTheFile) {
  SceneBuilder scene("rubber");
  scene.arm("vintage_phantom").duration(6).seed(1);
  scene.object("ball")
      .sphere(0.04)
      .position({0, 0, -0.03})
      .stiffness(400)
      .damping(2)
      .friction("bristle", {{"coefficient", 0.8}, {"static_coefficient", 1}});
  scene.hand()
      .at(0, {0, -0.02, 0.04})
      .on(1, "ball", {0, -0.02, 0.006}, 0.006)
      .on(2.2, "ball", {0, 0.02, 0.006}, 0.006)
      .on(3.2, "ball", {0.02, 0, 0.004}, 0.008, true)
      .on(4.2, "ball", {0.02, 0, 0.004}, 0.008, true)
      .on(5.2, "ball", {0.01, -0.02, 0.006}, 0.004)
      .at(6, {0, -0.03, 0.04});
  EXPECT_EQ(hash_of(scene), hash_of("rubber"));
}

TEST_F(SceneBuilderTest, AScannedMeshGivesTheForcesOfTheFile) {
  if (!std::filesystem::exists(std::string(THIMBLE_MESHES) + "/elephant.off")) {
    GTEST_SKIP() << "The scan elephant.off is missing; install libcgal-demo.";
  }
  SceneBuilder scene("elephant");
  scene.arm("vintage_phantom").rate(1000).duration(10).seed(1);
  scene.object("elephant")
      .mesh("cgal:elephant.off")
      .size(0.1)
      .rotate('x', 90)
      .rotate('z', 115)
      .position({0, 0, 0})
      .stiffness(800)
      .damping(1);
  scene.hand()
      .at(0, {0.012, -0.012, 0.040})
      .on(1.2, "elephant", {0.012, -0.012, 0}, 0.003)
      .on(1.9, "elephant", {0.016, -0.018, -0.004}, 0.005)
      .on(2.6, "elephant", {0.030, -0.012, -0.010}, 0.005)
      .on(3.3, "elephant", {0.032, -0.002, -0.020}, 0.005)
      .on(4.0, "elephant", {0.022, 0.009, -0.018}, 0.004)
      .on(4.8, "elephant", {0.032, -0.004, -0.016}, 0.006)
      .on(5.4, "elephant", {0.030, -0.016, -0.022}, 0.004)
      .at(6.0, {0.058, -0.010, -0.010})
      .at(6.8, {0.046, 0.026, 0.016})
      .on(7.4, "elephant", {0.014, 0.023, 0.014}, 0.003)
      .on(8.1, "elephant", {0.015, 0.027, 0.023}, 0.004)
      .on(8.8, "elephant", {0.023, 0.026, 0.036}, 0.004)
      .at(9.4, {0.050, 0.024, 0.044})
      .at(10.0, {0.050, 0.010, 0.044});
  EXPECT_EQ(hash_of(scene), hash_of("elephant"));
}

TEST_F(SceneBuilderTest, TwoHandsGiveTheForcesOfTheFile) {
  SceneBuilder scene("two_hands");
  scene.duration(8).seed(1).set("faults", "together");
  scene.add_arm("left", "vintage_phantom")
      .at({0, -0.06, 0})
      .hand()
      .at(0, {0, -0.045, -0.03})
      .at(1.5, {0, -0.045, 0.02}, true)
      .at(3, {0, -0.045, 0.04}, true)
      .at(4.5, {0, -0.045, 0}, true)
      .at(5.5, {0.02, -0.045, 0.01}, true)
      .at(7, {0, -0.045, -0.028}, true)
      .at(8, {0, -0.045, -0.028});
  scene.add_arm("right", "vintage_phantom")
      .at({0, 0.06, 0}, 180)
      .hand()
      .at(0, {0, 0.045, -0.03})
      .at(1.5, {0, 0.045, 0.02}, true)
      .at(3, {0, 0.045, 0}, true)
      .at(4.5, {0, 0.045, 0.04}, true)
      .at(5.5, {-0.02, 0.045, 0.01}, true)
      .at(7, {0, 0.045, -0.028}, true)
      .at(8, {0, 0.045, -0.028});
  scene.object("beam")
      .box({0.02, 0.12, 0.02})
      .position({0, 0, -0.03})
      .stiffness(700)
      .damping(2)
      .friction("bristle", {{"coefficient", 0.4}})
      .body({{"motion", SceneMap{{"kind", "rigid"},
                                 {"mass", 0.15},
                                 {"gravity", Vector3d(0, 0, -9.81)},
                                 {"floor", -0.04},
                                 {"floor_friction", 0.4},
                                 {"damping", 0.2},
                                 {"angular_damping", 0.0002},
                                 {"hold", 400},
                                 {"hold_damping", 3},
                                 {"hold_force", 4}}}});
  EXPECT_EQ(hash_of(scene), hash_of("two_hands"));
}

/// Returns a value as in a file.
SceneValue value_of(const scene::YamlNode& node) {
  if (node.is_map()) {
    SceneMap map;
    node.each_pair([&](const scene::YamlNode& key, const scene::YamlNode& value) {
      map.set(key.text(), value_of(value));
    });
    return map;
  }
  if (node.is_list()) {
    std::vector<SceneValue> list;
    node.each_entry([&](const scene::YamlNode& entry) { list.push_back(value_of(entry)); });
    return list;
  }
  if (const auto number = scene::to_number(node)) return *number;
  if (scene::is_plain_scalar(node) && (node.text() == "true" || node.text() == "false")) {
    return node.text() == "true";
  }
  return std::string(node.text());
}

/// Returns whether two nodes have equal values: numbers with equal bits, and equal texts.
bool equal(const scene::YamlNode& a, const scene::YamlNode& b) {
  if (a.type() != b.type() || a.size() != b.size()) return false;
  if (a.is_scalar()) {
    const auto number = scene::to_number(a);
    return number ? number == scene::to_number(b) : a.text() == b.text();
  }
  std::vector<scene::YamlNode> left, right;
  const auto collect = [](std::vector<scene::YamlNode>& all, const scene::YamlNode& node) {
    node.each_entry([&](const scene::YamlNode& entry) { all.push_back(entry); });
    node.each_pair([&](const scene::YamlNode& key, const scene::YamlNode& value) {
      all.push_back(key);
      all.push_back(value);
    });
  };
  collect(left, a);
  collect(right, b);
  for (std::size_t i = 0; i < left.size(); ++i) {
    if (!equal(left[i], right[i])) return false;
  }
  return true;
}

TEST_F(SceneBuilderTest, WritesEveryShippedSceneWithEqualValues) {
  const auto scenes = scene::shipped_scenes();
  ASSERT_GE(scenes.size(), 20u);
  for (const scene::ShippedFile& one : scenes) {
    const scene::YamlNode root = scene::read_yaml(scene::text_of(one.path)).root;
    SceneBuilder built("");
    root.each_pair([&](const scene::YamlNode& key, const scene::YamlNode& value) {
      built.set(key.text(), value_of(value));
    });
    const auto text = built.yaml();
    ASSERT_TRUE(text) << text.error().message;
    EXPECT_TRUE(equal(root, scene::read_yaml(*text).root)) << one.name << "\n" << *text;
  }
}

TEST_F(SceneBuilderTest, AMeshInMemoryGivesTheForcesOfItsFile) {
  const auto folder = support::scratch_folder() / "mesh_in_memory";
  std::filesystem::create_directories(folder);
  render::TriangleMesh mesh = support::icosphere(2, 0.03);
  // A second vertex at the place of another one is merged, as in a file.
  std::int32_t& corner = mesh.triangles.front()[0];
  mesh.vertices.push_back(mesh.vertices[static_cast<std::size_t>(corner)]);
  corner = static_cast<std::int32_t>(mesh.vertices.size() - 1);
  ASSERT_TRUE(render::save_mesh(mesh, folder / "body.off"));
  SceneBuilder named("own mesh");
  named.folder(folder).arm("vintage_phantom").duration(2);
  named.object("body").mesh("body.off").position({0, 0, -0.02}).stiffness(500).damping(1);
  named.hand().at(0, {0, 0, 0.03}).on(1, "body", {0, 0, 0.02}, 0.004).at(2, {0, 0, 0.03});
  EXPECT_EQ(hash_of(mesh_scene(mesh)), hash_of(named));
}

TEST_F(SceneBuilderTest, ASavedSceneGivesTheSameForces) {
  const auto file = support::scratch_folder() / "saved scene" / "ball.yaml";
  std::filesystem::create_directories(file.parent_path());
  const SceneBuilder scene = mesh_scene(support::icosphere(2, 0.03));
  const auto saved = scene.save(file);
  ASSERT_TRUE(saved) << saved.error().message;
  EXPECT_EQ(hash_of(file.string()), hash_of(scene));
}

TEST_F(SceneBuilderTest, FilesOfASceneSavedElsewhereAreFound) {
  const auto file = support::scratch_folder() / "saved_elsewhere.yaml";
  SceneBuilder scene("can");
  scene.folder(std::string(THIMBLE_SOURCE_DIR) + "/app/scenes").arm("vintage_phantom").duration(2);
  scene.object("can").mesh("clay_ball.off").stiffness(500);
  scene.hand().at(0, {0, 0, 0.05});
  ASSERT_TRUE(scene.save(file));
  const auto read = scene::load_scene(file);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->objects.front().mesh_file,
            std::filesystem::path(THIMBLE_SOURCE_DIR) / "app/scenes/clay_ball.off");
}

TEST_F(SceneBuilderTest, TextsOfAnyCharactersReadBackEqual) {
  for (const std::string text :
       {"a \"quoted\" \\ text", "two\nlines\tand a tab", "true", "12", "null", "~", "- x", "a: b",
        "# no comment", "größe", " blanks ", "nan", "{x}", "x\x01y", "e5", "/a/b.c"}) {
    SceneBuilder scene = ball();
    scene.description(text);
    const auto built = scene.build();
    ASSERT_TRUE(built) << built.error().message;
    EXPECT_EQ(built->description, text);
  }
}

TEST_F(SceneBuilderTest, ErrorsNameTheObjectAndTheField) {
  SceneBuilder scene = ball();
  scene.object("cube").box({0.02, 0.02, 0.02}).stiffness(-1);
  EXPECT_EQ(error_of(scene),
            "object 2 'cube': stiffness: expected a number from 0 to 100000 N/m, found \"-1\".");
}

TEST_F(SceneBuilderTest, ErrorsNamePlacesWithinAnObject) {
  SceneBuilder scene = ball();
  scene.object("cube")
      .box({0.02, 0.02, 0.02})
      .stiffness(300)
      .friction("bristle", {{"coefficient", -1}})
      .body({{"motion", SceneMap{{"kind", "rigid"}, {"mass", "heavy"}}}});
  const std::string error = error_of(scene);
  EXPECT_NE(error.find("object 2 'cube': effect 1: coefficient: expected"), std::string::npos)
      << error;
  EXPECT_NE(error.find("\nobject 2 'cube': body: motion: mass: expected"), std::string::npos)
      << error;
}

TEST_F(SceneBuilderTest, ErrorsNamePointsOfTheHand) {
  SceneBuilder scene = ball();
  scene.hand().at(1.5, {0, 0, 25});
  EXPECT_EQ(error_of(scene), "hand: point 4: at: expected a number from -2 to 2 m, found \"25\".");
}

TEST_F(SceneBuilderTest, ErrorsNameOneOfSeveralArms) {
  SceneBuilder scene("arms");
  scene.duration(1);
  scene.add_arm("left", "vintage_phantom").hand().at(-1, {0, 0, 0});
  scene.add_arm("right", "vintage_phantom").at({0, 0.06, 0}, 45).hand().at(0, {0, 0, 0});
  scene.object("ball").sphere(0.03).stiffness(300);
  const auto built = scene.build({.several_arms = true});
  ASSERT_FALSE(built);
  EXPECT_NE(
      built.error().message.find("arm 2 'right': at: turn_degrees: expected a multiple of 90"),
      std::string::npos)
      << built.error().message;
  EXPECT_NE(built.error().message.find("arm 1 'left': hand: point 1: t: expected"),
            std::string::npos)
      << built.error().message;
}

TEST_F(SceneBuilderTest, ErrorsOfTheWholeSceneNameIt) {
  SceneBuilder scene("empty");
  EXPECT_EQ(error_of(scene),
            "scene: arm: is missing.\nscene: duration: is missing.\nscene: objects: is missing.\n"
            "scene: hand: is missing.");
}

TEST_F(SceneBuilderTest, RefusesNumbersThatAreNotFinite) {
  for (const double number :
       {std::nan(""), -std::nan(""), std::numeric_limits<double>::infinity()}) {
    SceneBuilder scene = ball();
    scene.object("cube").sphere(number).stiffness(300);
    EXPECT_EQ(error_of(scene).substr(0, 59),
              "object 2 'cube': sphere: radius: expected a number from 0.0")
        << error_of(scene);
  }
}

TEST_F(SceneBuilderTest, RefusesUnknownKeysWithTheNearestOne) {
  SceneBuilder scene = ball();
  scene.object("cube").sphere(0.02).stiffness(300).set("dampin", 1);
  EXPECT_EQ(error_of(scene), "object 2 'cube': dampin: unknown key (did you mean \"damping\"?).");
}

TEST_F(SceneBuilderTest, RefusesTextsWithUnits) {
  SceneBuilder scene = ball();
  scene.object("cube").sphere(0.02).set("stiffness", "300 N/m");
  EXPECT_EQ(
      error_of(scene),
      "object 2 'cube': stiffness: expected a number from 0 to 100000 N/m, found \"300 N/m\".");
}

TEST_F(SceneBuilderTest, RefusesTextsThatAreNotUtf8) {
  SceneBuilder scene = ball();
  scene.object("cube").sphere(0.02).stiffness(300).set("contact", "gr\xf6\xdf");
  EXPECT_EQ(error_of(scene), "object 2 'cube': a text is not UTF-8; encode it as UTF-8.");
  EXPECT_FALSE(scene.yaml());
}

TEST_F(SceneBuilderTest, SentencesAreThoseOfFiles) {
  SceneBuilder scene("many mistakes");
  scene.arm("vintage_phantom").duration(-1).rate(1);
  scene.object("a").set("sphere", 3).stiffness(300);
  scene.object("b").mesh("no_such_file.off").stiffness(300);
  scene.hand().set("pth", 1);
  const auto file = support::scratch_folder() / "many_mistakes.yaml";
  ASSERT_TRUE(scene.save(file));
  const auto read = scene::load_scene(file);
  ASSERT_FALSE(read);
  scene.folder(file.parent_path());
  // "FILE:LINE: SENTENCE" and "PLACE: SENTENCE".
  const std::string by_code = error_of(scene);
  std::istringstream by_file(read.error().message);
  int sentences = 0;
  for (std::string line; std::getline(by_file, line); ++sentences) {
    if (line.find(": ") == std::string::npos) continue;  // "1 more mistake follows."
    const std::string sentence = line.substr(line.find(": ") + 2);
    EXPECT_NE(by_code.find(": " + sentence), std::string::npos) << sentence << "\n" << by_code;
  }
  EXPECT_GE(sentences, 5);
}

TEST_F(SceneBuilderTest, AMeshInMemoryWithoutAVertexIsRefused) {
  render::TriangleMesh mesh = support::icosphere(1, 0.03);
  mesh.triangles[3][1] = 99;
  const auto scene = mesh_scene(mesh).build();
  ASSERT_TRUE(scene);
  const auto objects = scene::SceneObjects::build(*scene);
  ASSERT_FALSE(objects);
  EXPECT_EQ(objects.error().message,
            "object 1 'body': mesh: triangle 3 names vertex 99, but the vertices are 0 to 41; "
            "correct it.");
}

TEST_F(SceneBuilderTest, AMeshInMemoryWithNanIsRefused) {
  render::TriangleMesh mesh = support::icosphere(1, 0.03);
  mesh.vertices[5].y() = std::nan("");
  const auto scene = mesh_scene(mesh).build();
  ASSERT_TRUE(scene);
  const auto objects = scene::SceneObjects::build(*scene);
  ASSERT_FALSE(objects);
  EXPECT_EQ(objects.error().message.substr(0, 49),
            "object 1 'body': mesh: vertex 5 has a coordinate ");
}

TEST_F(SceneBuilderTest, AnEmptyMeshInMemoryIsRefused) {
  const auto scene = mesh_scene({}).build();
  ASSERT_TRUE(scene);
  const auto objects = scene::SceneObjects::build(*scene);
  ASSERT_FALSE(objects);
  EXPECT_EQ(objects.error().message, "object 1 'body': mesh: it has no triangle; add triangles.");
}

/// Effect of a program: raises the surface by 1 mm.
class Raised {
 public:
  static constexpr std::string_view kGroup = "texture";
  static constexpr std::string_view kName = "raised";
  static constexpr render::EffectOrder kOrder = render::EffectOrder::kDepth;
  struct Settings {
    void read(render::SettingsReader&, const render::EffectContext&) {}
  };
  Raised(const Settings&, const render::EffectContext&) {}
  void touch(const driver::DeviceState&, render::SurfaceResponse& response) noexcept {
    response.contact.depth += 0.001;
  }
  void leave() noexcept {}
};
constexpr render::EffectKind kRaised = render::effect_kind<Raised>();
render::EffectPlan raised() {
  return {&kRaised, []() -> std::unique_ptr<render::AnyStage> {
            return std::make_unique<render::AnyStageOf<Raised>>(Raised({}, {}));
          }};
}

TEST_F(SceneBuilderTest, AnOwnEffectChangesTheForce) {
  SceneBuilder own("ball");
  own.arm("vintage_phantom").duration(2);
  own.object("ball")
      .sphere(0.03)
      .position({0, 0, -0.03})
      .stiffness(500)
      .damping(1)
      .own_effect(raised());
  own.hand().at(0, {0, 0, 0.02}).on(1, "ball", {0, 0, 0}, 0.004).at(2, {0, 0, 0.02});
  const auto strongest = [](const SceneBuilder& scene) {
    auto run = Session::open(scene);
    double force = 0;
    if (!run) return force;
    (*run)->run();
    for (const driver::TickRecord& tick : (*run)->ticks())
      force = std::max(force, tick.f_sent_W[2]);
    return force;
  };
  // The hand (300 N/m) and the surface (500 N/m) share the additional 1 mm.
  EXPECT_NEAR(strongest(own) - strongest(ball()), 300 * 500 / 800.0 * 0.001, 0.02);
}

TEST_F(SceneBuilderTest, AnOwnEffectIsNotWrittenToAFile) {
  SceneBuilder scene = ball();
  scene.object("cube").sphere(0.02).stiffness(300).own_effect(raised());
  ASSERT_TRUE(scene.build());
  const auto text = scene.yaml();
  ASSERT_FALSE(text);
  EXPECT_EQ(text.error().message.substr(0, 49),
            "object 2 'cube': has an effect of the program, wh");
}

TEST_F(SceneBuilderTest, AnOwnEffectWithoutABuilderIsRefused) {
  SceneBuilder scene = ball();
  scene.object("cube").sphere(0.02).stiffness(300).own_effect({});
  EXPECT_EQ(error_of(scene),
            "object 2 'cube': an effect of the program needs its kind and its builder; set both.");
}

TEST_F(SceneBuilderTest, ViewersAreRefused) {
  const auto run = Session::open(ball(), {.share = true});
  ASSERT_FALSE(run);
  EXPECT_NE(run.error().message.find("SceneBuilder::save"), std::string::npos);
}

TEST_F(SceneBuilderTest, ARecordingReplaysOnTheSavedScene) {
  const auto folder = support::scratch_folder() / "built_recording";
  std::filesystem::create_directories(folder);
  SceneBuilder scene = ball();
  scene.folder(folder);
  auto run = Session::open(scene, {.record = folder / "touch.h5", .overwrite = true});
  if (!run && run.error().message.find("THIMBLE_RECORDINGS") != std::string::npos) {
    GTEST_SKIP() << run.error().message;
  }
  ASSERT_TRUE(run) << run.error().message;
  (*run)->run();
  ASSERT_TRUE((*run)->end_recording());
  ASSERT_TRUE(scene.save(scene.file()));
  const auto recording = session::read_recording(folder / "touch.h5");
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->info.scene_text, scene::text_of(scene.file()));
  const auto again = session::replay(*recording);
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(again->compared.differing, 0u);
}

TEST_F(SceneBuilderTest, ASessionLikeAnotherIsBitIdentical) {
  const auto first = Session::open(ball(), {.duration = 1.5, .seed = 7});
  ASSERT_TRUE(first);
  const auto second = Session::open_like(**first, 7);
  ASSERT_TRUE(second) << second.error().message;
  support::RunHash a, b;
  (*first)->run();
  (*second)->run();
  for (const driver::TickRecord& tick : (*first)->ticks()) a.add(tick);
  for (const driver::TickRecord& tick : (*second)->ticks()) b.add(tick);
  EXPECT_EQ(a.value(), b.value());
}

}  // namespace
}  // namespace thimble
