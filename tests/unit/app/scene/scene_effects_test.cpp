#include "object_sections.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "worst_direction.h"

namespace thimble::scene {
namespace {

std::vector<std::string> names_of(const std::vector<render::EffectPlan>& plans) {
  std::vector<std::string> names;
  for (const render::EffectPlan& plan : plans) names.emplace_back(plan.kind->name);
  return names;
}

// Reads a list of effects. Returns the mistakes.
std::string mistake(const std::string& effects) {
  auto yaml = scene::YamlFile::parse("effects:\n" + effects, "scene");
  if (!yaml) return yaml.error().message;
  render::EffectContext context;
  context.force_max = 5;
  context.surface_stiffness = 800;
  scene::read_effects(yaml->root(), {}, context);
  yaml->root().finish();
  const auto done = yaml->finish();
  return done ? "" : done.error().message;
}

TEST(SceneEffects, RunInTickOrder) {
  auto yaml = scene::YamlFile::parse(
      "effects:\n  - {friction: bristle, coefficient: 0.4}\n  - {texture: sandpaper}\n", "scene");
  ASSERT_TRUE(yaml.ok());
  render::EffectContext context;
  context.force_max = 5;
  context.surface_stiffness = 800;
  const auto plans = scene::read_effects(yaml->root(), {}, context);
  EXPECT_EQ(names_of(plans), (std::vector<std::string>{"sandpaper", "bristle"}));
  for (const render::EffectPlan& plan : plans) EXPECT_NE(plan.build(), nullptr);
}

TEST(SceneEffects, UnknownOrConflictingEffectsNameTheirLine) {
  EXPECT_EQ(mistake("  - {friction: bristle, coefficient: 0.4}\n"), "");
  EXPECT_NE(mistake("  - {friction: magic}\n").find("scene:2: friction: expected bristle"),
            std::string::npos);
  EXPECT_NE(mistake("  - {colour: red}\n").find("scene:2: expected friction: NAME"),
            std::string::npos);
  EXPECT_NE(mistake("  - {friction: bristle, texture: sandpaper}\n").find("entry of its own"),
            std::string::npos);
  EXPECT_NE(
      mistake("  - {friction: bristle, coeficient: 0.4}\n").find("did you mean \"coefficient\"?"),
      std::string::npos);
  EXPECT_NE(mistake("  - {friction: bristle, coefficient: -1}\n").find("coefficient: expected"),
            std::string::npos);
  EXPECT_NE(mistake("  - {friction: bristle, coefficient: .nan}\n").find("coefficient: expected"),
            std::string::npos);
}

TEST(Surroundings, OfShippedArmsAreThoseOfDeskTopArms) {
  int arms = 0;
  for (const auto& file : std::filesystem::directory_iterator(
           std::filesystem::path(THIMBLE_SOURCE_DIR) / "app/arms")) {
    if (file.is_directory()) continue;  // described wires
    const auto arm = scene::load_arm(file.path());
    ASSERT_TRUE(arm.ok()) << arm.error().message;
    const render::EffectContext context = scene::effect_context_of(*arm, 1000);
    // Encoder steps of arms with three motors are between 0.02 and 0.07 mm [DEVICES 2]; row sums
    // are larger. A paddle has one row.
    EXPECT_GT(context.encoder_step, 0.005e-3) << file.path();
    EXPECT_LT(context.encoder_step, 0.3e-3) << file.path();
    // It is computed in one place, and the force laws receive the same value.
    EXPECT_EQ(context.encoder_step, scene::worst_over_workspace(*arm).encoder_step);
    EXPECT_EQ(context.tick, 0.001);
    EXPECT_GE(context.delay, 0.001) << file.path();
    EXPECT_GT(context.force_max, 0) << file.path();
    ++arms;
  }
  EXPECT_GE(arms, 4);
}

}  // namespace
}  // namespace thimble::scene
