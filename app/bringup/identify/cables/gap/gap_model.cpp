#include "bringup/identify/cables/gap/gap_model.h"

#include <algorithm>
#include <cmath>

namespace thimble::app {
namespace {

// Sub-steps of a tick of 1 ms: a resonance at 300 Hz is 0.15 % too high then, (w h)^2 / 24
// [C drive_train_plant.h].
constexpr int kSubSteps = 10;

/// Returns what a cable pulls with, on the mean over a sub-step in which the motor gets ahead by
/// `way` about `ahead` (rad): so the constants and states change it smoothly, wherever in the
/// sub-step the play ends.
double mean_pull(double ahead, double way, double free, double stiffness, double damping) {
  const auto stretch = [free](double x) { return x - std::clamp(x, -free, free); };
  const double from = ahead - 0.5 * way, to = ahead + 0.5 * way;
  const double before = stretch(from), after = stretch(to);
  if (before * after > 0 || std::abs(way) < 1e-12) {
    const double there = stretch(ahead);
    return there == 0 && free > 0 ? 0 : stiffness * there + damping;
  }
  return (0.5 * stiffness * (after * after - before * before) + damping * (after - before)) / way;
}

/// Moves one axis with dry friction `c` for h (s) under the acceleration a of all else.
void slide_axis(double& x, double& v, double a, double c, double h) {
  if (v == 0) {
    if (std::abs(a) <= c) return;
    a -= std::copysign(c, a);
    x += 0.5 * h * h * a;
    v = h * a;
    return;
  }
  const double sliding = a - std::copysign(c, v);
  const double after = v + h * sliding;
  if (after * v > 0) {
    x += h * (v + 0.5 * h * sliding);
    v = after;
    return;
  }
  // It comes to rest within the step, and goes on from there.
  const double rest = -v / sliding, left = h - rest;
  x += 0.5 * v * rest;
  v = 0;
  if (std::abs(a) <= c) return;
  a -= std::copysign(c, a);
  x += 0.5 * left * left * a;
  v = left * a;
}

}  // namespace

GapState move_gap_model(const ArmMotion& motion, const GapTheta::Vector& theta,
                        const Eigen::Vector3d& p_middle, const GapState& start, std::size_t first,
                        std::size_t count, double* angles) {
  using Gap = GapTheta;
  const double dt = motion.dt, h = dt / kSubSteps;
  GapState now = start;
  Eigen::Vector3d q = now.q(), rate = now.rate(), p = now.p(), v = now.v();
  const Eigen::Vector3d gain = theta.segment<3>(Gap::kGain),
                        weight = theta.segment<3>(Gap::kWeight);
  const Eigen::Vector3d yields = theta.segment<3>(Gap::kInertia).cwiseInverse();
  const double viscous = theta[Gap::kViscous], coulomb = std::max(0.0, theta[Gap::kCoulomb]);
  const double spring = theta[Gap::kSpring];
  const Eigen::Vector3d rotor_viscous = yields.cwiseProduct(theta.segment<3>(Gap::kRotorViscous));
  const Eigen::Vector3d rotor_coulomb = yields.cwiseProduct(theta.segment<3>(Gap::kRotorCoulomb));
  const bool rubs = !rotor_viscous.isZero(0) || !rotor_coulomb.isZero(0);
  const double late = theta[Gap::kDelay] / dt;
  const auto ticks_late = static_cast<std::ptrdiff_t>(std::floor(late));
  // Until when in a tick the torque of the one before stands, in sub-steps.
  const double change = (late - std::floor(late)) * kSubSteps;
  Eigen::Vector3d before = rate - motion.samples[first].G * v;
  for (std::size_t i = 0; i < count; ++i) {
    const MotionSample& seen = motion.samples[first + i];
    if (angles != nullptr) std::copy(q.data(), q.data() + 3, angles + 3 * i);
    const auto at = static_cast<std::ptrdiff_t>(first + i) - ticks_late;
    const Eigen::Vector3d newer = gain.cwiseProduct(
        motion.samples[static_cast<std::size_t>(std::max<std::ptrdiff_t>(at, 0))].tau);
    const Eigen::Vector3d older = gain.cwiseProduct(
        motion.samples[static_cast<std::size_t>(std::max<std::ptrdiff_t>(at - 1, 0))].tau);
    const Eigen::Matrix3d& G = seen.G;
    for (int sub = 0; sub < kSubSteps; ++sub) {
      const double share = std::clamp(change - sub, 0.0, 1.0);
      const Eigen::Vector3d tau = share * older + (1 - share) * newer;
      const Eigen::Vector3d p_half = p + 0.5 * h * v;
      const Eigen::Vector3d ahead = q + 0.5 * h * rate - seen.q - G * (p_half - seen.p_BT);
      const Eigen::Vector3d slip = rate - G * v;
      const Eigen::Vector3d slip_half = 1.5 * slip - 0.5 * before;
      before = slip;
      Eigen::Vector3d pull;
      for (int k = 0; k < 3; ++k) {
        pull[k] = mean_pull(ahead[k], h * slip[k], 0.5 * theta[Gap::kPlay + k],
                            theta[Gap::kStiffness + k], theta[Gap::kDamping + k] * slip_half[k]);
        const double a = (tau[k] - pull[k]) * yields[k];
        if (rubs) {
          slide_axis(q[k], rate[k], a - rotor_viscous[k] * rate[k], rotor_coulomb[k], h);
          continue;
        }
        q[k] += h * (rate[k] + 0.5 * h * a);
        rate[k] += h * a;
      }
      const Eigen::Vector3d a =
          G.transpose() * pull + weight - spring * (p_half - p_middle) - viscous * v;
      for (int k = 0; k < 3; ++k) slide_axis(p[k], v[k], a[k], coulomb, h);
    }
  }
  now.x << q, rate, p, v;
  return now;
}

}  // namespace thimble::app
