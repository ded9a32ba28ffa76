#include "hil/known_places.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <variant>

namespace thimble::hil {
namespace {

using Eigen::Vector3d;

constexpr double kHold_s = 1.5, kChange_s = 2;  // to hold the tip, or to bring it to the next point
constexpr double kHome = 0.005;                 // m [chosen: error of a careful hand]
constexpr double kSides = 0.003;       // m [chosen: three times the backlash of a good arm]
constexpr double kLengthShare = 0.03;  // [chosen: 3 mm of 100 mm from mark to mark]
constexpr double kAngle = 10;          // degrees
constexpr double kApproach = 0.02;     // m, distance from which a simulated hand comes home

/// Tip of an arm file when its counters are zero, m in the world.
Vector3d home_of(const scene::ArmFile& file) {
  const Vector3d q = file.model.joint_angles({});
  Vector3d p_BT;
  Eigen::Matrix3d J;
  std::visit([&](const auto& build) { build.forward(q, p_BT, J); }, file.model.geometry);
  return file.p_WB + file.R_WB * p_BT;
}

/// Reads the tip with zero force after a time in which it is held; empty if stopped.
std::optional<Vector3d> tip_after(bringup::BenchArm& bench, double seconds,
                                  const std::atomic<bool>& stop) {
  constexpr int kMeans = 100;  // ticks
  Vector3d sum(0, 0, 0);
  int count = 0;
  const auto rest = [](const driver::DeviceState&) { return Vector3d(0, 0, 0); };
  const auto read = [&](const driver::DeviceState& state) {
    sum += state.p_WT;
    ++count;
    return Vector3d(0, 0, 0);
  };
  if (!bench.run(seconds - 0.001 * kMeans, rest, stop)) return {};
  if (!bench.run(0.001 * kMeans, read, stop) || count == 0) return {};
  return sum / count;
}

}  // namespace

HilResult check_home_pose(const HilRig& rig) {
  constexpr const char* kName = "home_pose";
  if (rig.file.is<driver::DeltaArm>() || rig.file.is<driver::VendorPoseArm>()) {
    return skipped(kName, "This arm finds its zero by itself.");
  }
  if (!rig.attended) {
    return skipped(kName, "A person must bring the arm into its home pose (--attended).");
  }
  auto opened = rig.open(TipHold::kHome);
  if (!opened) return broken_off(kName, opened.error().message, nullptr);
  bringup::BenchArm& bench = **opened;
  std::vector<Vector3d> found;
  for (const char* side : {"left and from below", "right and from above"}) {
    if (!rig.prompt(fmt::format("Bring the arm exactly into its home pose, from the {}, and hold "
                                "it there for 2 seconds.",
                                side))) {
      return not_run(kName, "The prompt was cancelled.");
    }
    const auto tip = tip_after(bench, found.empty() ? kHold_s : kChange_s, rig.stop);
    if (!tip) return broken_off(kName, "The check ended before the pose was read.", &bench);
    found.push_back(*tip);
  }
  const Vector3d home = home_of(rig.file);
  const double apart = (found[0] - found[1]).norm();
  const double offset = std::max((found[0] - home).norm(), (found[1] - home).norm());
  return judged(
      kName,
      fmt::format("In the home pose the tip is {:.1f} mm from the position of the arm file; the "
                  "poses from the two sides are {:.1f} mm apart.{}",
                  1e3 * offset, 1e3 * apart,
                  offset > kHome ? " The arm was switched on in another pose, or home_counts or "
                                   "the links of the arm file are wrong. Run `thimble calibrate`."
                                 : ""),
      {{"home_beside", 1e3 * offset, "mm", fmt::format("<= {:g}", 1e3 * kHome), ""},
       {"home_sides_apart", 1e3 * apart, "mm", fmt::format("<= {:g}", 1e3 * kSides), ""}});
}

HilResult check_known_length(const HilRig& rig, double length) {
  constexpr const char* kName = "known_length";
  if (length == 0) {
    return skipped(kName,
                   "No length was given (--known-length), so the scale of encoders, capstans and "
                   "links is not tested.");
  }
  if (!rig.attended) return skipped(kName, "A person must move the tip (--attended).");
  auto opened = rig.open(TipHold::kLength);
  if (!opened) return broken_off(kName, opened.error().message, nullptr);
  bringup::BenchArm& bench = **opened;
  constexpr std::array kAlong = {"x (towards you)", "y (to your right)", "z (up)"};
  std::vector<session::Figure> figures;
  std::string text;
  bool begun = false;
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    std::array<Vector3d, 2> ends;
    for (const bool far : {false, true}) {
      if (!rig.prompt(fmt::format("Hold the tip on the {} mark of {:g} mm along {} for 2 seconds.",
                                  far ? "second" : "first", 1e3 * length, kAlong[i]))) {
        return not_run(kName, "The prompt was cancelled.");
      }
      const auto tip = tip_after(bench, begun ? kChange_s : kHold_s, rig.stop);
      if (!tip) return broken_off(kName, "The check ended before the tip was read.", &bench);
      begun = true;
      ends[far ? 1 : 0] = *tip;
    }
    const Vector3d moved = ends[1] - ends[0];
    const double angle =
        std::atan2((moved - moved[axis] * Vector3d::Unit(axis)).norm(), moved[axis]) * 180 /
        std::numbers::pi;
    text +=
        fmt::format("{}{:.1f} mm along {}", text.empty() ? "" : ", ", 1e3 * moved.norm(), "xyz"[i]);
    figures.push_back({fmt::format("length_{}_off", "xyz"[i]),
                       100 * std::abs(moved.norm() / length - 1), "%",
                       fmt::format("<= {:g}", 100 * kLengthShare), ""});
    figures.push_back({fmt::format("length_{}_turned", "xyz"[i]), angle, "degrees",
                       fmt::format("<= {:g}", kAngle), ""});
  }
  HilResult result = judged(kName, fmt::format("{:g} mm were measured as {}.", 1e3 * length, text),
                            std::move(figures));
  if (result.outcome == HilOutcome::kFailed) {
    result.text +=
        " Counts per turn, ratio, link lengths, base or home position in the arm file are wrong, "
        "or an encoder loses counts.";
  }
  return result;
}

device_sim::HandSettings firm_hand() {
  return {.mass = 0.025, .stiffness = 2000, .damping = 14};
}

std::vector<std::pair<double, Vector3d>> home_pose_hand(const scene::ArmFile& file) {
  const Vector3d home = home_of(file), offset = kApproach * Vector3d(0, -1, -1).normalized();
  return {{0, home + offset}, {1, home}, {2, home}, {2.4, home - offset}, {3, home}, {10, home}};
}

std::vector<std::pair<double, Vector3d>> known_length_hand(const scene::ArmFile& file,
                                                           double length) {
  const Vector3d middle = file.workspace.middle();
  std::vector<std::pair<double, Vector3d>> way{{0, middle}};
  for (int axis = 0; axis < 3; ++axis) {
    const double begin = 2 * kChange_s * axis;
    const Vector3d half = 0.5 * length * Vector3d::Unit(axis);
    way.emplace_back(begin + 0.8, middle - half);
    way.emplace_back(begin + 1.6, middle - half);
    way.emplace_back(begin + 2.6, middle + half);
    way.emplace_back(begin + 3.6, middle + half);
  }
  return way;
}

}  // namespace thimble::hil
