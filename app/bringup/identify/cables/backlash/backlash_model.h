#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>

#include "bringup/identify/arm_motion.h"

namespace thimble::bringup {

/// Constants of motors, cables with backlash, and links, per moved mass:
///
///     J_i q_i'' = g_i tau_i(t - delay) - pull_i - b_i q_i' - c_i sgn(q_i'),
///     p'' = G^T pull - b p' - c sgn(p') + w - s (p - p_0),
///     pull_i = k_i (x_i - clamp(x_i, +-play_i / 2)) + d_i x_i' outside of the backlash, else 0,
///
/// where x_i = q_i - l_i is the lead of motor i over its link, and dry friction can hold. This is
/// the two-mass joint of the simulated arm (device_sim DriveTrain), joint by joint.
struct BacklashTheta {
  enum Index {
    kGain = 0,
    kDelay = 3,
    kViscous = 4,
    kCoulomb = 5,
    kWeight = 6,
    kSpring = 9,
    kInertia = 10,
    kStiffness = 13,
    kDamping = 16,
    kBacklash = 19,
    kRotorViscous = 22,  // of the motor's side
    kRotorCoulomb = 25,
    kCount = 28
  };
  using Vector = Eigen::Matrix<double, kCount, 1>;
};

/// State of motors (rad, rad/s at the joints) and tip (base, m, m/s).
struct BacklashState {
  static constexpr int kCount = 12;
  using Vector = Eigen::Matrix<double, kCount, 1>;
  Vector x = Vector::Zero();
  auto q() { return x.segment<3>(0); }
  auto rate() { return x.segment<3>(3); }
  auto p() { return x.segment<3>(6); }
  auto v() { return x.segment<3>(9); }
};

/// One of several models that move together.
struct BacklashRun {
  const BacklashTheta::Vector* theta = nullptr;
  BacklashState* state = nullptr;  ///< Initial state; afterwards the final state.
  double* angles =
      nullptr;  ///< Receives the motors' angles at each tick (3 x count, rad), or null.
};

/// Number of models that move in the time of one.
inline constexpr std::size_t kBacklashRunsAtOnce = 4;

/// Moves up to kBacklashRunsAtOnce models, at tick `first`, over `count` ticks of a motion, under
/// the torques sent. Writes the motors' angles at each tick, including `first`. The links' angles
/// are those of the tip, linearised about the tip that the encoders saw in that tick: correct to
/// the square of backlash and stretch. Precondition: `first` is later than the delay. Real-time:
/// never from the servo thread.
void move_backlash_models(const ArmMotion& motion, const Eigen::Vector3d& p_middle,
                          std::span<const BacklashRun> runs, std::size_t first, std::size_t count);

}  // namespace thimble::bringup
