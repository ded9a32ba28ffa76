#pragma once

#include <cstdint>

#include "stability/wall_bench.h"
#include "thimble/driver/result.h"

namespace thimble::studies {

// What is measured of a wall. All are pure functions of their arguments and fail as
// run_wall does.
// Real-time: never from the servo thread.

/// Measures how fast a small oscillation about the middle of a two-sided spring grows, 1/s; below 0
/// it dies. For a wall whose arm is linear: no dry friction, ideal encoders.
driver::Result<double> growth_rate(const scene::ArmFile& arm, stability::WallCase wall);

/// Finds by bisection the largest stiffness whose oscillations do not grow, N/m, to 0.3 % between
/// `least` and `most`; 0 if even the least grows, `most` if nothing does.
driver::Result<double> linear_edge(const scene::ArmFile& arm, stability::WallCase wall,
                                   double least, double most);

/// Measures how far the tip still oscillates at the end of a run, from peak to peak in the last
/// quarter of the time, m; `give_up` of the case if it went too far.
driver::Result<double> last_oscillation(const scene::ArmFile& arm, const stability::WallCase& wall);

/// Lets a hand move the tip at 0.1 m/s against a one-sided wall and hold it there: the last
/// oscillation, m. Sets how the case begins and how long it lasts.
driver::Result<double> pressed_oscillation(const scene::ArmFile& arm, stability::WallCase wall);

/// Lets go of the tip beside the middle of a two-sided spring, so that it oscillates at `speed`
/// (m/s) at first: the last oscillation after `duration` (s), m.
driver::Result<double> released_oscillation(const scene::ArmFile& arm, stability::WallCase wall,
                                            double speed, double duration);

/// Finds by bisection the largest stiffness at which `pressed_oscillation` or
/// `released_oscillation` stays below `quiet` (m), N/m, to 0.5 %; 0 if even the least does not.
driver::Result<double> pressed_edge(const scene::ArmFile& arm, stability::WallCase wall,
                                    double quiet, double least, double most);
driver::Result<double> released_edge(const scene::ArmFile& arm, stability::WallCase wall,
                                     double speed, double duration, double quiet, double least,
                                     double most);

/// How fast a tip leaves a wall against how fast it came, over several sampling phases.
struct Restitution {
  double mean = 0;
  double least = 0, most = 0;
};

/// Throws the free tip against a one-sided wall at 0.1 m/s in `phases` sampling phases.
driver::Result<Restitution> throw_at_wall(const scene::ArmFile& arm, stability::WallCase wall,
                                          int phases);

/// Makes times between ticks with the mean of `period_ns` or above, in an order drawn by `seed`:
/// a share of all ticks that come `late_periods` late, or times spread evenly by +-`spread` of the
/// period. Both are cut to `grain_ns`, which must divide the period.
std::vector<std::int64_t> late_ticks(std::int64_t period_ns, double share, int late_periods,
                                     std::uint64_t seed);
std::vector<std::int64_t> spread_ticks(std::int64_t period_ns, double spread, std::int64_t grain_ns,
                                       std::uint64_t seed);

}  // namespace thimble::studies
