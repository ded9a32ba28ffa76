#include "twin/unseen_constants.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "math/elementary.h"

namespace thimble::twin {
namespace {

bool differs(double a, double b) {
  return std::abs(a - b) > 1e-9 * std::max(std::abs(a), std::abs(b));
}

}  // namespace

std::vector<std::string> unseen_differences(const scene::ArmFile& recorded,
                                            const scene::ArmFile& file) {
  std::vector<std::string> all;
  const auto differ = [&all](const std::string& key, double was, double is, const char* what) {
    if (!differs(was, is)) return;
    all.push_back(
        fmt::format("{} is {:g} in the arm file of the recording and {:g} in this one. The motion "
                    "does not show which is correct: {}.",
                    key, was, is, what));
  };
  constexpr const char* kLength =
      "move the tip by a known length (thimble hil --attended --known-length 0.1)";
  constexpr const char* kHome =
      "approach the home pose from two sides (thimble hil --attended --check home_pose)";
  constexpr const char* kPush = "run `thimble feel-check`";
  for (std::size_t i = 0; i < static_cast<std::size_t>(file.motors()); ++i) {
    const auto key = [i](const char* name) { return fmt::format("joints.{}[{}]", name, i + 1); };
    const auto& was = recorded.model.encoders[i];
    const auto& is = file.model.encoders[i];
    // Value of a count at the joint.
    if (differs(recorded.model.step(i), file.model.step(i))) {
      constexpr double kTurn = 2 * std::numbers::pi;
      differ(fmt::format("Counts per turn of joint {}", i + 1), kTurn / recorded.model.step(i),
             kTurn / file.model.step(i), kLength);
    }
    differ(key("home_counts"), static_cast<double>(was.home_counts),
           static_cast<double>(is.home_counts), kHome);
    differ(key("encoder_sign"), was.sign, is.sign, kPush);
    differ(key("motor_sign"), recorded.model.drives[i].sign, file.model.drives[i].sign, kPush);
  }
  const Eigen::Matrix3d turn = recorded.R_WB.transpose() * file.R_WB;
  const Eigen::Vector3d twice_sine(turn(2, 1) - turn(1, 2), turn(0, 2) - turn(2, 0),
                                   turn(1, 0) - turn(0, 1));
  const double turned = math::atan2(twice_sine.norm(), turn.trace() - 1);
  if (turned > 1e-6) {
    all.push_back(
        fmt::format("The base of this file is rotated by {:.3g} degrees from that of the "
                    "recording. The motion does not show which is correct without a load on the "
                    "tip: hang a known mass on it (thimble hil --attended --known-mass 0.03).",
                    turned * 180 / std::numbers::pi));
  }
  return all;
}

std::vector<std::string> never_seen() {
  return {
      "counts per turn, ratios and lengths (to test them, move the tip by a known length)",
      "home position and signs of the encoders (to test them, approach the home pose from two "
      "sides and run the feel check)",
      "forces in newtons and the tilt of the base (to test them, hang a known mass on the tip)",
  };
}

}  // namespace thimble::twin
