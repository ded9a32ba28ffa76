#include "studies/accuracy/impact.h"

#include <cmath>
#include <vector>

#include "studies/accuracy/held_motion.h"

namespace thimble::studies {
namespace {

constexpr int kPhases = 200;
constexpr int kTicksMax = 100000;

LineMotion moved(const LineMotion& at, const Impact& impact, double force, double time) {
  return moved_by_held_force(at, impact.mass, impact.viscous, force, time);
}

double one_restitution(const Impact& impact, int run) {
  const double first = impact.period_of ? impact.period_of(run, 0) : impact.period;
  // The moment of contact is distributed over the first period.
  LineMotion now{-impact.speed * first * (run + 0.5) / kPhases, impact.speed};
  double seen_before = now.x;
  double period = first;
  double held = 0;             // N, present motor force
  std::vector<double> on_way;  // forces in transit, with their arrival times
  std::vector<double> arrives;
  double time = 0;
  bool was_in = false;
  for (int k = 0; k < kTicksMax; ++k) {
    const double seen = now.x;
    double force = 0;
    if (seen > 0) {
      was_in = true;
      force = -impact.stiffness * seen - impact.damping * (seen - seen_before) / period;
    } else if (was_in && now.v < 0 && held == 0 && arrives.empty()) {
      return -now.v / impact.speed;
    }
    seen_before = seen;
    on_way.push_back(force);
    arrives.push_back(time + impact.delay);
    if (k > 0) period = impact.period_of ? impact.period_of(run, k) : impact.period;
    const double end = time + period;
    // Forces arrive in the order in which they were sent.
    while (!arrives.empty() && arrives.front() < end - 1e-12) {
      const double wait = std::max(arrives.front() - time, 0.0);
      now = moved(now, impact, held, wait);
      time += wait;
      held = on_way.front();
      arrives.erase(arrives.begin());
      on_way.erase(on_way.begin());
    }
    now = moved(now, impact, held, end - time);
    time = end;
    if (!(std::abs(now.v) < 1e6)) return INFINITY;
    // Zero forces are removed at once.
    bool silent = held == 0;
    for (const double f : on_way) silent = silent && f == 0;
    if (silent && now.x < 0) {
      on_way.clear();
      arrives.clear();
    }
  }
  return NAN;
}

}  // namespace

double mean_restitution(const Impact& impact) {
  double sum = 0;
  for (int run = 0; run < kPhases; ++run) sum += one_restitution(impact, run);
  return sum / kPhases;
}

}  // namespace thimble::studies
