#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "report/figure_output.h"
#include "thimble/scene/arm_file.h"
#include "twin/twin_motion.h"

namespace thimble::twin {

/// What forces a recorded motion asks for along one axis of the world, RMS over all pieces of it.
struct TwinForceAxis {
  char name = 'x';          ///< x, y or z.
  double motors_rms = 0;    ///< What the motors gave, N.
  double needed_rms = 0;    ///< What mass, friction and weight of the file need for it, N.
  double other_rms = 0;     ///< Needed less given: a hand's, or an error of the file, N.
  std::size_t counted = 0;  ///< Pieces; one in which the axis stands is left out.
};

/// A hand that would give what the motors did not: a mass on the tip, and a spring and a damper to
/// a place that stays.
struct TwinHand {
  double mass = 0;       ///< kg
  double stiffness = 0;  ///< N/m
  double damping = 0;    ///< N s/m
  double explained = 0;  ///< Share of the other force's square that it is, 0 to 1.
};

/// One piece of the motion.
struct TwinForceSample {
  double time = 0;                      ///< Of its middle, in what was compared, s.
  Eigen::Vector3d f_motors_W{0, 0, 0};  ///< N
  Eigen::Vector3d f_other_W{0, 0, 0};   ///< N; not a number on an axis that stands.
};

/// Which forces must have acted on a recorded tip.
struct TwinForces {
  std::array<TwinForceAxis, 3> axes{};
  double noise = 0;  ///< What the encoders' steps make of the other force, RMS of an axis, N.
  TwinHand hand;
  /// With other constants of the file nothing but the motors acted: then it was no hand.
  bool constants_explain = false;
  std::vector<TwinForceSample> samples;

  /// Returns whether more acted than motors and encoders' steps say: at least kSeen times the
  /// noise, and kShare of what the motors gave.
  bool other_acted() const;
  /// Returns whether that is like a hand.
  bool hand_held() const;

  static constexpr double kSeen = 4;            ///< [chosen, twin_forces_test]
  static constexpr double kShare = 0.05;        ///< [chosen]
  static constexpr double kHandExplains = 0.7;  ///< Of its square [chosen].
};

/// Finds the forces of a recorded motion: what the arm of a file needs for it, m p'' + b p' + c
/// sgn(p') - w, less what its motors gave; where cables stretch, the tip moves otherwise than its
/// encoders say, as far as motors and cables of the file make it. Dry friction of motors, play,
/// cogging and lag are left out. Both are integrated against smooth bumps of 60 ms
/// ((1 - s^2)^3, or ^5 with cables), so that positions need no differentiation: what acts for a
/// shorter time is smoothed. No constant is fitted. Real-time: never from the servo thread.
TwinForces twin_forces(const TwinMotion& motion, const scene::ArmFile& file);

/// Returns them as figures.
std::vector<session::Figure> force_figures(const TwinForces& forces);

/// Returns them as a table and a sentence that says whether something else acted, and what.
std::string force_table(const TwinForces& forces);

}  // namespace thimble::twin
