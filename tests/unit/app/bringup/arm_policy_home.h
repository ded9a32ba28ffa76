#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "support/scratch.h"
#include "thimble/scene/arm_policy.h"

namespace thimble::bringup {

namespace fs = std::filesystem;

inline const fs::path kSource = THIMBLE_SOURCE_DIR;
inline const fs::path kArms = kSource / "app/arms";

inline std::string text_of(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

inline void write(const fs::path& file, const std::string& text) {
  fs::create_directories(file.parent_path());
  std::ofstream(file) << text;
}

/// Replaces a part of a text; the test fails if the text does not contain it.
inline std::string with(std::string text, const std::string& piece, const std::string& by) {
  const std::size_t at = text.find(piece);
  EXPECT_NE(at, std::string::npos) << piece;
  return at == std::string::npos ? text : text.replace(at, piece.size(), by);
}

inline bool holds(const std::string& text, const std::string& piece) {
  return text.find(piece) != std::string::npos;
}

inline std::string all_of(const std::vector<std::string>& sentences) {
  std::string text;
  for (const std::string& sentence : sentences) text += sentence + '\n';
  return text;
}

inline std::string ball(const std::string& arm, const std::string& gate) {
  return "name: ball\narm: " + arm + "\nduration: 1\n" + gate +
         "objects:\n  - {name: ball, sphere: {radius: 0.03}, stiffness: 500}\n"
         "hand:\n  path:\n    - {t: 0, at: [0, 0, 0.05]}\n    - {t: 1, at: [0, 0, 0.05]}\n";
}

/// A separate home folder for each test, with simulated USB arms.
class ArmPolicyTest : public ::testing::Test {
 protected:
  ArmPolicyTest() {
    fs::remove_all(home_);
    fs::create_directories(home_);
    setenv("XDG_CONFIG_HOME", (home_ / "config").c_str(), 1);
    setenv("XDG_STATE_HOME", (home_ / "state").c_str(), 1);
  }

  /// Creates the kernel's files of a plugged-in arm.
  driver::FoundArm plug(driver::ArmKind kind, const std::string& name,
                        std::uint16_t release = 0x0100,
                        const std::string& product = "an arm") const {
    driver::FoundArm arm;
    arm.kind = kind;
    arm.arm = "board";
    arm.serial = name;
    arm.sysfs = home_ / "sys" / name;
    arm.accessible = true;
    // The Haptikfabriken arm of these tests is on a Teensy's raw HID.
    arm.board = kind == driver::ArmKind::kWoody      ? driver::BoardKind::kMbedHid8
                : kind == driver::ArmKind::kPolhem   ? driver::BoardKind::kTeensyRawHid64
                : kind == driver::ArmKind::kHfabLine ? driver::BoardKind::kTextLines
                                                     : driver::BoardKind::kFalconFtdi;
    arm.certainty = product == "an arm" ? driver::Certainty::kKnown : driver::Certainty::kUnknown;
    arm.product = product;
    arm.release = release;
    return arm;
  }

  /// Writes a copy of a shipped arm file to another folder, with one part replaced.
  fs::path copy_of(const std::string& name, const std::string& piece, const std::string& by) const {
    const fs::path file = home_ / "elsewhere" / (name + ".yaml");
    write(file, with(text_of(kArms / (name + ".yaml")), piece, by));
    return file;
  }

  /// Returns the file for an arm whose board answers as `model`, or the error.
  static std::string file_for(const driver::FoundArm& arm, int model = 0) {
    const auto found = scene::find_real_arm_file(
        arm,
        {.arm_file = {}, .for_calibration = false, .ask_model = [model](const driver::FoundArm&) {
           return driver::Result<int>(model);
         }});
    return found ? found->path.stem().string() : found.error().message;
  }

  const fs::path home_ = support::scratch_folder() / "terms";
};

}  // namespace thimble::bringup
