#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "report/figure_output.h"
#include "thimble/scene/arm_file.h"
#include "twin/twin_motion.h"

namespace thimble::twin {

/// Forces of a recorded motion along one axis of the world, RMS over all its pieces.
struct TwinForceAxis {
  char name = 'x';          ///< x, y or z.
  double motors_rms = 0;    ///< Force of the motors, N.
  double needed_rms = 0;    ///< Force needed by mass, friction and weight of the file, N.
  double other_rms = 0;     ///< Needed less given: a hand's force, or an error of the file, N.
  std::size_t counted = 0;  ///< Number of pieces; without those in which the axis stands still.
};

/// A hand that would give the remaining force: a mass on the tip, and a spring and a damper to a
/// fixed point.
struct TwinHand {
  double mass = 0;       ///< kg
  double stiffness = 0;  ///< N/m
  double damping = 0;    ///< N s/m
  double explained = 0;  ///< Share of the remaining force's square that it explains, 0 to 1.
};

/// One piece of the motion.
struct TwinForceSample {
  double time = 0;                      ///< Time of its middle, in the compared part, s.
  Eigen::Vector3d f_motors_W{0, 0, 0};  ///< N
  Eigen::Vector3d f_other_W{0, 0, 0};   ///< N; not a number on an axis that stands still.
};

/// Forces that must have acted on a recorded tip.
struct TwinForces {
  std::array<TwinForceAxis, 3> axes{};
  double noise = 0;  ///< Effect of the encoders' steps on the remaining force, RMS of an axis, N.
  TwinHand hand;
  /// With other constants of the file only the motors acted; then it was no hand.
  bool constants_explain = false;
  std::vector<TwinForceSample> samples;

  /// Returns whether a further force is significant: at least kSeen times the noise, and kShare of
  /// the motors' force.
  bool other_acted() const;
  /// Returns whether that force is like a hand's.
  bool hand_held() const;

  static constexpr double kSeen = 4;            ///< [chosen, twin_forces_test]
  static constexpr double kShare = 0.05;        ///< [chosen]
  static constexpr double kHandExplains = 0.7;  ///< Share of its square [chosen].
};

/// Computes the forces of a recorded motion. The further force is the one that the arm of a file
/// needs, m p'' + b p' + c sgn(p') - w, less that of its motors. With elastic cables, the tip
/// motion is corrected for the stretch that motors and cables of the file cause. Dry friction of
/// motors, backlash, cogging and lag are neglected. Both are integrated against smooth bumps of 60
/// ms ((1 - s^2)^3, or ^5 with cables), so that positions need no differentiation: shorter effects
/// are smoothed. No constant is fitted. Real-time: never from the servo thread.
TwinForces twin_forces(const TwinMotion& motion, const scene::ArmFile& file);

/// Returns the forces as figures.
std::vector<session::Figure> force_figures(const TwinForces& forces);

/// Returns the forces as a table and a sentence that reports whether a further force acted, and its
/// nature.
std::string force_table(const TwinForces& forces);

}  // namespace thimble::twin
