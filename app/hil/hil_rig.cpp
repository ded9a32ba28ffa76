#include "hil/hil_rig.h"

#include <algorithm>
#include <utility>

#include "bringup/identify/simulated_bench.h"
#include "hil/known_places.h"

namespace thimble::hil {

driver::Result<std::unique_ptr<bringup::BenchArm>> open_simulated(const scene::ArmFile& file,
                                                                  const HilOptions& options,
                                                                  TipHold hold) {
  if (file.is<driver::DeltaArm>()) {
    return driver::Error{"The simulated " + file.name +
                         " must be homed by a hand, but these checks need a free tip. Use a serial "
                         "arm or a linkage: --arm vintage_phantom, polhem or woodenhaptics."};
  }
  if (hold == TipHold::kHand) {
    return bringup::BenchArm::open(
        file, {}, {}, bringup::feel_check_hand({0, 0, 0}, bringup::feel_check_axes(file)),
        kHilForceMax);
  }
  if (hold == TipHold::kFree) return bringup::simulated_bench(file, 0);
  if (hold == TipHold::kMass) return bringup::simulated_bench(file, options.known_mass);
  if (hold == TipHold::kHome || hold == TipHold::kLength) {
    scene::ArmFile firm = file;
    firm.simulated.hand = firm_hand();
    return bringup::BenchArm::open(firm, {}, {},
                                   hold == TipHold::kHome
                                       ? home_pose_hand(file)
                                       : known_length_hand(file, options.known_length),
                                   kHilForceMax);
  }
  scene::ArmFile tied = file;
  tied.simulated.hand = {};
  tied.simulated.hand.stiffness = options.spring;
  return bringup::simulated_bench(tied, 0, true);
}

driver::Result<std::unique_ptr<bringup::BenchArm>> open_active(const HilRig& rig, TipHold hold) {
  auto opened = rig.open(hold);
  if (!opened) return opened;
  bringup::BenchArm& bench = **opened;
  if (auto active = bench.device().activate(); !active) return active.error();
  const auto rest = [](const driver::DeviceState&) { return Eigen::Vector3d(0, 0, 0); };
  if (!bench.run(rig.file.limits.soft_start + 0.05, rest, rig.stop)) {
    return driver::Error{"The run ended before any force was requested. " +
                         std::string(driver::describe(bench.fault()))};
  }
  return opened;
}

std::vector<std::string> not_tested(const scene::ArmFile& file, const HilOptions& options,
                                    const std::vector<HilResult>& results) {
  const auto ran = [&](const char* name) {
    return std::any_of(results.begin(), results.end(), [&](const HilResult& one) {
      return one.name == name &&
             (one.outcome == HilOutcome::kPassed || one.outcome == HilOutcome::kFailed);
    });
  };
  std::vector<std::string> all;
  const bool serial = !file.is<driver::DeltaArm>() && !file.is<driver::VendorPoseArm>();
  if (!ran("known_length")) {
    all.emplace_back(
        "The scale of positions: in motion, errors of counts per turn, ratio and link length look "
        "like errors of mass and torque constants. Move the tip by a known length to test them "
        "(--attended --known-length 0.1).");
  }
  if (serial && !ran("home_pose")) {
    all.emplace_back(
        "Home position and signs of the encoders: motion around one place does not show them. "
        "Approach the home pose from two sides (--attended --check home_pose), and run the feel "
        "check.");
  }
  if (!ran("constants")) {
    all.emplace_back("Mass, friction, weight, gains and delay: the check constants did not run.");
  }
  if (options.known_mass == 0 || !ran("constants")) {
    all.emplace_back(
        "Forces in newtons and the tilt of the base: motion shows only ratios of mass and torque. "
        "Hang a known mass on the tip to test both (--attended --known-mass 0.03).");
  }
  return all;
}

HilResult broken_off(std::string name, const std::string& why, const bringup::BenchArm* bench) {
  HilResult result{std::move(name), HilOutcome::kFailed, why, {}, 0, true, false};
  if (bench != nullptr && bench->fault() != driver::Fault::kNone) {
    result.fault = true;
    result.text += (why.empty() ? "" : " ") + std::string(driver::describe(bench->fault()));
  }
  return result;
}

HilResult judged(std::string name, std::string text, std::vector<session::Figure> figures) {
  const bool met = std::all_of(figures.begin(), figures.end(),
                               [](const session::Figure& figure) { return figure.met(); });
  return {std::move(name),
          met ? HilOutcome::kPassed : HilOutcome::kFailed,
          std::move(text),
          std::move(figures),
          0,
          false,
          false};
}

}  // namespace thimble::hil
