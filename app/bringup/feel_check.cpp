#include "bringup/feel_check.h"

#include <fmt/core.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "bringup/wiring_guess.h"
#include "hand/place_text.h"
#include "thimble/scene/arm_simulation.h"

namespace thimble::app {
namespace {

constexpr double kEncoders_s = 4, kDirection_s = 2, kSettle_s = 0.5, kPush_s = 1;
constexpr double kForce = 0.4;  // N, below kFeelCheckForceMax
constexpr double kMove = 0.03;  // m, what the hand is asked for
constexpr std::array<const char*, 3> kAxes = {"x (towards you)", "y (to your right)", "z (up)"};

const BenchArm::Law kRest = [](const driver::DeviceState&) { return Eigen::Vector3d(0, 0, 0); };

class Check {
 public:
  Check(BenchArm& bench, const scene::ArmFile& file, const Prompt& prompt,
        const std::atomic<bool>& stop)
      : bench_(bench), file_(file), prompt_(prompt), stop_(stop) {}

  std::vector<CheckResult> run() {
    // Each part needs the ones before it; the first that fails or is left ends the check.
    const bool all = encoders() && directions() && pushes() && watchdog();
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
    if (!prompt_("Move the grip slowly through its whole workspace for four seconds."))
      return false;
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
    std::string dead;
    for (std::size_t i = 0; i < 3; ++i) {
      if (travel[i] < kTravelMin)
        dead += fmt::format(" Encoder {} does not count.", static_cast<int>(i) + 1);
    }
    return note("encoders", dead.empty(),
                fmt::format("The encoders travelled {}, {} and {} counts{}", travel[0], travel[1],
                            travel[2], dead.empty() ? "." : "; at least 100 each were expected.") +
                    dead);
  }

  /// Asks for one movement along each axis; what they show together tells which wire is wrong.
  bool directions() {
    bool right = true;
    for (int axis = 0; axis < 3; ++axis) {
      if (!direction(axis, right)) return false;
    }
    if (right) return true;
    // How far the grip was moved each time is the user's; only the directions count.
    const Eigen::Matrix3d moves = expected_moves();
    const auto expected = [&](const WiringGuess& guess) -> Eigen::Matrix3d {
      return (guess.matrix(radians_per_count()) * moves).colwise().normalized();
    };
    const std::string text = describe_wiring(guess_wiring(moves_.colwise().normalized(), expected),
                                             "Encoder", "counts backwards", "does not count");
    return note("encoder wires", false,
                text.empty() ? "Each encoder counts as it should for such movements: look at the "
                               "arm file's base, or move straighter."
                             : text);
  }

  /// Pushes along each axis in the same way. Motors that are swapped make another force than the
  /// one that was asked for, up to some times as large: so the pushes are so small that no wiring
  /// makes one above the limit.
  bool pushes() {
    bool right = true;
    constexpr double kMargin = 0.9;  // for a grip that is not in the middle
    double worst = 1;
    for_each_wiring([&](const WiringGuess& guess) {
      const Eigen::Matrix3d forces = tip_forces(guess);
      worst = std::max(worst, forces.operatorNorm());
    });
    push_ = std::min(kForce, kMargin * scene::kFeelCheckForceMax / worst);
    for (int axis = 0; axis < 3; ++axis) {
      if (!push(axis, right)) return false;
    }
    if (right) return true;
    const auto expected = [this](const WiringGuess& guess) { return tip_forces(guess); };
    const std::string text = describe_wiring(guess_wiring(pushed_, expected), "Motor",
                                             "pulls backwards", "does not pull");
    return note("motor wires", false,
                text.empty()
                    ? "Each motor pulls as it should: you held the grip fast, or pushed it."
                    : text);
  }

  /// Returns how far the joints turn when the tip goes from the middle of the workspace by `step`,
  /// rad.
  Eigen::Vector3d angles_from_middle(const Eigen::Vector3d& step) const {
    const auto there = scene::joint_angles_at(file_, file_.workspace.middle() + step);
    const auto here = scene::joint_angles_at(file_, file_.workspace.middle());
    return there && here ? *there - *here : Eigen::Vector3d(0, 0, 0);
  }

  /// Returns how the joint angles change when the grip is moved along each axis, a column for each.
  Eigen::Matrix3d expected_moves() const {
    Eigen::Matrix3d moves;
    for (int axis = 0; axis < 3; ++axis) {
      moves.col(axis) = angles_from_middle(kMove * Eigen::Vector3d::Unit(axis));
    }
    return moves;
  }

  Eigen::Vector3d radians_per_count() const {
    Eigen::Vector3d step;
    for (std::size_t i = 0; i < 3; ++i) {
      step[static_cast<Eigen::Index>(i)] = file_.model.step(i);
    }
    return step;
  }

  /// Returns the force that each push of 1 N along an axis makes with a wiring of the motors, N in
  /// the world, a column for each.
  Eigen::Matrix3d tip_forces(const WiringGuess& guess) const {
    Eigen::Vector3d torque;  // per ampere, at the joint
    for (std::size_t i = 0; i < 3; ++i) {
      const driver::MotorDrive& drive = file_.model.drives[i];
      torque[static_cast<Eigen::Index>(i)] = drive.ratio * drive.torque_constant;
    }
    const Eigen::Matrix3d J = jacobian();
    return J.transpose().inverse() * guess.matrix(torque) * J.transpose();
  }

  /// Finds d p_WT / d q in the middle of the workspace, m/rad, by differences.
  Eigen::Matrix3d jacobian() const {
    constexpr double kStep = 1e-4;  // m
    Eigen::Matrix3d angles_by_place;
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(axis);
      angles_by_place.col(axis) =
          (angles_from_middle(step) - angles_from_middle(-step)) / (2 * kStep);
    }
    return angles_by_place.inverse();
  }

  /// Answers false if the check was left; notes whether the movement was right.
  bool direction(int axis, bool& all_right) {
    const auto name = kAxes[static_cast<std::size_t>(axis)];
    if (!prompt_(
            fmt::format("Move the grip about 3 cm along {} and back within two seconds.", name)))
      return false;
    const Eigen::Vector3d from = bench_.device().state().p_WT;
    const Eigen::Vector3d q_from = bench_.device().state().q;
    Eigen::Vector3d farthest(0, 0, 0), q_farthest(0, 0, 0);
    const auto watch = [&](const driver::DeviceState& state) {
      const Eigen::Vector3d away = state.p_WT - from;
      if (away.norm() > farthest.norm()) farthest = away;
      // The angles are there even where wrong ones make no pose.
      if ((state.q - q_from).norm() > q_farthest.norm()) q_farthest = state.q - q_from;
      return Eigen::Vector3d(0, 0, 0);
    };
    if (!bench_.run(kDirection_s, watch, stop_)) return false;
    moves_.col(axis) = q_farthest;
    const bool right = farthest[axis] > 0.01 && farthest[axis] > 0.7 * farthest.norm();
    all_right = all_right && right;
    note(fmt::format("direction {}", "xyz"[axis]), right,
         fmt::format("The tip went by {} mm when moved along {}{}",
                     scene::place_text(1e3 * farthest, 1), name,
                     right ? "." : ": run `thimble calibrate`."));
    return true;
  }

  /// Answers false if the check was left; notes whether the tip yielded the right way. It pulls
  /// first and pushes then, so that the dry friction in which the tip rested is in neither end. A
  /// tip that goes far is not pushed on.
  bool push(int axis, bool& all_right) {
    constexpr double kFar = 0.02;  // m
    const auto name = kAxes[static_cast<std::size_t>(axis)];
    if (!prompt_(fmt::format(
            "Hold the grip loosely and still: it pulls and pushes with {:.2f} N along {}.", push_,
            name)))
      return false;
    if (!bench_.device().activate() || !bench_.run(kSettle_s, kRest, stop_)) return false;
    const Eigen::Vector3d rest = bench_.device().state().p_WT;
    Eigen::Vector3d f_T_W = -push_ * Eigen::Vector3d::Unit(axis);
    bool far = false;
    const auto law = [&](const driver::DeviceState& state) -> Eigen::Vector3d {
      far = far || !((state.p_WT - rest).norm() < kFar);
      return far ? Eigen::Vector3d(0, 0, 0) : f_T_W;
    };
    if (!bench_.run(kPush_s, law, stop_)) return false;
    const Eigen::Vector3d pulled = bench_.device().state().p_WT;
    f_T_W = -f_T_W;
    if (!bench_.run(kPush_s, law, stop_)) return false;
    const Eigen::Vector3d moved = bench_.device().state().p_WT - pulled;
    pushed_.col(axis) = moved;
    if (!bench_.run(kSettle_s, kRest, stop_)) return false;
    bench_.device().deactivate();
    const bool right = moved[axis] > 0.0002 && moved[axis] > 0.5 * moved.norm();
    all_right = all_right && right;
    note(fmt::format("force {}", "xyz"[axis]), right,
         fmt::format("{:.2f} N along {} moved the tip by {} mm{}", push_, name,
                     scene::place_text(1e3 * moved, 2),
                     right ? "." : ": a motor is wrong, or you held it fast."));
    return true;
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
    constexpr int kAnswersMax = 3;  // what was under way to an arm that speaks when spoken to
    int reports = 0;
    const auto watch = [&](const driver::DeviceState& state) {
      reports += state.fresh ? 1 : 0;
      if (off_after < 0 && state.p_WT.x() - from < pushed / 2) {
        off_after = bench_.now() - silent_since;
      }
      return Eigen::Vector3d(0, 0, 0);
    };
    bench_.run(std::max(1.0, 5 * seconds(file_.limits.watchdog_ns)), watch, stop_, true);
    bench_.device().deactivate();
    if (reports <= kAnswersMax) {
      return note("watchdog", true,
                  "The arm speaks only when spoken to, so its watchdog's time cannot be seen; it "
                  "pushed no more afterwards if you felt it let go.");
    }
    const double allowed = 2 * seconds(file_.limits.watchdog_ns);
    const bool right = off_after > 0 && off_after < allowed;
    return note("watchdog", right,
                off_after > 0
                    ? fmt::format("The force fell to half {:.0f} ms after the last message{}",
                                  off_after * 1e3, right ? "." : ", later than the arm file says.")
                    : std::string("The motors did not go off. Switch the arm off at its switch."));
  }

  static double seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

  BenchArm& bench_;
  const scene::ArmFile& file_;
  const Prompt& prompt_;
  const std::atomic<bool>& stop_;
  std::vector<CheckResult> results_;
  double push_ = kForce;                              // N
  Eigen::Matrix3d moves_ = Eigen::Matrix3d::Zero();   // joint angles, a column for each movement
  Eigen::Matrix3d pushed_ = Eigen::Matrix3d::Zero();  // of the tip, m, a column for each push
};

}  // namespace

std::vector<CheckResult> feel_check(BenchArm& bench, const scene::ArmFile& file,
                                    const Prompt& prompt, const std::atomic<bool>& stop) {
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
