#pragma once

#include <vector>

#include "bringup/identify/cogging/wave_rows.h"

namespace thimble::bringup {

/// Numbers of periods in a turn that motors may have. Cogging has the least common multiple of
/// slots and poles [M Zhu and Howe 2000], from 6 (3 slots, 2 poles) to 264 (24 and 22, of flat
/// motors); the ripple of a commutator twice its segments, of three blocks six for each pair of
/// poles [M Hanselman 2006], which lie between.
inline constexpr double kWavePeriodsLeast = 6, kWavePeriodsMost = 264;
/// Periods that a motor must have turned through for its waves to be told from weight and springs
/// [chosen: of a whole sine a straight line leaves 40 % of the square].
inline constexpr double kPeriodsTurned = 1;
/// The same once another motor has told how many periods they have [chosen: of three quarters of a
/// sine a straight line leaves 10 % of the square].
inline constexpr double kPeriodsTurnedOnceKnown = 0.75;

/// The number of periods in a turn that explains most of what a fit leaves.
struct WavePeriods {
  double least = 0, most = 0;  ///< Numbers that were tried; 0: no motor turned far enough.
  double best = 0;
  std::vector<double> rivals;  ///< Numbers that the data do not tell it from.
};

/// Tries all plausible numbers of periods, or only the one that is `named` (0: none is). Real-time:
/// never from the servo thread.
WavePeriods find_periods(const FittedMotion& motion, const WaveRows& rows, double named);

}  // namespace thimble::bringup
