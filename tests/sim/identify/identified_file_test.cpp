#include "bringup/identify/output/identified_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "bringup/identify/identify.h"
#include "bringup/identify/output/identified_further.h"
#include "read_scene.h"
#include "support/refuses.h"
#include "support/scratch.h"
#include "yaml/yaml_reader.h"

namespace thimble::bringup {
namespace {

ArmConstants some_constants() {
  ArmConstants found;
  found.mass = {0.0812, 0.0004};
  found.viscous = {0.0061, 0.0005};
  found.coulomb = {0.0333, 0.0002};
  found.weight = {0.0125, 0.0003};
  found.gain = {Estimate{1.1, 0.01}, {0.9, 0.01}, {1.2, 0.01}};
  found.delay = {0.00234, 1e-5};
  return found;
}

TEST(IdentifiedFile, ChangesOnlyMeasuredConstants) {
  const std::filesystem::path arm =
      std::filesystem::path(THIMBLE_SOURCE_DIR) / "app/arms/vintage_phantom.yaml";
  const auto file = support::scratch_folder() / "thimble_identified.yaml";
  std::filesystem::remove(file);
  const auto written =
      write_identified(arm, file, some_constants(), {.date = "2026-11-23", .arm = "A 1"});
  ASSERT_TRUE(written.ok()) << written.error().message;
  const auto before = scene::load_arm(arm), after = scene::load_arm(file);
  ASSERT_TRUE(after.ok()) << after.error().message;
  EXPECT_EQ(after->simulated.plant.mass, 0.0812);
  EXPECT_EQ(after->simulated.plant.viscous, 0.0061);
  EXPECT_EQ(after->simulated.plant.coulomb, 0.0333);
  EXPECT_EQ(after->simulated.weight_B, Eigen::Vector3d(0, 0, -0.0125));
  EXPECT_EQ(after->simulated.wire.delay_in_ns + after->simulated.wire.delay_out_ns, 2'340'000);
  EXPECT_NEAR(after->model.drives[0].torque_constant, 1.1 * 0.0234, 1e-9);
  EXPECT_NEAR(after->model.drives[2].torque_constant, 1.2 * 0.0234, 1e-9);
  EXPECT_EQ(after->limits.force_max, before->limits.force_max);
  EXPECT_EQ(after->simulated.hand.stiffness, before->simulated.hand.stiffness);
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  EXPECT_NE(text.str().find("mass: 0.0812  # kg, apparent [I 2026-11-23, A 1, +- 0.0004]"),
            std::string::npos)
      << text.str();
  EXPECT_TRUE(support::refuses(
      write_identified(arm, file, some_constants(), {.date = "2026-11-23", .arm = "A 1"}),
      "already exists"));
}

std::string text_of(const char* arm) {
  std::ostringstream content;
  content << std::ifstream(std::string(THIMBLE_SOURCE_DIR) + "/app/arms/" + arm + ".yaml").rdbuf();
  return content.str();
}

TEST(IdentifiedFile, WritesDetectedMotorsAndCables) {
  ArmConstants found = some_constants();
  found.cables.emplace();
  for (std::size_t i = 0; i < 3; ++i) {
    const double more = 1 + static_cast<double>(i);
    CableConstants& cable = (*found.cables)[i];
    cable.stiffness = {100 * more, 2}, cable.inertia = {1e-4 * more, 1e-6};
    cable.damping = {0.01 * more, 0.001};
  }
  const IdentifiedMark mark{.date = "2026-11-23", .arm = "A 1"};
  const std::string own = text_of("vintage_phantom");
  const auto train_of = [](const std::string& text) {
    auto yaml = scene::YamlFile::parse(text, "arm file");
    return scene::read_arm(*yaml).value().simulated.drive_train;
  };
  const auto added = identified_text(own, found, mark);
  ASSERT_TRUE(added.ok()) << added.error().message;
  EXPECT_EQ(train_of(*added).stiffness, Eigen::Vector3d(100, 200, 300));
  EXPECT_NE(
      added->find("  drive_train:\n    stiffness: [100, 200, 300]  # N m/rad at the joints [I "
                  "2026-11-23, A 1, +- 2, 2, 2]\n"),
      std::string::npos)
      << *added;
  // Existing keys are replaced, whatever their form.
  (*found.cables)[1].stiffness.value = 222;
  const auto again = identified_text(*added, found, mark);
  ASSERT_TRUE(again.ok()) << again.error().message;
  EXPECT_EQ(train_of(*again).stiffness, Eigen::Vector3d(100, 222, 300));
  std::string flow = own;
  flow.insert(flow.find("  tip:\n"),
              "  drive_train: {stiffness: [1, 1, 1], inertia: [1, 1, 1], current_lag: 0.001}\n");
  const auto kept = identified_text(flow, found, mark);
  ASSERT_TRUE(kept.ok()) << kept.error().message;
  EXPECT_EQ(train_of(*kept).inertia, Eigen::Vector3d(1e-4, 2e-4, 3e-4));
  EXPECT_EQ(train_of(*kept).current_lag, 0.001);
}

TEST(IdentifiedFile, OmitsAnInsignificantWeight) {
  ArmConstants found = some_constants();
  found.weight = {0.0002, 0.0003};
  const auto text = identified_text(text_of("vintage_phantom"), found, {});
  ASSERT_TRUE(text.ok()) << text.error().message;
  EXPECT_EQ(text->find("weight:"), std::string::npos);
}

TEST(IdentifiedFile, ReplacesAnInsignificantWeightByZero) {
  std::string text = text_of("vintage_phantom");
  text.insert(text.find("  motors:\n"), "    weight: 0.02\n");
  ArmConstants found = some_constants();
  found.weight = {0.000005, 0.00005};
  const auto written = identified_text(text, found, {});
  ASSERT_TRUE(written.ok()) << written.error().message;
  EXPECT_NE(written->find("weight: 0  #"), std::string::npos) << *written;
}

TEST(IdentifiedFile, AcceptsAPeriodWithMoreDigits) {
  Identified found;
  found.reports = ReportTiming{.period = {0.001000004, 1e-8}, .jitter = {1.4e-4, 3e-6}};
  const auto written = further_text(text_of("vintage_phantom"), found, {});
  EXPECT_TRUE(written.ok()) << written.error().message;
}

TEST(IdentifiedFile, RefusesAFormThatItCannotChange) {
  EXPECT_TRUE(support::refuses(identified_text("a: [", some_constants(), {}), "not valid YAML"));
  std::string text = text_of("vintage_phantom");
  const std::size_t at = text.find("  tip:\n"), end = text.find("  motors:\n");
  text.replace(at, end - at, "  tip: {mass: 0.075, viscous: 0.005, coulomb: 0.04}\n");
  EXPECT_FALSE(identified_text(text, some_constants(), {}).ok());
}

}  // namespace
}  // namespace thimble::bringup
