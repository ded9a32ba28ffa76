#pragma once

#include <vector>

#include "bringup/identify/cogging/cogging_rows.h"

namespace thimble::bringup {

/// Possible numbers of periods per turn. Cogging has the least common multiple of slots and poles
/// [M Zhu and Howe 2000], from 6 (3 slots, 2 poles) to 264 (24 and 22, of flat motors). The ripple
/// of a commutator has twice its segments; that of block commutation has six per pair of poles [M
/// Hanselman 2006]. These lie in the same range.
inline constexpr double kCoggingPeriodsMin = 6, kCoggingPeriodsMax = 264;
/// Periods through which a motor must have turned to distinguish its waves from weight and springs
/// [chosen: a straight line leaves 40 % of the square of a whole sine].
inline constexpr double kPeriodsTurned = 1;
/// The same if the number of periods is known from another motor [chosen: a straight line leaves 10
/// % of the square of three quarters of a sine].
inline constexpr double kPeriodsTurnedOnceKnown = 0.75;

/// The number of periods per turn that best explains the residual of a fit.
struct CoggingPeriods {
  double min_periods = 0,
         max_periods = 0;  ///< Range of numbers tried; 0: no motor turned far enough.
  double best = 0;
  std::vector<double> rivals;  ///< Numbers that the data do not distinguish from it.
};

/// Tries all plausible numbers of periods, or only `named` (0: none is named). Real-time: never
/// from the servo thread.
CoggingPeriods find_periods(const FittedMotion& motion, const CoggingRows& rows, double named);

}  // namespace thimble::bringup
