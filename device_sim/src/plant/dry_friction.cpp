#include "plant/dry_friction.h"

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace thimble::device_sim {
namespace {

/// Solves for the axes that slide as in `guess` with the others at rest, to rounding. Returns the
/// guess itself if they would then slide the other way.
Eigen::Vector3d sliding_with(const Eigen::Matrix3d& inertia, const Eigen::Vector3d& momentum,
                             double bound, const Eigen::Vector3d& guess) noexcept {
  Eigen::Matrix3d of_sliding = inertia;
  Eigen::Vector3d right = momentum - bound * guess.cwiseSign();
  for (int i = 0; i < 3; ++i) {
    if (guess[i] != 0) continue;
    of_sliding.row(i).setZero();
    of_sliding.col(i).setZero();
    of_sliding(i, i) = 1;
    right[i] = 0;
  }
  Eigen::Vector3d v = of_sliding.inverse() * right;
  for (int i = 0; i < 3; ++i) {
    if (guess[i] == 0) v[i] = 0;
    if (v[i] * guess[i] < 0) return guess;
  }
  return v;
}

Eigen::Vector3d velocity_after_tip_friction(const Eigen::Matrix3d& inertia,
                                            const Eigen::Vector3d& momentum, double bound,
                                            const Eigen::Vector3d& v_before) noexcept {
  if (bound == 0) return inertia.inverse() * momentum;
  if ((v_before.array() != 0).all()) {
    const Eigen::Vector3d sliding = inertia.inverse() * (momentum - bound * v_before.cwiseSign());
    if ((sliding.array() * v_before.array() > 0).all()) return sliding;
  }
  // It ends after one round if the tip stays at rest, and after a few if masses differ by less than
  // a factor of ten between directions.
  constexpr int kRounds = 60;
  constexpr double kEnough = 1e-12;
  Eigen::Vector3d v = v_before;
  for (int round = 0; round < kRounds; ++round) {
    double change = 0, largest = 0;
    for (int i = 0; i < 3; ++i) {
      const double push = momentum[i] - inertia.row(i).dot(v) + inertia(i, i) * v[i];
      const double moved =
          std::abs(push) > bound ? (push - std::copysign(bound, push)) / inertia(i, i) : 0;
      change = std::max(change, std::abs(moved - v[i]));
      v[i] = moved;
      largest = std::max(largest, std::abs(moved));
    }
    if (!(change > kEnough * largest)) break;
  }
  return sliding_with(inertia, momentum, bound, v);
}

/// One line along which friction acts.
struct Line {
  Eigen::Vector3d along{0, 0, 0};
  Eigen::Vector3d yields{0, 0, 0};  // velocity change by a unit impulse along the line
  double bound = 0, impulse = 0;
  bool holds() const { return std::abs(impulse) < bound; }
  bool slides() const { return bound > 0 && !holds(); }
};
using Lines = std::array<Line, 6>;

/// Relaxes each line in turn: its impulse reduces the motion `v` along it as far as its limit
/// allows.
void relax_lines(Lines& lines, Eigen::Vector3d& v) noexcept {
  for (Line& line : lines) {
    if (!(line.bound > 0)) continue;
    const double wanted = line.impulse + line.along.dot(v) / line.along.dot(line.yields);
    const double impulse = std::clamp(wanted, -line.bound, line.bound);
    v -= (impulse - line.impulse) * line.yields;
    line.impulse = impulse;
  }
}

/// Solves for the velocity with the lines that hold now held exactly; a line that is already held
/// by others keeps its impulse. Returns the line whose assumed state is most wrong, with its
/// corrected state; none if this is the solution.
struct Wrong {
  Line* line = nullptr;
  double impulse = 0, by = 0;
};
Wrong hold(const Eigen::Matrix3d& inertia, const Eigen::Vector3d& momentum, Lines& lines,
           Eigen::Vector3d& v) noexcept {
  Eigen::Matrix3d free = Eigen::Matrix3d::Identity();  // projects on the free directions
  Eigen::Vector3d right = momentum;
  Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3> along(3, 0);
  std::array<Line*, 3> held{};
  for (Line& line : lines) {
    const Eigen::Vector3d own = free * line.along;
    if (!line.holds() || !(own.norm() > 1e-9 * line.along.norm())) {
      right -= line.impulse * line.along;
      continue;
    }
    free -= own * own.transpose() / own.squaredNorm();
    held[static_cast<std::size_t>(along.cols())] = &line;
    along.conservativeResize(3, along.cols() + 1);
    along.rightCols<1>() = line.along;
  }
  const Eigen::Matrix3d within =
      free * inertia * free + (Eigen::Matrix3d::Identity() - free) * inertia.trace();
  v = along.cols() == 3 ? Eigen::Vector3d(0, 0, 0)
                        : Eigen::Vector3d(free * (within.inverse() * (free * right)));
  Wrong worst;
  for (Line& line : lines) {
    if (!line.slides()) continue;
    // As the impulse that would hold the line, so that both kinds of violation are comparable.
    const double back = -std::copysign(1.0, line.impulse) * line.along.dot(v) /
                        line.along.dot(line.yields) / line.bound;
    if (back > worst.by) worst = {.line = &line, .impulse = 0, .by = back};
  }
  if (along.cols() == 0) return worst;
  const auto impulse = along.colPivHouseholderQr().solve(right - inertia * v).eval();
  for (Eigen::Index k = 0; k < along.cols(); ++k) {
    Line* const line = held[static_cast<std::size_t>(k)];
    const double over = std::abs(impulse[k]) / line->bound - 1;
    if (over > worst.by) {
      worst = {.line = line, .impulse = std::copysign(line->bound, impulse[k]), .by = over};
    }
  }
  return worst;
}

/// Finds the solution from lines that are nearly in their final states, by repeatedly correcting
/// the most wrong one. Returns whether it succeeded.
bool hold_exactly(const Eigen::Matrix3d& inertia, const Eigen::Vector3d& momentum, Lines lines,
                  Eigen::Vector3d& v) noexcept {
  constexpr int kExchanges = 12;
  constexpr double kRight = 1e-12;
  for (int k = 0; k < kExchanges; ++k) {
    const Wrong wrong = hold(inertia, momentum, lines, v);
    if (wrong.line == nullptr || wrong.by < kRight) return true;
    wrong.line->impulse = wrong.impulse;
  }
  return false;
}

Eigen::Vector3d velocity_after_joint_friction(const Eigen::Matrix3d& inertia,
                                              const Eigen::Vector3d& momentum,
                                              const DryFriction& friction,
                                              const Eigen::Vector3d& v_before) noexcept {
  constexpr int kRounds = 1000;
  const Eigen::Matrix3d inverse = inertia.inverse();
  Lines lines;
  Eigen::Vector3d v = inverse * momentum;
  for (int i = 0; i < 3; ++i) {
    lines[static_cast<std::size_t>(i)] = {.along = Eigen::Vector3d::Unit(i), .bound = friction.tip};
    lines[static_cast<std::size_t>(i + 3)] = {.along = friction.G.row(i).transpose(),
                                              .bound = friction.joints[i]};
  }
  for (Line& line : lines) {
    if (!(line.bound > 0)) continue;
    line.yields = inverse * line.along;
    const double before = line.along.dot(v_before);
    line.impulse = before > 0 ? line.bound : before < 0 ? -line.bound : 0;
    v -= line.impulse * line.yields;
  }
  Eigen::Vector3d exact;
  for (int round = 0; round < kRounds; ++round) {
    if (hold_exactly(inertia, momentum, lines, exact)) return exact;
    relax_lines(lines, v);
  }
  return v;
}

}  // namespace

Eigen::Vector3d velocity_after_friction(const Eigen::Matrix3d& inertia,
                                        const Eigen::Vector3d& momentum,
                                        const DryFriction& friction,
                                        const Eigen::Vector3d& v_before) noexcept {
  if (friction.joints.isZero(0)) {
    return velocity_after_tip_friction(inertia, momentum, friction.tip, v_before);
  }
  return velocity_after_joint_friction(inertia, momentum, friction, v_before);
}

}  // namespace thimble::device_sim
