#include "hil/cable_pull.h"

#include <fmt/format.h>

#include <chrono>
#include <thread>

namespace thimble::hil {
namespace {

using Eigen::Vector3d;

constexpr const char* kName = "cable_pull";
constexpr double kForce = 0.2;     // N, acts while the cable is pulled [chosen]
constexpr double kPulled_s = 30;   // s, time for the user
constexpr double kPlugged_s = 60;  // s
constexpr double kFar = 0.03;      // m; max. motion of a released tip

}  // namespace

HilResult check_cable_pull(const HilRig& rig, bool wanted) {
  if (!wanted) return skipped(kName, "Not requested (--replug).");
  if (!rig.attended) return skipped(kName, "A person must pull the cable (--attended).");
  if (!rig.prompt(fmt::format("Hold the grip loosely; it pushes with {:g} N to your right. Pull "
                              "the arm's cable within {:.0f} s.",
                              kForce, kPulled_s))) {
    return skipped(kName, "The prompt was cancelled.");
  }
  {
    auto opened = open_active(rig, TipHold::kHand);
    if (!opened) return broken_off(kName, opened.error().message, nullptr);
    bringup::BenchArm& bench = **opened;
    const double from = bench.device().state().p_WT.y();
    const auto law = [&](const driver::DeviceState& state) -> Vector3d {
      const bool far = !(std::abs(state.p_WT.y() - from) < kFar);
      return far ? Vector3d(0, 0, 0) : Vector3d(0, kForce, 0);
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
