// Sixteen differences between an arm and its file: each is reported by a check, or listed as not
// tested.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <atomic>
#include <cstdio>
#include <functional>
#include <map>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "arm_table.h"
#include "board/sim_transport.h"
#include "hil/hil_suite.h"
#include "hil/known_places.h"
#include "simulated_arm.h"
#include "thimble/driver/wire_link.h"

namespace thimble::hil {
namespace {

constexpr double kMass = 0.03, kLength = 0.1;  // kg, m

/// An arm whose driver uses the file of a different arm.
class Desk {
 public:
  explicit Desk(const char* name)
      : believed(scene::load_arm(name).value()), truth(scene::load_arm(name).value()) {}

  scene::ArmFile believed, truth;

  driver::Result<std::unique_ptr<bringup::BenchArm>> open(TipHold hold) {
    device_sim::SimulatedArmSettings settings = truth.simulated;
    settings.firmware.protocol = truth.protocol;
    settings.firmware.line_model = truth.board_model;
    scene::ArmFile file = believed;
    std::vector<std::pair<double, Eigen::Vector3d>> way{{0, believed.workspace.middle()}};
    if (hold == TipHold::kHand) way = bringup::feel_check_hand({0, 0, 0});
    if (hold == TipHold::kHome) way = home_pose_hand(believed);
    if (hold == TipHold::kLength) way = known_length_hand(believed, kLength);
    if (hold == TipHold::kHome || hold == TipHold::kLength) settings.hand = firm_hand();
    if (hold == TipHold::kFree || hold == TipHold::kMass) settings.hand = {};
    if (hold == TipHold::kMass) {
      settings.hand.mass += kMass;
      settings.weight_B += truth.R_WB.transpose() * Eigen::Vector3d(0, 0, -9.80665 * kMass);
      file.limits.soft_start = driver::GateLimits::kSoftStartMin;
    }
    std::vector<device_sim::HandPath::Point> points;
    for (const auto& [time, p_WH] : way) {
      points.push_back({time, truth.R_WB.transpose() * (p_WH - truth.p_WB)});
    }
    arms_.push_back(std::make_unique<device_sim::SimulatedArm>(
        device_sim::SimulatedArm::make(driver::model_as<driver::SerialArm>(truth.model), settings,
                                       device_sim::HandPath::make(points).value())
            .value()));
    auto clock = std::make_unique<driver::VirtualClock>();
    auto wire = std::make_unique<device_sim::SimTransport>(*clock, *arms_.back());
    return bringup::BenchArm::open_link(
        file,
        std::make_unique<driver::WireLink>(std::move(wire),
                                           driver::make_arm(believed.protocol, believed.model)),
        std::move(clock), kHilForceMax);
  }

 private:
  std::vector<std::unique_ptr<device_sim::SimulatedArm>> arms_;
};

/// Returns the text of a check.
std::string outcome_text(const HilResult& result) {
  std::string text = result.name + ": " + result.text;
  for (const session::Figure& figure : result.figures) {
    if (!figure.met()) text += " [" + figure.name + " " + std::to_string(figure.value) + "]";
  }
  return text;
}

/// Returns the names of the checks of a suite that failed.
std::string failed(const std::vector<HilResult>& results) {
  std::string names;
  for (const HilResult& one : results) {
    if (one.outcome == HilOutcome::kFailed) names += one.name + " ";
  }
  return names;
}

std::vector<HilResult> run(Desk& desk, const HilOptions& options, bool attended) {
  const std::atomic<bool> never{false};
  const HilRig rig{.file = desk.believed,
                   .open = [&](TipHold hold) { return desk.open(hold); },
                   .stop = never,
                   .prompt = [](const std::string&) { return true; },
                   .question = [](const std::string&) { return true; },
                   .attended = attended};
  return run_hil_suite(rig, options, {});
}

/// A mistake, the checks of which one must fail with a user, and its detection without a user: a
/// failing check, or a phrase in the list of untested properties.
struct Mistake {
  const char* name;
  std::function<void(scene::ArmFile& truth, scene::ArmFile& believed)> make;
  const char* named_by;
  const char* untested;  // empty if motion shows it
};

void PrintTo(const Mistake& mistake, std::ostream* out) {
  *out << mistake.name;
}

using File = scene::ArmFile;

Eigen::Matrix3d tilt(double degrees) {
  return Eigen::AngleAxisd(degrees * std::numbers::pi / 180, Eigen::Vector3d::UnitX())
      .toRotationMatrix();
}

driver::SerialArm& links(File& file) {
  return std::get<driver::SerialArm>(file.model.geometry);
}

const Mistake kMistakes[] = {
    {"AllCountsHalved",
     [](File& truth, File&) {
       for (auto& encoder : truth.model.encoders) encoder.counts_per_motor_turn /= 2;
     },
     "known_length", "scale of positions"},
    {"CountsOfOneJointHalved",
     [](File& truth, File&) { truth.model.encoders[1].counts_per_motor_turn /= 2; }, "known_length",
     "scale of positions"},
    {"EncoderSign", [](File& truth, File&) { truth.model.encoders[2].sign *= -1; }, "feel_check",
     ""},
    {"EncoderAndMotorSign",
     [](File& truth, File&) {
       truth.model.encoders[0].sign *= -1;
       truth.model.drives[0].sign *= -1;
     },
     "feel_check", "signs of the encoders"},
    {"HomeOffset", [](File& truth, File&) { truth.model.encoders[1].home_counts += 2000; },
     "home_pose", "Home position"},
    {"DelayOneMillisecondMore",
     [](File& truth, File&) { truth.simulated.wire.delay_out_ns += 1'000'000; }, "constants", ""},
    {"CoulombHalfAsMuchAgain", [](File& truth, File&) { truth.simulated.plant.coulomb *= 1.5; },
     "constants", ""},
    {"LostWeight",
     [](File&, File& believed) {
       believed.simulated.weight_B = believed.R_WB.transpose() * Eigen::Vector3d(0, 0, -0.03);
     },
     "constants", ""},
    {"BaseTilted", [](File& truth, File&) { truth.R_WB = tilt(10) * truth.R_WB; }, "constants",
     "tilt of the base"},
    {"LinkCLonger", [](File& truth, File&) { links(truth).length_c *= 1.05; }, "known_length",
     "scale of positions"},
    {"LinkBLonger", [](File& truth, File&) { links(truth).length_b *= 1.05; }, "known_length",
     "scale of positions"},
    {"ViscousFiveTimes", [](File& truth, File&) { truth.simulated.plant.viscous *= 5; },
     "constants", ""},
    {"MassAQuarterMore", [](File& truth, File&) { truth.simulated.plant.mass *= 1.25; },
     "constants", ""},
    {"OneMotorWeak",
     [](File& truth, File&) { truth.simulated.firmware.wiring.motor_gain[1] = 0.75; }, "constants",
     ""},
    {"AllMotorsWeak",
     [](File& truth, File&) { truth.simulated.firmware.wiring.motor_gain.setConstant(0.8); },
     "constants", ""},
    {"RatioOfOneCapstan", [](File& truth, File&) { truth.model.drives[2].ratio *= 1.1; },
     "known_length", "scale of positions"},
};

class HilMistake : public testing::TestWithParam<Mistake> {};

TEST_P(HilMistake, IsNamedWithAPerson) {
  const Mistake& mistake = GetParam();
  Desk desk("vintage_phantom");
  mistake.make(desk.truth, desk.believed);
  HilOptions options;
  options.attended = true;
  options.known_mass = kMass;
  options.known_length = kLength;
  options.only = {"feel_check", "home_pose", "known_length", "constants"};
  const auto results = run(desk, options, true);
  std::string said;
  for (const HilResult& one : results) {
    said += outcome_text(one) + "\n";
  }
  std::printf("%-24s failed: %s\n", mistake.name, failed(results).c_str());
  EXPECT_NE((" " + failed(results)).find(" " + std::string(mistake.named_by) + " "),
            std::string::npos)
      << said;
}

TEST_P(HilMistake, IsNamedOrUntestedWithoutAPerson) {
  const Mistake& mistake = GetParam();
  Desk desk("vintage_phantom");
  mistake.make(desk.truth, desk.believed);
  HilOptions options;
  options.checked = true;  // the feel check was passed before the mistake was made
  options.only = {"feel_check", "constants"};
  const auto results = run(desk, options, false);
  std::string untested;
  for (const std::string& sentence : not_tested(desk.believed, options, results)) {
    untested += sentence + "\n";
  }
  std::printf("%-24s failed: %s\n", mistake.name, failed(results).c_str());
  const bool named = failed(results).find("constants") != std::string::npos;
  const bool stated =
      *mistake.untested != '\0' && untested.find(mistake.untested) != std::string::npos;
  EXPECT_TRUE(named || stated) << untested;
}

INSTANTIATE_TEST_SUITE_P(All, HilMistake, testing::ValuesIn(kMistakes),
                         [](const auto& instance) { return std::string(instance.param.name); });

TEST(HilMistakes, RightArmIsPassedWithAPerson) {
  for (const char* name : {"vintage_phantom", "woodenhaptics"}) {
    Desk desk(name);
    HilOptions options;
    options.attended = true;
    options.known_mass = kMass;
    options.known_length = kLength;
    options.only = {"feel_check", "home_pose", "known_length", "constants"};
    const auto results = run(desk, options, true);
    for (const HilResult& one : results) {
      EXPECT_EQ(one.outcome, HilOutcome::kPassed) << name << ": " << outcome_text(one);
    }
  }
}

}  // namespace
}  // namespace thimble::hil
