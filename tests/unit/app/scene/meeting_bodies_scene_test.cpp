// Scenes of bodies that meet: what is refused, and what a run states.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "support/scratch.h"
#include "thimble/render/scene_touch.h"
#include "thimble/scene/scene_file.h"
#include "thimble/scene/scene_objects.h"

namespace thimble::scene {
namespace {

const char* const kHand = "hand: {path: [{t: 0, at: [0, 0, 0.3]}, {t: 1, at: [0, 0, 0.3]}]}\n";

std::string box(const std::string& name, double height, const std::string& motion,
                const std::string& more = "") {
  return "  - {name: " + name + ", box: {sides: [0.02, 0.02, 0.02]}, position: [0, 0, " +
         std::to_string(height) + "], stiffness: 600, body: {motion: {" + motion + "}}" + more +
         "}\n";
}

std::filesystem::path write(const std::string& objects, const std::string& more) {
  const std::filesystem::path file = support::scratch_folder() / "meeting_bodies.yaml";
  std::ofstream(file) << "name: test\narm: vintage_phantom\nduration: 1\nobjects:\n"
                      << objects << kHand << more;
  return file;
}

std::string mistakes(const std::string& objects, const std::string& more = "") {
  const auto scene = load_scene(write(objects, more));
  return scene ? "" : scene.error().message;
}

std::vector<std::string> notes(const std::string& objects) {
  const auto scene = load_scene(write(objects, ""));
  EXPECT_TRUE(scene) << (scene ? "" : scene.error().message);
  const auto built = SceneObjects::build(*scene);
  EXPECT_TRUE(built) << (built ? "" : built.error().message);
  return (*built)->notes();
}

TEST(MeetingBodiesScene, StatesWhichBodiesOverlap) {
  const std::string light = "kind: rigid, mass: 0.03";
  EXPECT_TRUE(notes(box("a", 0.01, light) + box("b", 0.0301, light)).empty());
  const auto found = notes(box("a", 0.01, light) + box("b", 0.028, light));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NE(found[0].find("overlap by 2 mm"), std::string::npos) << found[0];
  EXPECT_NE(found[0].find("a and b"), std::string::npos) << found[0];
}

TEST(MeetingBodiesScene, StatesMassesThatAreTooDifferent) {
  const auto with = [](const char* mass) {
    return notes(box("light", 0.01, "kind: rigid, mass: 0.01") +
                 box("heavy", 0.04, std::string("kind: rigid, mass: ") + mass));
  };
  EXPECT_TRUE(with("0.9").empty());
  const auto found = with("5");
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].find("heavy has 500 times the mass of light"), 0U) << found[0];
}

TEST(MeetingBodiesScene, ABodyWithoutAShapeMovesByItself) {
  const std::string two =
      box("a", 0.01, "kind: rigid, mass: 0.03") +
      box("slow", 0.04, "kind: rigid, mass: 0.03, time_scale: 0.5", ", collision: {shape: none}");
  EXPECT_TRUE(notes(two + box("b", 0.1, "kind: rigid, mass: 0.03")).empty());
}

TEST(MeetingBodiesScene, RefusesWhatCannotMove) {
  EXPECT_NE(mistakes("  - {name: p, plane: {}, stiffness: 1, body: {motion: {mass: 1}}}\n")
                .find("body: a plane has no end and cannot move"),
            std::string::npos);
  const std::string hinge = "joints: [{object: a, kind: hinge, at: [0, 0, 0], axis: [0, 1, 0]}]\n";
  EXPECT_NE(mistakes(box("a", 0.01, "mass: 0.03"), hinge).find("only translates"),
            std::string::npos);
  EXPECT_EQ(mistakes(box("a", 0.01, "kind: rigid, mass: 0.03"), hinge), "");
}

}  // namespace
}  // namespace thimble::scene
