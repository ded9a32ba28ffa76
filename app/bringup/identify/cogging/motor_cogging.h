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
struct TorqueVariation {
  bool seen = false;  ///< It is significant.
  /// If seen: N m at the joint with the arm file's constants; relative for ripple.
  Estimate amplitude;
  Estimate phase;  ///< Phase at joint angle zero, rad.
  /// Detection limits in the same unit, with up to kFewPeriods per turn, and with any number that
  /// was tried; 0: not searched for.
  double below = 0, below_of_any = 0;
};

/// Periods per turn of motors with an iron core and few poles [M Zhu and Howe 2000].
inline constexpr double kFewPeriods = 24;

/// Cogging and ripple of an arm's motors. The motors are alike: they have the same number of
/// periods per turn.
struct MotorCogging {
  bool searched = false;  ///< A search was made.
  /// Reason for no search, to follow "Cogging and ripple of the motors: "; empty after a search.
  std::string not_done = "not searched.";
  /// Range of periods per turn that was searched; equal if the arm file names the number.
  double min_periods = 0, max_periods = 0;
  double periods = 0;  ///< Number of periods found.
  /// Other numbers that explain the motion equally well, so that the number is unknown.
  std::vector<double> rivals;
  std::array<TorqueVariation, 3> cogging, ripple;
  double left = 1;                 ///< Remaining share of the squared residual.
  Eigen::Vector3d ratio{1, 1, 1};  ///< Motor turns per joint turn.
  double delay = 0;                ///< Delay of torques, s.

  /// Returns whether cogging or ripple of some motor was seen.
  bool seen() const;
  /// Returns whether some were seen and their number of periods is known.
  bool is_reported() const { return seen() && rivals.empty(); }
};

/// Returns the cogging of a motor, N m at the motor; empty if it has none or its periods are
/// unknown. `gain`: ratio of its true torque to that of the arm file. Real-time: never from the
/// servo thread.
Estimate cogging_at_motor(const MotorCogging& waves, std::size_t motor, const Estimate& gain);

/// Returns a motion with the true torques of motors with such waves, in the arm file's constants.
/// Real-time: never from the servo thread.
ArmMotion without_cogging(const ArmMotion& motion, const MotorCogging& waves);

/// Searches for cogging and ripple in the residual of a rigid arm's fit. `held`: the fit with a
/// spring, so that a spring is not taken for a wave. `ratio`: motor turns per joint turn. `named`:
/// periods per turn in the arm file; 0: none, and plausible numbers are tried. Fails like
/// `fit_motion`. Real-time: never from the servo thread.
driver::Result<MotorCogging> find_cogging(const ArmMotion& motion, const MassNormalisedFit& held,
                                          const Eigen::Vector3d& ratio, double named);

}  // namespace thimble::bringup
