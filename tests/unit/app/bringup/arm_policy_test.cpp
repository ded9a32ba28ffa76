// Selection of the arm file of a real arm; no other file can loosen its limits.
#include "thimble/scene/arm_policy.h"

#include <gtest/gtest.h>

#include <functional>

#include "arm/calibration.h"
#include "arm_policy/limits_policy.h"
#include "arm_policy_home.h"
#include "bringup/feel_check.h"
#include "energy_guard_settings.h"
#include "report/report.h"
#include "support/boards/line_board.h"
#include "thimble/scene/scene_file.h"
#include "thimble/scene/shipped_files.h"
#include "thimble/session/session.h"
#include "user_folders.h"

namespace thimble::bringup {
namespace {

using driver::ArmKind;
using driver::EnergyStage;
using driver::FoundArm;

TEST_F(ArmPolicyTest, ArmFileFollowsFromKindOrBoardModel) {
  EXPECT_EQ(file_for(plug(ArmKind::kWoody, "W1")), "woodenhaptics");
  EXPECT_EQ(file_for(plug(ArmKind::kFalcon, "F1")), "falcon");
  EXPECT_EQ(file_for(plug(ArmKind::kHfabLine, "L1"), 1), "polhem");
  EXPECT_EQ(file_for(plug(ArmKind::kHfabLine, "L1"), 2), "vintage_phantom");
  EXPECT_EQ(file_for(plug(ArmKind::kHfabLine, "L1"), 3), "woodenhaptics_teensy");
  const std::string nine = file_for(plug(ArmKind::kHfabLine, "L1"), 9);
  EXPECT_TRUE(holds(nine, "reports model 9") && holds(nine, "--device L1 --arm")) << nine;
}

TEST_F(ArmPolicyTest, BoardWithoutModelIsRefusedWithAdvice) {
  const std::string said = file_for(plug(ArmKind::kPolhem, "P1"));
  EXPECT_TRUE(holds(said, "thimble calibrate --device P1 --arm NAME")) << said;
  EXPECT_TRUE(holds(said, "polhem")) << said;
  EXPECT_FALSE(holds(said, "falcon")) << said;
}

TEST_F(ArmPolicyTest, UnknownBoardIsNotAskedForItsModel) {
  for (const char* product : {"Haply inverse3", "USB Serial", "Teensyduino RawHID", ""}) {
    FoundArm arm = plug(ArmKind::kHfabLine, "T1", 0x0279, product);
    arm.node = home_ / "port";
    write(arm.node, "");
    const auto found = scene::find_real_arm_file(arm);
    ASSERT_FALSE(found) << product;
    EXPECT_TRUE(holds(found.error().message, "which may be any device")) << found.error().message;
    EXPECT_EQ(fs::file_size(arm.node), 0u) << "something was written to " << product;
  }
}

TEST_F(ArmPolicyTest, NamedFileOverridesTheCalibration) {
  const FoundArm arm = plug(ArmKind::kHfabLine, "P1");
  ASSERT_TRUE(scene::save_calibration("P1", {.arm_file = "polhem"}));
  const auto kept = scene::find_real_arm_file(arm);
  ASSERT_TRUE(kept) << kept.error().message;
  EXPECT_EQ(kept->path.stem(), "polhem");
  EXPECT_TRUE(holds(kept->why, "P1.yaml")) << kept->why;
  EXPECT_EQ(kept->file.model.encoders[1].home_counts, 0) << "the calibration is included";

  // The signs of one arm in the file of another would drive the motors in the wrong direction.
  const scene::RealArmSearch vintage{.arm_file = kArms / "vintage_phantom.yaml"};
  const auto other = scene::find_real_arm_file(arm, vintage);
  ASSERT_FALSE(other);
  EXPECT_TRUE(holds(other.error().message, "thimble calibrate --device P1 --arm vintage_phantom"));
  scene::RealArmSearch fresh = vintage;
  fresh.for_calibration = true;
  const auto calibrated = scene::find_real_arm_file(arm, fresh);
  ASSERT_TRUE(calibrated);
  EXPECT_EQ(calibrated->path.stem(), "vintage_phantom");
  EXPECT_EQ(calibrated->why, "named by --arm");
  EXPECT_EQ(calibrated->file.model.encoders[1].home_counts, 7700);

  ASSERT_TRUE(scene::save_calibration("P1", {.arm_file = "gone"}));
  EXPECT_TRUE(holds(file_for(arm), "No installed arm file is called gone"));
}

TEST_F(ArmPolicyTest, FileForAnotherWireIsRefused) {
  const auto found =
      scene::find_real_arm_file(plug(ArmKind::kWoody, "W1"), {.arm_file = kArms / "falcon.yaml"});
  ASSERT_FALSE(found);
  EXPECT_TRUE(holds(found.error().message, "is for the board falcon_ftdi"))
      << found.error().message;
}

TEST_F(ArmPolicyTest, ForeignFileOnlyTightensLimits) {
  struct Case {
    const char *key, *was, *tighter, *weaker;
    double (*value)(const scene::ArmFile&);
  };
  const auto seconds = [](std::int64_t ns) { return 1e-9 * static_cast<double>(ns); };
  static const auto in_seconds = seconds;
  const Case cases[] = {
      {"force_max", "force_max: 5 ", "force_max: 4 ", nullptr,
       [](const scene::ArmFile& arm) { return arm.limits.force_max; }},
      {"speed_max", "speed_max: 3 ", "speed_max: 2 ", "speed_max: 20 ",
       [](const scene::ArmFile& arm) { return arm.limits.speed_max; }},
      {"rise_max", "rise_max: 2000", "rise_max: 1000", "rise_max: 1e5",
       [](const scene::ArmFile& arm) { return arm.limits.rise_max; }},
      {"soft_start", "soft_start: 0.3", "soft_start: 1", "soft_start: 0.05",
       [](const scene::ArmFile& arm) { return arm.limits.soft_start; }},
      {"reopen", "soft_start: 0.3", "reopen: 0.1\n  soft_start: 0.3",
       "reopen: 0.001\n  soft_start: 0.3",
       [](const scene::ArmFile& arm) { return arm.limits.reopen; }},
      {"stall", "stall: 0.02 ", "stall: 0.01 ", "stall: 0.05 ",
       [](const scene::ArmFile& arm) { return in_seconds(arm.limits.stall_ns); }},
      {"watchdog", "watchdog: 0.5 ", "watchdog: 0.05 ", "watchdog: 1 ",
       [](const scene::ArmFile& arm) { return in_seconds(arm.limits.watchdog_ns); }},
      {"energy", "energy: passivity", "energy: bounding", "energy: none",
       [](const scene::ArmFile& arm) { return static_cast<double>(arm.energy.stage); }},
      {"power_max", "power_max: 1 ", "power_max: 0.5 ", "power_max: 5 ",
       [](const scene::ArmFile& arm) { return arm.limits.power_max; }},
      {"power_time", "power_time: 2 ", "power_time: 1 ", "power_time: 10 ",
       [](const scene::ArmFile& arm) { return arm.limits.power_time; }},
      {"energy_allowance", "energy: passivity", "energy: passivity\n  energy_allowance: 0.001",
       "energy: passivity\n  energy_allowance: 1",
       [](const scene::ArmFile& arm) {
         return arm.energy.allowance.value_or(scene::kEnergyAllowance);
       }},
  };
  const FoundArm arm = plug(ArmKind::kWoody, "W1");
  const auto installed = scene::find_real_arm_file(arm);
  ASSERT_TRUE(installed);
  for (const Case& one : cases) {
    for (const bool tighter : {true, false}) {
      const char* by = tighter ? one.tighter : one.weaker;
      if (by == nullptr) continue;
      const fs::path file = copy_of("woodenhaptics", one.was, by);
      const auto wanted = scene::load_arm(file);
      ASSERT_TRUE(wanted) << wanted.error().message;
      ASSERT_NE(one.value(*wanted), one.value(installed->file));
      const auto found = scene::find_real_arm_file(arm, {.arm_file = file});
      ASSERT_TRUE(found) << found.error().message;
      EXPECT_EQ(found->path, installed->path);
      EXPECT_EQ(one.value(found->file), one.value(tighter ? *wanted : installed->file)) << by;
      ASSERT_EQ(found->warnings.size(), 1u) << by;
      EXPECT_TRUE(holds(found->warnings[0], file.string() + ":")) << found->warnings[0];
      EXPECT_TRUE(holds(found->warnings[0], installed->path.string())) << found->warnings[0];
      EXPECT_TRUE(holds(found->warnings[0], std::string(": ") + one.key)) << found->warnings[0];
      EXPECT_TRUE(holds(found->warnings[0], tighter ? "is kept" : "is ignored"))
          << found->warnings[0];
    }
  }
}

TEST_F(ArmPolicyTest, ForeignFileCannotChangeTheArm) {
  const FoundArm arm = plug(ArmKind::kWoody, "W1");
  struct Case {
    const char *was, *by, *section;
  };
  const Case cases[] = {
      {"length_b: 0.205", "length_b: 0.105", "geometry"},
      // Half of the torque constant would double the force.
      {"torque_constant: [0.0259", "torque_constant: [0.013", "joints"},
      {"current_max: [3, 3, 3]", "current_max: [30, 30, 30]", "joints"},
      {"ratio: [16", "ratio: [8", "joints"},
      {"encoder_sign: [-1", "encoder_sign: [1", "joints"},
      {"position: [-0.220", "position: [-0.120", "base"},
      {"min: [-0.1", "min: [-0.5", "workspace"},
      // With it a force_max of 50 N would be within the declared force.
      {"  force: 5 ", "  force: 50 ", "declared"},
      {"velocity_corner_frequency: 100", "velocity_corner_frequency: 0",
       "velocity_corner_frequency"},
  };
  for (const Case& one : cases) {
    const fs::path file = copy_of("woodenhaptics", one.was, one.by);
    const auto found = scene::find_real_arm_file(arm, {.arm_file = file});
    ASSERT_FALSE(found) << one.by;
    EXPECT_TRUE(holds(found.error().message, "section \"" + std::string(one.section) + '"'))
        << found.error().message;
    EXPECT_TRUE(holds(found.error().message, "cp " + file.string())) << found.error().message;
  }
}

TEST_F(ArmPolicyTest, CustomArmIsInstalledOnce) {
  const FoundArm arm = plug(ArmKind::kPolhem, "P1");
  const fs::path file = copy_of("polhem", "name: polhem", "name: my_arm");
  const auto before = scene::find_real_arm_file(arm, {.arm_file = file});
  ASSERT_FALSE(before);
  EXPECT_TRUE(
      holds(before.error().message, "cp " + file.string() + ' ' + scene::own_arm_folder().string()))
      << before.error().message;
  const fs::path mine = scene::own_arm_folder() / "mine.yaml";
  write(mine, with(text_of(file), "force_max: 5 ", "force_max: 3 "));
  const auto after = scene::find_real_arm_file(arm, {.arm_file = mine});
  ASSERT_TRUE(after) << after.error().message;
  EXPECT_EQ(after->file.limits.force_max, 3);
  EXPECT_TRUE(after->warnings.empty());
  EXPECT_EQ(scene::find_arm_file("mine")->string(), mine.string()) << "the arm is found by name";
}

TEST_F(ArmPolicyTest, UserFileReplacesTheShippedOne) {
  const FoundArm arm = plug(ArmKind::kWoody, "W1");
  write(scene::own_arm_folder() / "woodenhaptics.yaml",
        with(text_of(kArms / "woodenhaptics.yaml"), "force_max: 5 ", "force_max: 2 "));
  EXPECT_EQ(scene::find_real_arm_file(arm)->file.limits.force_max, 2);
  // The shipped file then counts as a foreign file and cannot loosen limits.
  const auto named = scene::find_real_arm_file(arm, {.arm_file = kArms / "woodenhaptics.yaml"});
  ASSERT_TRUE(named) << named.error().message;
  EXPECT_EQ(named->file.limits.force_max, 2);
  EXPECT_TRUE(holds(all_of(named->warnings), "force_max 5 N is ignored"))
      << all_of(named->warnings);
}

// A scene with one ball, its arm and its gate.
TEST_F(ArmPolicyTest, ShippedScenesKeepTheArmAndItsLimits) {
  const auto terms = scene::find_arm_policy(
      plug(ArmKind::kPolhem, "P1"),
      {.arm_file = kArms / "polhem.yaml", .firmware = {}, .unchecked = true});
  ASSERT_TRUE(terms) << terms.error().message;
  int scenes = 0;
  for (const auto& entry : fs::directory_iterator(kSource / "app/scenes")) {
    if (entry.path().extension() != ".yaml") continue;
    auto scene = scene::load_scene(entry.path(), {.arm = terms->arm.path});
    if (!scene) continue;  // its scanned mesh is not installed
    ++scenes;
    const auto warnings = scene::apply_arm_policy(*scene, entry.path(), *terms);
    ASSERT_TRUE(warnings) << warnings.error().message;
    EXPECT_EQ(scene->arms.front().arm.name, "polhem") << entry.path();
    EXPECT_TRUE(scene->arms.front().arm.is<driver::LinkageArm>()) << entry.path();
    EXPECT_EQ(scene->arms.front().arm.limits.force_max, terms->arm.file.limits.force_max)
        << entry.path();
    EXPECT_EQ(scene->arms.front().arm.limits.soft_start, terms->arm.file.limits.soft_start)
        << entry.path();
    EXPECT_EQ(scene::energy_settings(scene->arms.front().arm, scene->rate, scene->energy).stage,
              EnergyStage::kPassivity)
        << entry.path();
  }
  EXPECT_GE(scenes, 8);
}

TEST_F(ArmPolicyTest, SceneCannotRemoveTheEnergyStage) {
  const fs::path file = home_ / "scene" / "ball.yaml";
  const auto terms = scene::find_arm_policy(plug(ArmKind::kWoody, "W1"),
                                            {.arm_file = {}, .firmware = {}, .unchecked = true});
  ASSERT_TRUE(terms);
  const std::string arm = (kArms / "vintage_phantom.yaml").string();
  const struct {
    const char* wanted;
    EnergyStage gets;
    const char* said;
  } cases[] = {{"none", EnergyStage::kPassivity, "energy: none is ignored"},
               {"passivity", EnergyStage::kPassivity, ""},
               {"bounding", EnergyStage::kBounding, "energy: bounding is kept"}};
  for (const auto& one : cases) {
    write(file, ball(arm, std::string("gate:\n  energy: ") + one.wanted + '\n'));
    auto scene = scene::load_scene(file, {.arm = terms->arm.path});
    ASSERT_TRUE(scene) << scene.error().message;
    const auto warnings = scene::apply_arm_policy(*scene, file, *terms);
    ASSERT_TRUE(warnings);
    EXPECT_EQ(scene::energy_settings(scene->arms.front().arm, 1000, scene->energy).stage, one.gets)
        << one.wanted;
    const std::string text = all_of(*warnings);
    EXPECT_TRUE(holds(text, one.said)) << text;
    EXPECT_EQ(holds(text, "ball.yaml:5: "), one.said[0] != 0) << text;
    EXPECT_TRUE(holds(text, "its arm, vintage_phantom, is used for the simulation only")) << text;
  }
  // In simulation a scene may still omit the energy stage.
  auto simulated = scene::load_scene(file);
  ASSERT_TRUE(simulated);
  EXPECT_EQ(simulated->energy, EnergyStage::kBounding);
}

TEST_F(ArmPolicyTest, SceneArmFileOnlyTightensLimits) {
  const fs::path folder = home_ / "scene", file = folder / "ball.yaml";
  std::string own = text_of(kArms / "vintage_phantom.yaml");
  own = with(own, "  force: 5 ", "  force: 100 ");
  own = with(own, "force_max: 5 ", "force_max: 100 ");
  own = with(own, "soft_start: 0.3", "soft_start: 0.05");
  own = with(own, "watchdog: 0.1 ", "watchdog: 1 ");
  own = with(own, "energy: passivity", "energy: none");
  own = with(own, "speed_max: 3 ", "speed_max: 0.5 ");
  write(folder / "own.yaml", own);
  write(file, ball("own.yaml", ""));
  const auto terms = scene::find_arm_policy(plug(ArmKind::kWoody, "W1"),
                                            {.arm_file = {}, .firmware = {}, .unchecked = true});
  ASSERT_TRUE(terms);
  auto scene = scene::load_scene(file, {.arm = terms->arm.path});
  ASSERT_TRUE(scene) << scene.error().message;
  const auto warnings = scene::apply_arm_policy(*scene, file, *terms);
  ASSERT_TRUE(warnings);
  const std::string text = all_of(*warnings);
  EXPECT_EQ(scene->arms.front().arm.name, "woodenhaptics");
  EXPECT_EQ(scene->arms.front().arm.limits.force_max, 5);
  EXPECT_EQ(scene->arms.front().arm.limits.soft_start, 0.3);
  EXPECT_EQ(scene->arms.front().arm.limits.watchdog_ns, 500'000'000);
  EXPECT_EQ(scene->arms.front().arm.limits.speed_max, 0.5);
  EXPECT_EQ(scene->arms.front().arm.energy.stage, EnergyStage::kPassivity);
  EXPECT_TRUE(holds(text, "own.yaml:46: force_max 100 N is ignored")) << text;
  EXPECT_TRUE(holds(text, "own.yaml:47: speed_max 0.5 m/s is kept")) << text;
  EXPECT_TRUE(holds(text, "own.yaml:49: soft_start 0.05 s is ignored")) << text;
  EXPECT_TRUE(holds(text, "own.yaml:51: watchdog 1 s is ignored")) << text;
  EXPECT_TRUE(holds(text, "own.yaml:52: energy: none is ignored")) << text;
  // An invalid file is an error.
  write(folder / "own.yaml", with(own, "force_max: 100", "force_max: much"));
  EXPECT_FALSE(scene::apply_arm_policy(*scene, file, *terms));
}

TEST_F(ArmPolicyTest, RealArmRunNeedsAPolicy) {
  const fs::path file = home_ / "scene" / "ball.yaml";
  write(file, ball((kArms / "vintage_phantom.yaml").string(), ""));
  session::SessionOptions options;
  options.real_arm = plug(ArmKind::kPolhem, "P1");
  const auto session = session::Session::open(file, options);
  ASSERT_FALSE(session);
  EXPECT_TRUE(holds(session.error().message, "terms")) << session.error().message;
}

TEST_F(ArmPolicyTest, KnownLineBoardIsAskedForItsModel) {
  const support::LineBoard board(2);
  if (board.node().empty()) GTEST_SKIP() << "this machine has no pseudo-terminals";
  FoundArm arm = plug(ArmKind::kHfabLine, "V1", 0x0279, "Haptikfabriken vintage");
  arm.certainty = driver::Certainty::kKnown;
  arm.node = board.node();
  const auto found = scene::find_real_arm_file(arm);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(found->path.stem(), "vintage_phantom");
  EXPECT_TRUE(holds(found->why, "model 2")) << found->why;
  EXPECT_GT(board.messages(), 0);
}

TEST_F(ArmPolicyTest, SessionGateFollowsThePolicy) {
  const support::LineBoard board(2);
  if (board.node().empty()) GTEST_SKIP() << "this machine has no pseudo-terminals";
  FoundArm arm = plug(ArmKind::kHfabLine, "V1", 0x0279, "Haptikfabriken vintage");
  arm.node = board.node();
  const fs::path file = home_ / "scene" / "ball.yaml";
  write(home_ / "scene" / "own.yaml",
        with(text_of(kArms / "polhem.yaml"), "speed_max: 3 ", "speed_max: 0.5 "));
  write(file, ball("own.yaml", "gate:\n  energy: none\n"));
  for (const bool unchecked : {false, true}) {
    session::SessionOptions options;
    options.real_arm = arm;
    auto terms = scene::find_arm_policy(
        arm, {.arm_file = kArms / "vintage_phantom.yaml", .firmware = {}, .unchecked = unchecked});
    ASSERT_TRUE(terms) << terms.error().message;
    options.terms = std::move(terms).value();
    const auto session = session::Session::open(file, options);
    ASSERT_TRUE(session) << session.error().message;
    const driver::SafetyGate& gate = (*session)->device().gate();
    EXPECT_EQ(gate.limits().force_max, unchecked ? 5 : 0.5);
    EXPECT_EQ(gate.limits().speed_max, 0.5);
    EXPECT_EQ(gate.energy_stage(), EnergyStage::kPassivity);
    EXPECT_EQ((*session)->scene().arms.front().arm.name, "vintage_phantom");
    EXPECT_TRUE(holds(all_of((*session)->warnings()), "energy: none is ignored"));
    const session::RunFigures report = (*session)->figures();
    EXPECT_EQ(report.feel_check,
              unchecked ? scene::FeelCheckState::kUnchecked : scene::FeelCheckState::kNone);
    EXPECT_EQ(holds(summary(report), "UNCHECKED"), unchecked);
    EXPECT_EQ(holds(summary(report), "limited to 0.50 N"), !unchecked);
  }
}

}  // namespace
}  // namespace thimble::bringup
