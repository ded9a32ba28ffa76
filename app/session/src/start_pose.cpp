#include "start_pose.h"

#include "arm_table.h"

#include <fmt/core.h>

#include "thimble/scene/real_arm.h"

namespace thimble::session {
namespace {

constexpr std::int64_t kPeriod_ns = 1'000'000;              // period at which arms expect messages
constexpr std::int64_t kSleptThrough_ns = 10 * kPeriod_ns;  // as in a servo loop
constexpr int kTicksBetweenChecks = 20;  // between two checks of the terminal; chosen

}  // namespace

StartPose StartPose::of(const scene::ArmFile& file, driver::ArmKind kind) {
  if (kind == driver::ArmKind::kFalcon) return {file.workspace, std::nullopt};
  // Encoders that know their angle do not count from the home pose.
  if (file.home.how == scene::HomeMethod::kAbsolute) return {file.workspace, std::nullopt};
  const auto arm = driver::make_arm(kind, file.model, file.wire.get());
  // The vendor's software calibrates its arm.
  if (arm == nullptr) return {file.workspace, std::nullopt};
  return {file.workspace, file.p_WB + file.R_WB * arm->pose({}).p_BT};
}

std::string StartPose::problem(const Eigen::Vector3d& p_WT, bool at_home) const {
  constexpr const char* kRemedy = "switch it off, move it to its home pose, and switch it on there";
  if (!p_WT.allFinite()) {
    return fmt::format("The arm reports an invalid position: {}.", kRemedy);
  }
  if (p_WHome_) {
    const double distance = (p_WT - *p_WHome_).norm();
    if (distance <= kHomeMargin) return {};
    if (at_home) {
      return fmt::format(
          "The arm reports its tip {:.0f} mm away from its home pose. Move it to its home pose. If "
          "it is already there, its counters are wrong: {}.",
          1e3 * distance, kRemedy);
    }
  }
  const Eigen::Vector3d nearest = p_WT.cwiseMax(workspace_.min_W).cwiseMin(workspace_.max_W);
  const double outside = (p_WT - nearest).norm();
  if (!(outside <= kWorkspaceMargin)) {
    return fmt::format(
        "The arm reports its tip {:.0f} mm outside of the workspace in its arm file. Move it "
        "inside. If it is already inside, its counters are wrong: {}.",
        1e3 * outside, has_home() ? kRemedy : "restart the program, which homes it again");
  }
  return {};
}

driver::Result<bool> wait_for_start_pose(driver::Device& device, driver::Clock& clock,
                                         const StartPose& place, bool at_home,
                                         const Terminal& terminal, const std::atomic<bool>& stop) {
  // The board may restart while the program waits.
  const auto problem_now = [&] {
    std::string found = place.problem(device.state().p_WT, at_home || device.home_needed());
    if (found.empty()) device.confirm_home();
    return found;
  };
  std::string problem = problem_now();
  if (problem.empty()) return true;
  if (!terminal.there) return driver::Error{problem + " Then restart the program."};
  const auto ask = [&] { terminal.print_line(problem + " Hold it there and press Enter."); };
  ask();
  const std::int64_t asleep_ns = clock.asleep_ns();
  std::int64_t due_ns = clock.now_ns();
  for (int tick = 1; !stop.load(std::memory_order_relaxed); ++tick) {
    due_ns += kPeriod_ns;
    clock.sleep_until_ns(due_ns);
    const std::int64_t now_ns = clock.now_ns();
    device.idle(now_ns, now_ns);
    if (now_ns - due_ns >= kSleptThrough_ns && clock.asleep_ns() - asleep_ns >= kPeriod_ns) {
      device.wake_from_sleep();
    }
    if (device.fault() != driver::Fault::kNone) {
      return driver::Error{std::string(driver::describe(device.fault()))};
    }
    if (tick % kTicksBetweenChecks != 0) continue;
    const EnterKey key = terminal.key();
    if (key == EnterKey::kClosed) return driver::Error{problem + " The terminal was closed."};
    if (key != EnterKey::kPressed) continue;
    problem = problem_now();
    if (problem.empty()) return true;
    ask();
  }
  return false;
}

}  // namespace thimble::session
