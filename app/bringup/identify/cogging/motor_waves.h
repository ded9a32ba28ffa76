#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "bringup/estimate.h"
#include "bringup/identify/arm_motion.h"
#include "bringup/identify/motion_fit.h"
#include "thimble/driver/result.h"

namespace thimble::bringup {

/// Cogging or ripple of one motor, a sine over its angle (device_sim::DriveTrainSettings).
struct MotorWave {
  bool seen = false;  ///< The data show it.
  /// Where it was seen: N m at the joint by the arm file's constants; of ripple relative.
  Estimate amplitude;
  Estimate phase;  ///< Where the joint's angle is zero, rad.
  /// What would have been seen, in the same unit, with up to kFewPeriods in a turn, and with any
  /// number that was tried; 0: nothing was looked for.
  double below = 0, below_of_any = 0;
};

/// Periods in a turn of motors with an iron core and few poles [M Zhu and Howe 2000].
inline constexpr double kFewPeriods = 24;

/// Cogging and ripple of an arm's motors, which are alike: they have one number of periods in a
/// turn.
struct MotorWaves {
  bool searched = false;  ///< They were looked for.
  /// Why not, behind "Cogging and ripple of the motors: "; empty if they were.
  std::string not_done = "not looked for.";
  /// Numbers of periods in a turn that were looked for; one alone is named by the arm file.
  double least = 0, most = 0;
  double periods = 0;  ///< Of those that were seen.
  /// Other numbers that explain the motion as well, so that the number is not known.
  std::vector<double> rivals;
  std::array<MotorWave, 3> cogging, ripple;
  double left = 1;                 ///< Share of the residual's square that is left with them.
  Eigen::Vector3d ratio{1, 1, 1};  ///< Turns of a motor in a turn of its joint.
  double delay = 0;                ///< With which torques come, s.

  /// Returns whether some motor was seen to have some.
  bool seen() const;
  /// Returns whether some were seen and their number of periods is known.
  bool told() const { return seen() && rivals.empty(); }
};

/// Returns the cogging of a motor, N m at the motor, whose true torque is `gain` times that of the
/// arm file; of one that has none, or whose periods are not known, nothing. Real-time: never from
/// the servo thread.
Estimate cogging_at_motor(const MotorWaves& waves, std::size_t motor, const Estimate& gain);

/// Returns a motion with the torques that motors with such waves really gave, by the arm file's
/// constants. Real-time: never from the servo thread.
ArmMotion freed_of_waves(const ArmMotion& motion, const MotorWaves& waves);

/// Looks for cogging and ripple in what a rigid arm's fits leave of a motion. `held`: the fit with
/// a spring to be found, so that none is taken for a wave; `ratio`: turns of a motor in a turn of
/// its joint; `named`: periods in a turn by the arm file, 0: it names none, and plausible numbers
/// are tried. Fails as `fit_motion` does. Real-time: never from the servo thread.
driver::Result<MotorWaves> find_waves(const ArmMotion& motion, const PerMass& held,
                                      const Eigen::Vector3d& ratio, double named);

}  // namespace thimble::bringup
