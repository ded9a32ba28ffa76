#pragma once

#include <cstdint>

#include "stability/wall_bench.h"
#include "thimble/driver/result.h"

namespace thimble::studies {

// Measurements of a wall. All are pure functions of their arguments and fail like run_wall.
// Real-time: never from the servo thread.

/// Returns the growth rate of a small oscillation about the middle of a two-sided spring, 1/s;
/// below 0 it decays. For a linear arm: no dry friction, ideal encoders.
driver::Result<double> growth_rate(const scene::ArmFile& arm, stability::WallCase wall);

/// Returns by bisection the largest stiffness whose oscillations do not grow, N/m, to 0.3 % between
/// `least` and `most`; 0 if even `least` grows, `most` if none does.
driver::Result<double> linear_edge(const scene::ArmFile& arm, stability::WallCase wall, double min,
                                   double max);

/// Returns the oscillation of the tip at the end of a run, peak to peak in the last quarter of the
/// time, m; `give_up` of the case if the tip went too far.
driver::Result<double> last_oscillation(const scene::ArmFile& arm, const stability::WallCase& wall);

/// Returns the final oscillation of a tip that a hand moves at 0.1 m/s against a one-sided wall and
/// holds there, m. Sets the begin and the duration of the case.
driver::Result<double> pressed_oscillation(const scene::ArmFile& arm, stability::WallCase wall);

/// Returns the final oscillation of a tip released next to the middle of a two-sided spring with
/// initial speed `speed` (m/s), after `duration` (s), m.
driver::Result<double> released_oscillation(const scene::ArmFile& arm, stability::WallCase wall,
                                            double speed, double duration);

/// Returns by bisection the largest stiffness at which `pressed_oscillation` or
/// `released_oscillation` stays below `quiet` (m), N/m, to 0.5 %; 0 if even the smallest does not.
driver::Result<double> pressed_edge(const scene::ArmFile& arm, stability::WallCase wall,
                                    double quiet, double min, double max);
driver::Result<double> released_edge(const scene::ArmFile& arm, stability::WallCase wall,
                                     double speed, double duration, double quiet, double min,
                                     double max);

/// Ratio of a tip's speed after and before the wall, over several sampling phases.
struct Restitution {
  double mean = 0;
  double min = 0, max = 0;
};

/// Throws the free tip against a one-sided wall at 0.1 m/s in `phases` sampling phases.
driver::Result<Restitution> throw_at_wall(const scene::ArmFile& arm, stability::WallCase wall,
                                          int phases);

/// Returns random times between ticks, in an order given by `seed`: a fraction of all ticks is
/// `late_periods` late, or times are uniformly distributed within +-`spread` of the period. Their
/// mean is `period_ns` or more. The latter are rounded to `grain_ns`, which must divide the period.
std::vector<std::int64_t> late_ticks(std::int64_t period_ns, double share, int late_periods,
                                     std::uint64_t seed);
std::vector<std::int64_t> spread_ticks(std::int64_t period_ns, double spread, std::int64_t grain_ns,
                                       std::uint64_t seed);

}  // namespace thimble::studies
