#include "hil/cable_pull.h"

#include <fmt/format.h>

#include <chrono>
#include <string>
#include <thread>

#include "bringup/push_direction.h"

namespace thimble::hil {
namespace {

using Eigen::Vector3d;

constexpr const char* kName = "cable_pull";
constexpr double kForce = 0.2;     // N, acts while the cable is pulled [chosen]
constexpr double kPulled_s = 30;   // s, time for the user
constexpr double kPlugged_s = 60;  // s
constexpr double kFar = 0.03;      // m; max. motion of a released tip

/// Returns a direction of the world in the words of a person in front of the arm.
std::string words_of(const Vector3d& direction_W) {
  constexpr double kAlong = 0.99;  // cosine of 8 degrees [chosen: a hand feels no difference]
  constexpr const char* kWords[3][2] = {
      {"towards you", "away from you"}, {"to your right", "to your left"}, {"up", "down"}};
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    if (direction_W[axis] > kAlong) return kWords[axis][0];
    if (direction_W[axis] < -kAlong) return kWords[axis][1];
  }
  return fmt::format("along ({:.2f}, {:.2f}, {:.2f})", direction_W.x(), direction_W.y(),
                     direction_W.z());
}

}  // namespace

HilResult check_cable_pull(const HilRig& rig, bool wanted) {
  if (!wanted) return skipped(kName, "Not requested (--replug).");
  if (!rig.attended) return skipped(kName, "A person must pull the cable (--attended).");
  const Vector3d direction_W = bringup::push_direction(rig.file);
  if (!rig.prompt(fmt::format("Hold the grip loosely; it pushes with {:g} N {}. Pull the arm's "
                              "cable within {:.0f} s.",
                              kForce, words_of(direction_W), kPulled_s))) {
    return skipped(kName, "The prompt was cancelled.");
  }
  {
    auto opened = open_active(rig, TipHold::kHand);
    if (!opened) return broken_off(kName, opened.error().message, nullptr);
    bringup::BenchArm& bench = **opened;
    const double from = direction_W.dot(bench.device().state().p_WT);
    const auto law = [&](const driver::DeviceState& state) -> Vector3d {
      const bool far = !(std::abs(direction_W.dot(state.p_WT) - from) < kFar);
      return far ? Vector3d(0, 0, 0) : Vector3d(kForce * direction_W);
    };
    const bool whole = bench.run(kPulled_s, law, rig.stop);
    if (whole) {
      bench.device().deactivate();
      return judged(kName, fmt::format("The cable was not pulled within {:.0f} s.", kPulled_s),
                    {{"loss_named", 0, "", "== 1", ""}});
    }
    if (rig.stop.load()) return skipped(kName, "The prompt was cancelled.");
    const bool named = bench.device().lost() && bench.device().f_sent_W().isZero(0);
    if (!named)
      return broken_off(kName, "The check ended for a reason other than the cable.", &bench);
  }
  if (!rig.prompt("Plug the arm in again. If it counts from its home pose, put it there first.")) {
    return skipped(kName, "The prompt was cancelled.");
  }
  const auto until = std::chrono::steady_clock::now() + std::chrono::duration<double>(kPlugged_s);
  while (std::chrono::steady_clock::now() < until && !rig.stop.load()) {
    auto again = rig.open(TipHold::kFree);
    if (again) {
      return judged(kName, "The loss was reported, the force was off, and the arm was found again.",
                    {{"loss_named", 1, "", "== 1", ""}, {"found_again", 1, "", "== 1", ""}});
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
  return judged(kName, "The loss was reported, but the arm was not found again.",
                {{"loss_named", 1, "", "== 1", ""}, {"found_again", 0, "", "== 1", ""}});
}

}  // namespace thimble::hil
