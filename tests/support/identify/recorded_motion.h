#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "bringup/bench_arm.h"
#include "bringup/identify/record_motion.h"
#include "bringup/identify/simulated_bench.h"
#include "thimble/scene/arm_file.h"
#include "thimble/session/recording.h"

namespace thimble::support {

/// Returns the text of a shipped arm file.
inline std::string text_of_arm(const char* arm) {
  std::ostringstream content;
  const std::filesystem::path arms = std::filesystem::path(THIMBLE_SOURCE_DIR) / "app/arms";
  content << std::ifstream((arms / arm).replace_extension(".yaml")).rdbuf();
  return content.str();
}

/// Returns the recording of `thimble identify --record` for a simulated arm that its driver takes
/// for the shipped arm of that name. `hold_it` keeps the hand of its file on the tip.
inline session::Recording recorded_motion(const scene::ArmFile& file, const char* arm,
                                          std::uint64_t seed, double seconds = 10,
                                          bool hold_it = false) {
  session::Recording recording;
  recording.info.arm = arm;
  recording.info.arm_text = text_of_arm(arm);
  recording.info.device = "sim";
  recording.info.rate = 1000;
  recording.complete = true;
  auto bench = bringup::simulated_bench(file, 0, hold_it);
  if (!bench) {
    ADD_FAILURE() << bench.error().message;
    return recording;
  }
  (*bench)->watch([&](const driver::TickRecord& tick) { recording.ticks.push_back(tick); });
  const std::atomic<bool> never{false};
  const auto motion =
      bringup::record_motion(**bench, file, {.seconds = seconds, .seed = seed}, never);
  EXPECT_TRUE(motion.ok()) << motion.error().message;
  return recording;
}

}  // namespace thimble::support
