#include "studies/accuracy/stiffest_wall.h"

#include <algorithm>
#include <cmath>
#include <deque>

#include "studies/accuracy/held_motion.h"

namespace thimble::studies {
namespace {

constexpr double kStart = 1e-3;    // m
constexpr double kStiffest = 1e6;  // N/m
constexpr int kHalvings = 40;
constexpr double kNearEnough = 1e-3;

/// A force in transit to the motors.
struct Sent {
  double arrives = 0;  // s
  double force = 0;    // N
};

// Returns whether an oscillation is larger in the last quarter of the time than in the second one.
bool grows(const RestedWall& wall, double stiffness) {
  LineMotion now{kStart, 0};
  const auto estimate = wall.estimate ? wall.estimate() : nullptr;
  std::deque<Sent> sent;
  double held = 0;
  double time = 0;
  double seen_before = now.x;
  double dt = 0;
  double early = 0, late = 0;
  for (int k = 0; time < wall.duration; ++k) {
    const double v = estimate ? estimate->update(now.x) : dt > 0 ? (now.x - seen_before) / dt : 0;
    seen_before = now.x;
    sent.push_back({time + wall.delay, -stiffness * now.x - wall.damping * v});
    dt = wall.period_of ? wall.period_of(k) : wall.period;
    const double end = time + dt;
    while (!sent.empty() && sent.front().arrives < end - 1e-12) {
      const double wait = std::max(sent.front().arrives - time, 0.0);
      now = moved_by_held_force(now, wall.mass, wall.viscous, held, wait);
      time += wait;
      held = sent.front().force;
      sent.pop_front();
    }
    now = moved_by_held_force(now, wall.mass, wall.viscous, held, end - time);
    time = end;
    // NaN counts as growing.
    if (!(std::abs(now.x) < 1e3 * kStart)) return true;
    // Its energy, as a squared amplitude.
    const double size = now.x * now.x + wall.mass / stiffness * now.v * now.v;
    if (time > wall.duration / 4 && time <= wall.duration / 2) early += size * dt;
    if (time > 3 * wall.duration / 4) late += size * dt;
  }
  return !(late <= early);
}

}  // namespace

double stiffest(const RestedWall& wall) {
  double holds = 1;
  double fails = kStiffest;
  if (grows(wall, holds)) return 0;
  for (int i = 0; i < kHalvings && fails > (1 + kNearEnough) * holds; ++i) {
    const double middle = std::sqrt(holds * fails);
    (grows(wall, middle) ? fails : holds) = middle;
  }
  return holds;
}

}  // namespace thimble::studies
