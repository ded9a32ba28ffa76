#include "bringup/identify/cables/backlash/backlash_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "compact_mesh/wide_lanes.h"

// SIMD vectors are only passed to functions that are inlined.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wpsabi"
#endif
#define THIMBLE_BACKLASH_INLINE [[gnu::always_inline]] inline

namespace thimble::bringup {
namespace {

using Theta = BacklashTheta;

// Sub-steps of a tick of 1 ms: a resonance at 300 Hz is then 0.15 % too high, (w h)^2 / 24 [C
// drive_train_plant.h].
constexpr int kSubSteps = 10;

/// A number for each model.
using Lanes [[gnu::vector_size(8 * kBacklashRunsAtOnce)]] = double;
using Mask [[gnu::vector_size(8 * kBacklashRunsAtOnce)]] = std::int64_t;
using Lanes3 = std::array<Lanes, 3>;

THIMBLE_BACKLASH_INLINE bool any(const Mask& mask) {
  return ((mask[0] | mask[1]) | (mask[2] | mask[3])) != 0;
}
THIMBLE_BACKLASH_INLINE Lanes size_of(const Lanes& x) {
  return x < 0.0 ? -x : x;
}
/// Returns c with the sign of x; c is not negative.
THIMBLE_BACKLASH_INLINE Lanes with_sign(const Lanes& c, const Lanes& x) {
  return x < 0.0 ? -c : c;
}

/// Returns by how much x exceeds the backlash, which is free on both sides.
THIMBLE_BACKLASH_INLINE Lanes stretch(const Lanes& x, const Lanes& free) {
  return x - (x < -free ? -free : x > free ? free : x);
}

/// Returns the mean torque of cables over a sub-step in which the motor moves ahead by `way` about
/// `ahead` (rad). So constants and states change it smoothly, wherever in the sub-step the backlash
/// ends.
THIMBLE_BACKLASH_INLINE Lanes mean_pull(const Lanes& ahead, const Lanes& way, const Lanes& free,
                                        const Lanes& stiffness, const Lanes& damping) {
  const Lanes before = stretch(ahead - 0.5 * way, free), after = stretch(ahead + 0.5 * way, free);
  const Lanes there = stretch(ahead, free);
  const Mask slack = (there == 0.0) & (free > 0.0);
  const Lanes whole = slack ? Lanes{} : stiffness * there + damping;
  const Mask on_one_side = (before * after > 0.0) | (size_of(way) < 1e-12);
  if (!any(~on_one_side)) return whole;
  const Lanes part =
      (0.5 * stiffness * (after * after - before * before) + damping * (after - before)) / way;
  return on_one_side ? whole : part;
}

/// Moves one axis with dry friction `c` for h (s) under the acceleration a of all other forces.
THIMBLE_BACKLASH_INLINE void slide_axis(Lanes& x, Lanes& v, const Lanes& a, const Lanes& c,
                                        double h) {
  const Lanes push = a - with_sign(c, a);
  const Mask held = size_of(a) <= c;
  const Lanes sliding = a - with_sign(c, v);
  const Lanes after = v + h * sliding;
  const Mask slides = after * v > 0.0;
  Lanes to = x + h * (v + 0.5 * h * sliding), speed = after;
  if (any(~slides)) {
    const Mask rests = v == 0.0;
    // The others come to rest within the step, and continue from there.
    const Lanes until = rests ? Lanes{} : -v / sliding;
    const Lanes rest_at = x + 0.5 * v * until, left = h - until;
    const Lanes gone = held ? Lanes{} : left;
    const Lanes on = rest_at + 0.5 * gone * gone * push;
    to = slides ? to : on;
    speed = slides ? speed : gone * push;
  }
  x = to;
  v = speed;
}

/// Constants of all models, separate for each.
struct Constants {
  Lanes3 gain, weight, yields, rotor_viscous, rotor_coulomb, stiffness, damping, free;
  Lanes viscous, coulomb, spring;
  std::array<std::ptrdiff_t, kBacklashRunsAtOnce> ticks_late;
  Lanes change;  // time in a tick until which the previous torque acts, in sub-steps
  bool rubs = false;
};

Constants constants_of(std::span<const BacklashRun> runs, double dt) {
  Constants all{};
  for (std::size_t lane = 0; lane < kBacklashRunsAtOnce; ++lane) {
    const Theta::Vector& theta = *runs[lane < runs.size() ? lane : 0].theta;
    for (int k = 0; k < 3; ++k) {
      const auto i = static_cast<std::size_t>(k);
      all.gain[i][lane] = theta[Theta::kGain + k];
      all.weight[i][lane] = theta[Theta::kWeight + k];
      const double yields = 1 / theta[Theta::kInertia + k];
      all.yields[i][lane] = yields;
      all.rotor_viscous[i][lane] = yields * theta[Theta::kRotorViscous + k];
      all.rotor_coulomb[i][lane] = yields * theta[Theta::kRotorCoulomb + k];
      all.stiffness[i][lane] = theta[Theta::kStiffness + k];
      all.damping[i][lane] = theta[Theta::kDamping + k];
      all.free[i][lane] = 0.5 * theta[Theta::kBacklash + k];
    }
    all.rubs = all.rubs || !theta.tail<6>().isZero(0);
    all.viscous[lane] = theta[Theta::kViscous];
    all.coulomb[lane] = std::max(0.0, theta[Theta::kCoulomb]);
    all.spring[lane] = theta[Theta::kSpring];
    const double late = theta[Theta::kDelay] / dt;
    all.ticks_late[lane] = static_cast<std::ptrdiff_t>(std::floor(late));
    all.change[lane] = (late - std::floor(late)) * kSubSteps;
  }
  return all;
}

THIMBLE_BACKLASH_INLINE void turn(const Eigen::Matrix3d& G, const Lanes3& v, Lanes3& out) {
  for (int k = 0; k < 3; ++k) {
    out[static_cast<std::size_t>(k)] = G(k, 0) * v[0] + G(k, 1) * v[1] + G(k, 2) * v[2];
  }
}

THIMBLE_BACKLASH_INLINE void move_lanes(const ArmMotion& motion, const Eigen::Vector3d& p_middle,
                                        std::span<const BacklashRun> runs, std::size_t first,
                                        std::size_t count) {
  const double dt = motion.dt, h = dt / kSubSteps;
  const Constants c = constants_of(runs, dt);
  std::array<Lanes3, 4> now{};  // q, rate, p, v
  for (std::size_t lane = 0; lane < kBacklashRunsAtOnce; ++lane) {
    const BacklashState& state = *runs[lane < runs.size() ? lane : 0].state;
    for (std::size_t k = 0; k < 12; ++k) {
      now[k / 3][k % 3][lane] = state.x[static_cast<Eigen::Index>(k)];
    }
  }
  auto& [q, rate, p, v] = now;
  Lanes3 slip_before{}, turned{};
  turn(motion.samples[first].G, v, turned);
  for (std::size_t k = 0; k < 3; ++k) slip_before[k] = rate[k] - turned[k];
  for (std::size_t i = 0; i < count; ++i) {
    const MotionSample& seen = motion.samples[first + i];
    for (std::size_t lane = 0; lane < runs.size(); ++lane) {
      if (runs[lane].angles == nullptr) continue;
      for (std::size_t k = 0; k < 3; ++k) runs[lane].angles[3 * i + k] = q[k][lane];
    }
    Lanes3 newer{}, older{};
    for (std::size_t lane = 0; lane < kBacklashRunsAtOnce; ++lane) {
      const auto at = static_cast<std::ptrdiff_t>(first + i) - c.ticks_late[lane];
      const auto& late = motion.samples[static_cast<std::size_t>(std::max<std::ptrdiff_t>(at, 0))];
      const auto& later =
          motion.samples[static_cast<std::size_t>(std::max<std::ptrdiff_t>(at - 1, 0))];
      for (std::size_t k = 0; k < 3; ++k) {
        newer[k][lane] = c.gain[k][lane] * late.tau[static_cast<Eigen::Index>(k)];
        older[k][lane] = c.gain[k][lane] * later.tau[static_cast<Eigen::Index>(k)];
      }
    }
    const Eigen::Matrix3d& G = seen.G;
    const Eigen::Matrix3d G_T = G.transpose();
    for (int sub = 0; sub < kSubSteps; ++sub) {
      const Lanes left_over = c.change - sub;
      const Lanes share = left_over < 0.0 ? Lanes{} : left_over > 1.0 ? Lanes{} + 1.0 : left_over;
      Lanes3 half{}, from_seen{}, of_link{}, pull{};
      for (std::size_t k = 0; k < 3; ++k) {
        half[k] = p[k] + 0.5 * h * v[k];
        from_seen[k] = half[k] - seen.p_BT[static_cast<Eigen::Index>(k)];
      }
      turn(G, from_seen, of_link);
      turn(G, v, turned);
      for (std::size_t k = 0; k < 3; ++k) {
        const Lanes tau = share * older[k] + (1.0 - share) * newer[k];
        const Lanes ahead =
            q[k] + 0.5 * h * rate[k] - seen.q[static_cast<Eigen::Index>(k)] - of_link[k];
        const Lanes slip = rate[k] - turned[k];
        const Lanes slip_half = 1.5 * slip - 0.5 * slip_before[k];
        slip_before[k] = slip;
        pull[k] = mean_pull(ahead, h * slip, c.free[k], c.stiffness[k], c.damping[k] * slip_half);
        const Lanes a = (tau - pull[k]) * c.yields[k];
        if (c.rubs) {
          slide_axis(q[k], rate[k], a - c.rotor_viscous[k] * rate[k], c.rotor_coulomb[k], h);
          continue;
        }
        q[k] += h * (rate[k] + 0.5 * h * a);
        rate[k] += h * a;
      }
      turn(G_T, pull, turned);
      for (std::size_t k = 0; k < 3; ++k) {
        const Lanes a = turned[k] + c.weight[k] -
                        c.spring * (half[k] - p_middle[static_cast<Eigen::Index>(k)]) -
                        c.viscous * v[k];
        slide_axis(p[k], v[k], a, c.coulomb, h);
      }
    }
  }
  for (std::size_t lane = 0; lane < runs.size(); ++lane) {
    for (std::size_t k = 0; k < 12; ++k) {
      runs[lane].state->x[static_cast<Eigen::Index>(k)] = now[k / 3][k % 3][lane];
    }
  }
}

/// The same with AVX2 instructions; the results are bit-identical.
THIMBLE_FOR_AVX2 void move_wide(const ArmMotion& motion, const Eigen::Vector3d& p_middle,
                                std::span<const BacklashRun> runs, std::size_t first,
                                std::size_t count) {
  move_lanes(motion, p_middle, runs, first, count);
}

}  // namespace

void move_backlash_models(const ArmMotion& motion, const Eigen::Vector3d& p_middle,
                          std::span<const BacklashRun> runs, std::size_t first, std::size_t count) {
  if (render::wide_lanes()) {
    move_wide(motion, p_middle, runs, first, count);
  } else {
    move_lanes(motion, p_middle, runs, first, count);
  }
}

}  // namespace thimble::bringup
