#include "bringup/feel_check.h"

#include <fmt/core.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "bringup/wiring_guess.h"
#include "hand/place_text.h"
#include "thimble/scene/arm_simulation.h"

namespace thimble::bringup {
namespace {

constexpr double kEncoders_s = 4, kDirection_s = 2, kSettle_s = 0.5, kPush_s = 1;
constexpr double kForce = 0.4;       // N, below kFeelCheckForceMax
constexpr double kStrongest = 0.49;  // N, for a tip that dry friction holds; also below that limit
// A push that moves the tip less is increased, m [chosen: four steps of the coarsest encoder].
constexpr double kYields = 0.0003;
constexpr double kMove = 0.03;  // m, requested motion of the hand
constexpr std::array<const char*, 3> kAxes = {"x (towards you)", "y (to your right)", "z (up)"};

const BenchArm::Law kRest = [](const driver::DeviceState&) { return Eigen::Vector3d(0, 0, 0); };

class Check {
 public:
  Check(BenchArm& bench, const scene::ArmFile& file, const Prompt& prompt,
        const std::atomic<bool>& stop, const Question& question)
      : bench_(bench),
        file_(file),
        axes_(feel_check_axes(file)),
        prompt_(prompt),
        stop_(stop),
        question_(question) {}

  std::vector<CheckResult> run() {
    // Each part requires the previous ones; the first that fails or is skipped ends the check.
    const bool all = axes() && encoders() && directions() && pushes() && watchdog();
    bench_.device().deactivate();
    const driver::Fault fault = bench_.device().fault();
    if (!all && fault != driver::Fault::kNone && !answers_only_) {
      results_.push_back({"fault", false, std::string(driver::describe(fault))});
    }
    return std::move(results_);
  }

 private:
  bool note(std::string name, bool passed, std::string text) {
    results_.push_back({std::move(name), passed, std::move(text)});
    return passed;
  }

  /// Returns whether the tip moves along axes of the world, which the prompts name.
  bool axes() {
    if (!axes_.empty()) return true;
    return note("axes", false,
                "The line or plane of the tip is not along axes of the world, which the feel check "
                "names. Place it along them for the check (`at` in the arm file).");
  }

  bool encoders() {
    if (!prompt_("Move the grip slowly through its whole workspace for 4 seconds.")) return false;
    std::array<std::int32_t, 3> lowest{INT32_MAX, INT32_MAX, INT32_MAX};
    std::array<std::int32_t, 3> highest{INT32_MIN, INT32_MIN, INT32_MIN};
    const auto watch = [&](const driver::DeviceState& state) {
      for (std::size_t i = 0; i < 3; ++i) {
        lowest[i] = std::min(lowest[i], state.counts[i]);
        highest[i] = std::max(highest[i], state.counts[i]);
      }
      return Eigen::Vector3d(0, 0, 0);
    };
    if (!bench_.run(kEncoders_s, watch, stop_)) return false;
    constexpr std::int32_t kTravelMin = 100;  // counts; a few mm at the tip of every supported arm
    std::array<int, 3> travel{};
    const auto motors = static_cast<std::size_t>(file_.motors());
    for (std::size_t i = 0; i < motors; ++i) travel[i] = highest[i] - lowest[i];
    std::string dead, counted;
    for (std::size_t i = 0; i < motors; ++i) {
      counted += fmt::format("{}{}", i == 0 ? "" : i + 1 < motors ? ", " : " and ", travel[i]);
      if (travel[i] < kTravelMin)
        dead += fmt::format(" Encoder {} does not count.", static_cast<int>(i) + 1);
    }
    return note("encoders", dead.empty(),
                fmt::format("The encoder{} moved {} counts{}", motors == 1 ? "" : "s", counted,
                            dead.empty() ? "." : "; expected at least 100 each.") +
                    dead);
  }

  /// Asks for one movement along each axis; together they identify the wrong wire.
  bool directions() {
    bool right = true;
    for (const int axis : axes_) {
      if (!direction(axis, right)) return false;
    }
    if (right) return true;
    if (file_.motors() < 3) {
      return note("encoder wires", false,
                  "An encoder counts backwards, or two are swapped. Run `thimble calibrate`.");
    }
    // The user chooses the size of each movement; only the directions count.
    const Eigen::Matrix3d moves = expected_moves();
    const auto expected = [&](const WiringGuess& guess) -> Eigen::Matrix3d {
      return (guess.matrix(radians_per_count()) * moves).colwise().normalized();
    };
    const std::string text = describe_wiring(guess_wiring(moves_.colwise().normalized(), expected),
                                             "Encoder", "counts backwards", "does not count");
    return note("encoder wires", false,
                text.empty() ? "Each encoder counts correctly for these movements. Check `base` in "
                               "the arm file, or move in a straighter line."
                             : text);
  }

  /// Pushes along each axis. Swapped motors produce a force different from the requested one, up to
  /// several times as large. So the pushes are small enough that no wiring exceeds the limit.
  bool pushes() {
    bool right = true;
    constexpr double kMargin = 0.9;  // for a grip that is not in the middle
    double worst = 1;
    if (file_.motors() == 3) {
      for_each_wiring([&](const WiringGuess& guess) {
        const Eigen::Matrix3d forces = tip_forces(guess);
        worst = std::max(worst, forces.operatorNorm());
      });
    } else if (file_.motors() == 2) {
      worst = std::max(worst, swapped_force());
    }
    push_ = std::min(kForce, kMargin * scene::kFeelCheckForceMax / worst);
    for (const int axis : axes_) {
      if (!push(axis, right)) return false;
    }
    if (right) return true;
    if (pushed_.cwiseAbs().maxCoeff() < kYields) {
      return note("motor wires", false,
                  fmt::format("The tip did not move under {:.2f} N along any axis, the highest "
                              "force that the feel check allows. The dry friction is higher, you "
                              "held the grip firmly, or the motors have no power.",
                              kStrongest));
    }
    if (file_.motors() < 3) {
      return note("motor wires", false,
                  "A motor pulls backwards, does not pull, or is swapped with the other; or you "
                  "held the grip firmly. Correct its wire or motor_sign in the arm file.");
    }
    const auto expected = [this](const WiringGuess& guess) { return tip_forces(guess); };
    const std::string text = describe_wiring(guess_wiring(pushed_, expected), "Motor",
                                             "pulls backwards", "does not pull");
    return note(
        "motor wires", false,
        text.empty() ? "Each motor pulls correctly; you held the grip firmly or pushed it." : text);
  }

  /// Returns the joint rotation when the tip moves from the middle of the workspace by `step`, rad.
  Eigen::Vector3d angles_from_middle(const Eigen::Vector3d& step) const {
    const auto there = scene::joint_angles_at(file_, file_.workspace.middle() + step);
    const auto here = scene::joint_angles_at(file_, file_.workspace.middle());
    return there && here ? *there - *here : Eigen::Vector3d(0, 0, 0);
  }

  /// Returns the changes of the joint angles when the grip moves along each axis, a column for
  /// each.
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

  /// Returns the forces of pushes of 1 N along each axis with a wiring of the motors, N in the
  /// world, a column for each.
  Eigen::Matrix3d tip_forces(const WiringGuess& guess) const {
    Eigen::Vector3d torque;  // per ampere, at the joint
    for (std::size_t i = 0; i < 3; ++i) {
      const driver::MotorDrive& drive = file_.model.drives[i];
      torque[static_cast<Eigen::Index>(i)] = drive.ratio * drive.torque_constant;
    }
    const Eigen::Matrix3d J = jacobian();
    return J.transpose().inverse() * guess.matrix(torque) * J.transpose();
  }

  /// Returns the largest force at the tip for 1 N requested, if the two motors of an arm are
  /// swapped.
  double swapped_force() const {
    const Eigen::Vector3d p_BT = file_.R_WB.transpose() * (file_.workspace.middle() - file_.p_WB);
    const auto q = driver::inverse(file_.model.geometry, p_BT);
    if (!q) return 1;
    Eigen::Vector3d p;
    Eigen::Matrix3d J, swapped;
    std::visit([&](const auto& build) { build.forward(*q, p, J); }, file_.model.geometry);
    const auto torque = [&](std::size_t i) {
      return file_.model.drives[i].ratio * file_.model.drives[i].torque_constant;
    };
    // The current for one motor drives the other.
    swapped << 0, torque(0) / torque(1), 0, torque(1) / torque(0), 0, 0, 0, 0, 1;
    return (J.transpose().inverse() * swapped * J.transpose()).operatorNorm();
  }

  /// Computes d p_WT / d q in the middle of the workspace, m/rad, by differences.
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

  /// Returns false if the check was ended; records whether the movement was correct.
  bool direction(int axis, bool& all_right) {
    const auto name = kAxes[static_cast<std::size_t>(axis)];
    if (!prompt_(fmt::format("Move the grip about 3 cm along {} and back within 2 seconds.", name)))
      return false;
    const Eigen::Vector3d from = bench_.device().state().p_WT;
    const Eigen::Vector3d q_from = bench_.device().state().q;
    Eigen::Vector3d farthest(0, 0, 0), q_farthest(0, 0, 0);
    const auto watch = [&](const driver::DeviceState& state) {
      const Eigen::Vector3d away = state.p_WT - from;
      if (away.norm() > farthest.norm()) farthest = away;
      // The angles are valid even if wrong ones give no pose.
      if ((state.q - q_from).norm() > q_farthest.norm()) q_farthest = state.q - q_from;
      return Eigen::Vector3d(0, 0, 0);
    };
    if (!bench_.run(kDirection_s, watch, stop_)) return false;
    moves_.col(axis) = q_farthest;
    const bool right = farthest[axis] > 0.01 && farthest[axis] > 0.7 * farthest.norm();
    all_right = all_right && right;
    note(fmt::format("direction {}", "xyz"[axis]), right,
         fmt::format("The tip moved by {} mm when you moved it along {}{}",
                     scene::place_text(1e3 * farthest, 1), name,
                     right ? "." : ". Run `thimble calibrate`."));
    return true;
  }

  /// Pushes along a unit vector of the world for kPush_s, then harder by small steps while the tip
  /// has moved less than kYields, up to kStrongest. Sets `force` (N) to the last push. Returns
  /// false if the check was ended or a fault occurred. A tip that moves far is released.
  bool push_until_it_yields(const Eigen::Vector3d& along, double& force) {
    constexpr double kFar = 0.02, kStep = 0.02, kStep_s = 0.1;  // m, N, s
    const Eigen::Vector3d from = bench_.device().state().p_WT;
    bool far = false;
    const auto law = [&](const driver::DeviceState& state) -> Eigen::Vector3d {
      far = far || !((state.p_WT - from).norm() < kFar);
      return far ? Eigen::Vector3d(0, 0, 0) : Eigen::Vector3d(force * along);
    };
    if (!bench_.run(kPush_s, law, stop_)) return false;
    while (!((bench_.device().state().p_WT - from).norm() >= kYields) && force < kStrongest) {
      force = std::min(kStrongest, force + kStep);
      if (!bench_.run(kStep_s, law, stop_)) return false;
    }
    return true;
  }

  /// Returns false if the check was ended; records whether the tip yielded in the right direction.
  /// It pulls first and pushes then, so that neither end contains the dry friction of the initial
  /// rest.
  bool push(int axis, bool& all_right) {
    const auto name = kAxes[static_cast<std::size_t>(axis)];
    if (!prompt_(fmt::format("Hold the grip loosely and still. It pulls and pushes with {:.2f} N "
                             "along {}, and with up to {:.2f} N if that does not move it.",
                             push_, name, kStrongest)))
      return false;
    if (!bench_.device().activate() || !bench_.run(kSettle_s, kRest, stop_)) return false;
    const Eigen::Vector3d along = Eigen::Vector3d::Unit(axis);
    double force = push_;
    if (!push_until_it_yields(-along, force)) return false;
    const Eigen::Vector3d pulled = bench_.device().state().p_WT;
    if (!push_until_it_yields(along, force)) return false;
    const Eigen::Vector3d moved = bench_.device().state().p_WT - pulled;
    pushed_.col(axis) = moved * (push_ / force);
    if (!bench_.run(kSettle_s, kRest, stop_)) return false;
    bench_.device().deactivate();
    const bool right = moved[axis] > 0.0002 && moved[axis] > 0.5 * moved.norm();
    all_right = all_right && right;
    friction_ = std::max(friction_, force > push_ && right ? force : 0);
    const bool stuck = moved.norm() < kYields;
    note(fmt::format("force {}", "xyz"[axis]), right,
         fmt::format(
             "{:.2f} N along {} moved the tip by {} mm{}{}", force, name,
             scene::place_text(1e3 * moved, 2),
             right ? "."
             : stuck
                 ? ": dry friction holds it, a motor is wired incorrectly, or you held it firmly."
                 : ": a motor is wired incorrectly, or you held it firmly.",
             right && force > push_ ? " A smaller force did not move it, because of dry friction."
                                    : ""));
    return true;
  }

  /// Pulls and pushes along x twice. The first push ends with zero force, which shows how far the
  /// hand returns the tip; the second with silence. Dry friction of more than half of the push
  /// holds the tip where it is, so the user is asked whether the arm released it. An arm that sends
  /// only when asked is read once after the silence.
  bool watchdog() {
    constexpr double kBack_s = 0.6;
    constexpr int kAsked = 5;  // ticks
    if (!prompt_("Hold the grip loosely and still. It pulls and pushes twice. After the second "
                 "push Thimble stops sending, and the arm must release the grip by itself."))
      return false;
    if (!bench_.device().activate() || !bench_.run(kSettle_s, kRest, stop_)) return false;
    const int axis = axes_.front();
    const Eigen::Vector3d along = Eigen::Vector3d::Unit(axis);
    const auto x = [this, axis] { return bench_.device().state().p_WT[axis]; };
    double force = std::max(kForce, std::min(kStrongest, friction_)), start = 0;
    // Dry friction leaves the tip anywhere between the ends of a pull and of a push. Each push
    // begins at the other end, so that both move in the same direction.
    const auto press = [&] {
      if (!push_until_it_yields(-along, force)) return false;
      start = x();
      return push_until_it_yields(along, force);
    };
    if (!press()) return false;
    const double pushed = x();
    if (pushed - start < kYields) {
      bench_.device().deactivate();
      return note("watchdog", false,
                  fmt::format("{:.2f} N did not move the tip, so the watchdog could not be tested. "
                              "The dry friction is higher, or you held the grip firmly.",
                              force));
    }
    if (!bench_.run(kBack_s, kRest, stop_)) return false;
    const double back = pushed - x();
    const bool comes_back = back > kYields / 2 && back > 0.3 * (pushed - start);
    if (!press()) return false;
    const double let_go = x() - back / 2, silent_since = bench_.now();
    double off_after = -1;
    int reports = 0;
    const auto watch = [&](const driver::DeviceState& state) {
      reports += state.fresh ? 1 : 0;
      if (off_after < 0 && state.p_WT[axis] < let_go) off_after = bench_.now() - silent_since;
      return Eigen::Vector3d(0, 0, 0);
    };
    const double named = seconds(file_.limits.watchdog_ns), allowed = 2 * named;
    bench_.run(allowed + kBack_s, watch, stop_, true);
    constexpr int kAnswersMax = 3;  // answers in flight from an arm that sends only when asked
    // Its reports ended with the messages, which the driver treats as a fault.
    const bool answers_only = reports <= kAnswersMax;
    const double left = allowed + kBack_s - (bench_.now() - silent_since);
    answers_only_ = answers_only;
    if (answers_only) {
      bench_.stay_silent(std::max(0.0, left), stop_);
    } else {
      bench_.run(std::max(0.4, 3 * named), watch, stop_, true);
    }
    if (!comes_back) {
      // The question comes before zero is sent, so that only the watchdog can have released the
      // tip.
      const auto answer = question_ && !stop_.load() ? question_("Has the arm stopped pushing?")
                                                     : std::optional<bool>();
      bench_.device().deactivate();
      return !stop_.load() && by_feel(answer, force);
    }
    const double read_after = bench_.now() - silent_since;
    bench_.device().deactivate();
    if (stop_.load()) return false;
    if (answers_only) {
      // The first answer may have been sampled before the silence. Until the others arrive, the
      // zero force that requests them has hardly moved the tip.
      bench_.ask(kAsked);
      const bool off = x() < let_go;
      return note("watchdog", off,
                  off ? fmt::format("The arm sends reports only on request. A request {:.0f} ms "
                                    "after the last message showed that the motors were off.",
                                    read_after * 1e3)
                      : fmt::format("The arm sends reports only on request. A request {:.0f} ms "
                                    "after the last message showed that the motors did not go off. "
                                    "Switch the arm off at its switch.",
                                    read_after * 1e3));
    }
    const bool right = off_after > 0 && off_after < allowed;
    return note(
        "watchdog", right,
        off_after > 0
            ? fmt::format("The force fell to half {:.0f} ms after the last message{}",
                          off_after * 1e3, right ? "." : ", later than the arm file allows.")
            : std::string("The motors did not go off. Switch the arm off at its switch."));
  }

  /// Records the user's answer if dry friction hides the effect of the motors.
  bool by_feel(const std::optional<bool>& answer, double force) {
    const std::string why = fmt::format(
        "Dry friction of more than {:.2f} N holds the tip in place, so its position does not show "
        "when the motors go off. ",
        force / 2);
    if (!answer)
      return note("watchdog", false,
                  why + "The question whether the arm stopped pushing was not answered.");
    return note(
        "watchdog", *answer,
        why + (*answer ? "You answered that the arm stopped pushing."
                       : "You answered that the motors did not go off. Switch the arm off at "
                         "its switch."));
  }

  static double seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

  BenchArm& bench_;
  const scene::ArmFile& file_;
  const std::vector<int> axes_;  // of the world, along which the tip moves
  const Prompt& prompt_;
  const std::atomic<bool>& stop_;
  const Question& question_;
  std::vector<CheckResult> results_;
  double push_ = kForce;       // N
  bool answers_only_ = false;  // the arm sends only when asked, so silence is not a fault
  double friction_ = 0;        // N, min. force that moved the tip
  Eigen::Matrix3d moves_ = Eigen::Matrix3d::Zero();   // joint angles, a column for each movement
  Eigen::Matrix3d pushed_ = Eigen::Matrix3d::Zero();  // of the tip, m, a column for each push
};

}  // namespace

std::vector<CheckResult> feel_check(BenchArm& bench, const scene::ArmFile& file,
                                    const Prompt& prompt, const std::atomic<bool>& stop,
                                    const Question& question) {
  return Check(bench, file, prompt, stop, question).run();
}

std::vector<int> feel_check_axes(const scene::ArmFile& file) {
  if (file.motors() == 3) return {0, 1, 2};
  std::vector<int> axes;
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 0; i < file.motors(); ++i) {
      if (std::abs(file.R_WB(axis, i)) == 1) axes.push_back(axis);
    }
  }
  if (static_cast<int>(axes.size()) != file.motors()) axes.clear();
  return axes;
}

std::size_t feel_checks(const scene::ArmFile& file) {
  return 2 + 2 * static_cast<std::size_t>(file.motors());
}

std::vector<std::pair<double, Eigen::Vector3d>> feel_check_hand(const Eigen::Vector3d& p_WT,
                                                                const std::vector<int>& axes) {
  std::vector<std::pair<double, Eigen::Vector3d>> way;
  const auto go = [&](double time, double x, double y, double z) {
    way.emplace_back(time, p_WT + kMove * Eigen::Vector3d(x, y, z));
  };
  go(0, 0, 0, 0);
  go(1, 1, 1, 0);
  go(2, -1, 0, 1);
  go(3, 0, -1, -1);
  go(kEncoders_s - 0.2, 0, 0, 0);
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const int axis = axes[i];
    const double begin = kEncoders_s + static_cast<double>(i) * kDirection_s;
    const Eigen::Vector3d there = Eigen::Vector3d::Unit(axis);
    go(begin, 0, 0, 0);
    go(begin + 0.8, there.x(), there.y(), there.z());
    go(begin + 1.6, 0, 0, 0);
  }
  return way;
}

}  // namespace thimble::bringup
