#include "feel_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace thimble::app {
namespace {

constexpr double kEncoders_s = 4, kDirection_s = 2, kSettle_s = 0.5, kPush_s = 1;
constexpr double kForce = 0.4;  // N, below kFeelCheckForceMax
constexpr double kMove = 0.03;  // m, what the hand is asked for
constexpr std::array<const char*, 3> kAxes = {"x (towards you)", "y (to your right)", "z (up)"};

const BenchArm::Law kRest = [](const driver::DeviceState&) { return Eigen::Vector3d(0, 0, 0); };

template <class... Numbers>
std::string sentence(const char* format, Numbers... numbers) {
  char text[200];
  std::snprintf(text, sizeof text, format, numbers...);
  return text;
}

class Check {
 public:
  Check(BenchArm& bench, const ArmFile& file, const Prompt& prompt, const std::atomic<bool>& stop)
      : bench_(bench), file_(file), prompt_(prompt), stop_(stop) {}

  std::vector<CheckResult> run() {
    // Each step needs the ones before it; the first that fails or is left ends the check.
    const bool all = encoders() && direction(0) && direction(1) && direction(2) && push(0) &&
                     push(1) && push(2) && watchdog();
    bench_.device().deactivate();
    const driver::Fault fault = bench_.device().fault();
    if (!all && fault != driver::Fault::kNone) {
      results_.push_back({"fault", false, std::string(driver::describe(fault))});
    }
    return std::move(results_);
  }

 private:
  bool note(std::string name, bool passed, std::string text) {
    results_.push_back({std::move(name), passed, std::move(text)});
    return passed;
  }

  bool encoders() {
    if (!prompt_("Move the grip slowly through its whole room for four seconds.")) return false;
    std::array<std::int32_t, 3> least{INT32_MAX, INT32_MAX, INT32_MAX};
    std::array<std::int32_t, 3> most{INT32_MIN, INT32_MIN, INT32_MIN};
    const auto watch = [&](const driver::DeviceState& state) {
      for (std::size_t i = 0; i < 3; ++i) {
        least[i] = std::min(least[i], state.counts[i]);
        most[i] = std::max(most[i], state.counts[i]);
      }
      return Eigen::Vector3d(0, 0, 0);
    };
    if (!bench_.run(kEncoders_s, watch, stop_)) return false;
    constexpr std::int32_t kTravelMin = 100;  // counts: some mm at the tip of any arm we know
    std::array<int, 3> travel{};
    for (std::size_t i = 0; i < 3; ++i) travel[i] = most[i] - least[i];
    const bool all = *std::min_element(travel.begin(), travel.end()) >= kTravelMin;
    return note("encoders", all,
                sentence("The encoders travelled %d, %d and %d counts%s", travel[0], travel[1],
                         travel[2], all ? "." : "; at least 100 each were expected."));
  }

  bool direction(int axis) {
    const auto name = kAxes[static_cast<std::size_t>(axis)];
    if (!prompt_(sentence("Move the grip about 3 cm along %s and back within two seconds.", name)))
      return false;
    const Eigen::Vector3d from = bench_.device().state().p_WT;
    Eigen::Vector3d farthest(0, 0, 0);
    const auto watch = [&](const driver::DeviceState& state) {
      const Eigen::Vector3d away = state.p_WT - from;
      if (away.norm() > farthest.norm()) farthest = away;
      return Eigen::Vector3d(0, 0, 0);
    };
    if (!bench_.run(kDirection_s, watch, stop_)) return false;
    const bool right = farthest[axis] > 0.01 && farthest[axis] > 0.7 * farthest.norm();
    return note(sentence("direction %c", "xyz"[axis]), right,
                sentence("The tip went by (%.1f, %.1f, %.1f) mm when moved along %s%s",
                         farthest.x() * 1e3, farthest.y() * 1e3, farthest.z() * 1e3, name,
                         right ? "." : ": run `thimble calibrate`."));
  }

  bool push(int axis) {
    const auto name = kAxes[static_cast<std::size_t>(axis)];
    if (!prompt_(sentence("Hold the grip loosely and still: it pushes with %.1f N along %s.",
                          kForce, name)))
      return false;
    if (!bench_.device().activate() || !bench_.run(kSettle_s, kRest, stop_)) return false;
    const Eigen::Vector3d from = bench_.device().state().p_WT;
    const Eigen::Vector3d f_T_W = kForce * Eigen::Vector3d::Unit(axis);
    const auto law = [&](const driver::DeviceState&) { return f_T_W; };
    if (!bench_.run(kPush_s, law, stop_)) return false;
    const Eigen::Vector3d moved = bench_.device().state().p_WT - from;
    const bool back = bench_.run(kSettle_s, kRest, stop_);
    bench_.device().deactivate();
    const bool right = moved[axis] > 0.0002;
    return note(sentence("force %c", "xyz"[axis]), back && right,
                sentence("%.1f N along %s moved the tip by (%.2f, %.2f, %.2f) mm%s", kForce, name,
                         moved.x() * 1e3, moved.y() * 1e3, moved.z() * 1e3,
                         right ? "." : ": the motors' signs are wrong, or you held it fast."));
  }

  bool watchdog() {
    if (!prompt_("Hold the grip loosely and still: it pushes, then Thimble falls silent."))
      return false;
    if (!bench_.device().activate() || !bench_.run(kSettle_s, kRest, stop_)) return false;
    const double from = bench_.device().state().p_WT.x();
    const auto law = [](const driver::DeviceState&) { return Eigen::Vector3d(kForce, 0, 0); };
    if (!bench_.run(kPush_s, law, stop_)) return false;
    const double pushed = bench_.device().state().p_WT.x() - from;
    const double silent_since = bench_.now();
    double off_after = -1;
    bool any_report = false;
    const auto watch = [&](const driver::DeviceState& state) {
      any_report = any_report || state.fresh;
      if (off_after < 0 && state.p_WT.x() - from < pushed / 2) {
        off_after = bench_.now() - silent_since;
      }
      return Eigen::Vector3d(0, 0, 0);
    };
    bench_.run(std::max(1.0, 5 * seconds(file_.limits.watchdog_ns)), watch, stop_, true);
    bench_.device().deactivate();
    if (!any_report) {
      return note("watchdog", true,
                  "The arm speaks only when spoken to, so its watchdog's time cannot be seen; it "
                  "pushed no more afterwards if you felt it let go.");
    }
    const double allowed = 2 * seconds(file_.limits.watchdog_ns);
    const bool right = off_after > 0 && off_after < allowed;
    return note("watchdog", right,
                off_after > 0
                    ? sentence("The force fell to half %.0f ms after the last message%s",
                               off_after * 1e3, right ? "." : ", later than the arm file says.")
                    : std::string("The motors did not go off. Switch the arm off at its switch."));
  }

  static double seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

  BenchArm& bench_;
  const ArmFile& file_;
  const Prompt& prompt_;
  const std::atomic<bool>& stop_;
  std::vector<CheckResult> results_;
};

}  // namespace

std::vector<CheckResult> feel_check(BenchArm& bench, const ArmFile& file, const Prompt& prompt,
                                    const std::atomic<bool>& stop) {
  return Check(bench, file, prompt, stop).run();
}

std::vector<std::pair<double, Eigen::Vector3d>> feel_check_hand(const Eigen::Vector3d& p_WT) {
  std::vector<std::pair<double, Eigen::Vector3d>> way;
  const auto go = [&](double time, double x, double y, double z) {
    way.emplace_back(time, p_WT + kMove * Eigen::Vector3d(x, y, z));
  };
  go(0, 0, 0, 0);
  go(1, 1, 1, 0);
  go(2, -1, 0, 1);
  go(3, 0, -1, -1);
  go(kEncoders_s - 0.2, 0, 0, 0);
  for (int axis = 0; axis < 3; ++axis) {
    const double begin = kEncoders_s + axis * kDirection_s;
    const Eigen::Vector3d there = Eigen::Vector3d::Unit(axis);
    go(begin, 0, 0, 0);
    go(begin + 0.8, there.x(), there.y(), there.z());
    go(begin + 1.6, 0, 0, 0);
  }
  return way;
}

}  // namespace thimble::app
