#include "hil/tied_spring.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>
#include <vector>

#include "bringup/push_direction.h"

namespace thimble::hil {
namespace {

using Eigen::Vector3d;

constexpr const char* kName = "force_accuracy";
constexpr double kForceMax = 0.9;  // N
constexpr int kSteps = 9;          // up, and as many down
constexpr double kStep_s = 0.7;    // s, of each
constexpr double kLooked_s = 0.2;  // s, measured part at its end
constexpr double kDamping = 2;     // N s/m: an undamped tip oscillates for long [chosen]
constexpr double kFar = 0.04;      // m; a longer elongation means that the spring has come off

/// Slope and its standard error of y over x, with a separate offset for each of two groups.
struct Slope {
  double value = 0, error = 0;
};
Slope slope_of(const std::vector<Eigen::Vector3d>& rows, const std::vector<double>& y) {
  Eigen::MatrixXd A(static_cast<Eigen::Index>(rows.size()), 3);
  Eigen::VectorXd b(A.rows());
  for (Eigen::Index i = 0; i < A.rows(); ++i) {
    A.row(i) = rows[static_cast<std::size_t>(i)].transpose();
    b[i] = y[static_cast<std::size_t>(i)];
  }
  const Eigen::Matrix3d N = (A.transpose() * A).inverse();
  const Eigen::Vector3d theta = N * (A.transpose() * b);
  const double variance = (A * theta - b).squaredNorm() / static_cast<double>(A.rows() - 3);
  return {theta[0], std::sqrt(variance * N(0, 0))};
}

}  // namespace

HilResult check_tied_spring(const HilRig& rig, double stiffness) {
  if (stiffness == 0) {
    return skipped(kName, "No spring stiffness was given (--spring).");
  }
  if (!rig.attended) return skipped(kName, "A person must tie the spring to the tip (--attended).");
  const Vector3d direction_W = bringup::push_direction(rig.file);
  const std::string along = std::abs(direction_W.y()) == 1
                                ? "y (to your right)"
                                : fmt::format("the direction ({:.2g}, {:.2g}, {:.2g}) of the world",
                                              direction_W.x(), direction_W.y(), direction_W.z());
  if (!rig.prompt("Tie the spring to the tip and to a fixed point, along " + along +
                  ", without slack or tension, and let go.")) {
    return skipped(kName, "The prompt was cancelled.");
  }
  auto opened = open_active(rig, TipHold::kSpring);
  if (!opened) return broken_off(kName, opened.error().message, nullptr);
  bringup::BenchArm& bench = **opened;
  const Vector3d p_start_W = bench.device().state().p_WT;
  std::vector<Vector3d> rows;  // requested force, and whether it was on the way up or down
  std::vector<double> way;     // m
  for (int i = 1; i < 2 * kSteps; ++i) {
    const bool up = i <= kSteps;
    const double asked = kForceMax * (up ? i : 2 * kSteps - i) / kSteps;
    const double begin = bench.now();
    double sum = 0, sent = 0;
    int seen = 0;
    bool off = false;
    const auto law = [&](const driver::DeviceState& state) -> Vector3d {
      const double gone = direction_W.dot(state.p_WT - p_start_W);
      off = off || !(std::abs(gone) < kFar);
      if (off) return {0, 0, 0};
      if (bench.now() - begin > kStep_s - kLooked_s) {
        sum += gone;
        sent += direction_W.dot(bench.device().f_sent_W());
        ++seen;
      }
      return (asked - kDamping * direction_W.dot(state.v_WT)) * direction_W;
    };
    if (!bench.run(kStep_s, law, rig.stop)) return broken_off(kName, "", &bench);
    if (off) {
      bench.device().deactivate();
      return broken_off(kName,
                        "The tip moved more than 4 cm: the spring is not tied to it, or is softer "
                        "than the given stiffness.",
                        &bench);
    }
    // A tip follows only after dry friction has reversed: by its size after the beginning, by twice
    // that after the turn. Half more is allowed for an arm with more friction than in its file.
    const double rubs = 1.5 * rig.file.simulated.plant.coulomb;
    if (i == kSteps || (up ? asked < rubs : asked > kForceMax - 2 * rubs)) continue;
    rows.emplace_back(sent / seen, up ? 1 : 0, up ? 0 : 1);
    way.push_back(sum / seen);
  }
  bench.device().deactivate();
  if (rows.size() < 6) {
    return skipped(kName, "The dry friction of the arm is too high for this weak pull.");
  }
  const Slope slope = slope_of(rows, way);
  const double ratio = stiffness * slope.value;
  const double spread = 2 * stiffness * slope.error;
  return judged(kName,
                fmt::format("The motors produce {:.3f} +- {:.3f} N for each requested newton, "
                            "measured with a spring of {:g} N/m.",
                            ratio, spread, stiffness),
                {{"force_ratio", ratio, "", ">= 0.95", ""},
                 {"force_ratio_above", ratio, "", "<= 1.05", "upper bound of the same value"}});
}

}  // namespace thimble::hil
