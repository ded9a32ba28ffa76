// Comparisons with wrong arm files: errors that motion shows only together, or not at all.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>

#include "bringup/identify/record_motion.h"
#include "bringup/identify/simulated_bench.h"
#include "support/identify/hidden_arm.h"
#include "twin/compare_twin.h"
#include "twin/twin_files.h"
#include "twin/unseen_constants.h"

namespace thimble::twin {
namespace {

/// Returns the recording that `thimble identify --record` writes for the shipped PHANTOM.
const session::Recording& recorded_phantom() {
  static const session::Recording recording = [] {
    session::Recording made;
    std::ostringstream text;
    text << std::ifstream(std::string(THIMBLE_SOURCE_DIR) + "/app/arms/vintage_phantom.yaml")
                .rdbuf();
    made.info.arm = "vintage_phantom";
    made.info.arm_text = text.str();
    made.info.device = "sim";
    made.info.rate = 1000;
    made.complete = true;
    const scene::ArmFile file = scene::load_arm("vintage_phantom").value();
    auto bench = bringup::simulated_bench(file, 0);
    EXPECT_TRUE(bench.ok());
    (*bench)->watch([&](const driver::TickRecord& tick) { made.ticks.push_back(tick); });
    const std::atomic<bool> never{false};
    EXPECT_TRUE(bringup::record_motion(**bench, file, {.seconds = 6, .seed = 3}, never).ok());
    return made;
  }();
  return recording;
}

TwinResult compared(const scene::ArmFile& file) {
  auto result = compare_twin(recorded_phantom(), file, {});
  EXPECT_TRUE(result.ok()) << result.error().message;
  return std::move(result).value();
}

/// Returns the complete text of the command about a comparison.
std::string said_of(const TwinResult& result) {
  std::string all;
  for (const std::string& sentence : result.comparison.messages) all += sentence + "\n";
  return all + twin_table(result.comparison) + force_table(result.forces);
}

TEST(TwinMistakes, WrongConstantsAreNoHand) {
  scene::ArmFile late = scene::load_arm("vintage_phantom").value(), rubs = late, both = late;
  late.simulated.wire.delay_out_ns += 1'000'000;
  rubs.simulated.plant.coulomb *= 1.5;
  both.simulated.wire.delay_out_ns += 1'000'000;
  both.simulated.plant.coulomb *= 1.5;
  for (const scene::ArmFile* file : {&late, &rubs, &both}) {
    const TwinResult result = compared(*file);
    EXPECT_FALSE(result.forces.hand_held()) << said_of(result);
    EXPECT_EQ(said_of(result).find("like a hand"), std::string::npos) << said_of(result);
  }
}

TEST(TwinMistakes, TwoWrongConstantsAreBothNamed) {
  scene::ArmFile both = scene::load_arm("vintage_phantom").value();
  both.simulated.wire.delay_out_ns += 1'000'000;
  both.simulated.plant.coulomb *= 1.5;
  const TwinResult result = compared(both);
  const auto named = [&](const std::string& key) {
    return std::any_of(result.comparison.together.begin(), result.comparison.together.end(),
                       [&](const TwinRemedy& one) { return one.key == key; });
  };
  EXPECT_TRUE(named("simulation.wire.delay_in + delay_out")) << said_of(result);
  EXPECT_TRUE(named("simulation.tip.coulomb")) << said_of(result);
}

/// A property that motion cannot show, and the word that names it.
struct Unseen {
  const char* word;
  void (*make)(scene::ArmFile&);
};

TEST(TwinMistakes, WhatMotionCannotShowIsNamed) {
  const Unseen all[] = {
      {"Counts per turn of joint 2",
       [](scene::ArmFile& file) { file.model.encoders[1].counts_per_motor_turn /= 2; }},
      {"Counts per turn of joint 3",
       [](scene::ArmFile& file) { file.model.drives[2].ratio *= 1.1; }},
      {"joints.encoder_sign[3]", [](scene::ArmFile& file) { file.model.encoders[2].sign *= -1; }},
      {"joints.home_counts[1]",
       [](scene::ArmFile& file) { file.model.encoders[0].home_counts += 200; }},
      {"joints.motor_sign[1]", [](scene::ArmFile& file) { file.model.drives[0].sign *= -1; }},
  };
  const scene::ArmFile right = scene::load_arm("vintage_phantom").value();
  EXPECT_TRUE(unseen_differences(right, right).empty());
  for (const Unseen& one : all) {
    scene::ArmFile wrong = right;
    one.make(wrong);
    const auto sentences = unseen_differences(right, wrong);
    ASSERT_EQ(sentences.size(), 1u) << one.word;
    EXPECT_NE(sentences.front().find(one.word), std::string::npos) << sentences.front();
    EXPECT_NE(sentences.front().find("thimble "), std::string::npos)
        << "the sentence must name a test";
  }
}

TEST(TwinMistakes, ComparisonNamesWrongCounts) {
  scene::ArmFile wrong = scene::load_arm("vintage_phantom").value();
  for (auto& encoder : wrong.model.encoders) encoder.counts_per_motor_turn /= 2;
  EXPECT_NE(said_of(compared(wrong)).find("known length"), std::string::npos);
}

}  // namespace
}  // namespace thimble::twin
