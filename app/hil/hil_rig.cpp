#include "hil/hil_rig.h"

#include <algorithm>
#include <utility>

#include "bringup/identify/simulated_bench.h"

namespace thimble::app {

driver::Result<std::unique_ptr<BenchArm>> open_simulated(const scene::ArmFile& file, double spring,
                                                         TipHold hold) {
  if (file.is<driver::DeltaArm>()) {
    return driver::Error{
        "The simulated " + file.name +
        " is homed by the hand that holds it, and these checks need a tip that nobody holds. Take "
        "a "
        "serial arm or a linkage: --arm vintage_phantom, polhem or woodenhaptics."};
  }
  if (hold == TipHold::kHand) {
    return BenchArm::open(file, {}, {}, feel_check_hand({0, 0, 0}), kHilForceMax);
  }
  if (hold == TipHold::kFree) return simulated_bench(file, 0);
  scene::ArmFile tied = file;
  tied.simulated.hand = {};
  tied.simulated.hand.stiffness = spring;
  return simulated_bench(tied, 0, true);
}

driver::Result<std::unique_ptr<BenchArm>> open_active(const HilRig& rig, TipHold hold) {
  auto opened = rig.open(hold);
  if (!opened) return opened;
  BenchArm& bench = **opened;
  if (auto active = bench.device().activate(); !active) return active.error();
  const auto rest = [](const driver::DeviceState&) { return Eigen::Vector3d(0, 0, 0); };
  if (!bench.run(rig.file.limits.soft_start + 0.05, rest, rig.stop)) {
    return driver::Error{"It ended before any force was asked for. " +
                         std::string(driver::describe(bench.fault()))};
  }
  return opened;
}

HilResult broken_off(std::string name, const std::string& why, const BenchArm* bench) {
  HilResult result{std::move(name), HilOutcome::kFailed, why, {}, 0, true};
  if (bench != nullptr && bench->fault() != driver::Fault::kNone) {
    result.text += (why.empty() ? "" : " ") + std::string(driver::describe(bench->fault()));
  }
  return result;
}

HilResult judged(std::string name, std::string text, std::vector<Figure> figures) {
  const bool met = std::all_of(figures.begin(), figures.end(),
                               [](const Figure& figure) { return figure.met(); });
  return {std::move(name),
          met ? HilOutcome::kPassed : HilOutcome::kFailed,
          std::move(text),
          std::move(figures),
          0,
          false};
}

}  // namespace thimble::app
