#include "stability/drop_trial.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "stability/wall_bench.h"
#include "thimble/scene/arm_simulation.h"

namespace thimble::stability {
namespace {

/// Returns the time at which a run crosses `offset` between two ticks, s.
double crossing(const WallRun& run, std::size_t after, double offset) {
  const double before_x = run.x[after - 1] - offset, after_x = run.x[after] - offset;
  const double share = before_x / (before_x - after_x);
  return run.time[after - 1] + share * (run.time[after] - run.time[after - 1]);
}

/// Returns the first tick from `from` on at which the tip is on the free side if `free`, else
/// inside.
std::size_t first(const WallRun& run, std::size_t from, double offset, bool free) {
  while (from < run.x.size() && (run.x[from] > offset) != free) ++from;
  return from;
}

driver::Result<Bounce> bounce_of(const WallRun& run, double offset, double pull_start) {
  std::size_t begin = 0;
  while (begin < run.x.size() && run.time[begin] < pull_start) ++begin;
  const std::size_t in = first(run, begin, offset, false);
  if (in >= run.x.size() || in == 0) {
    return driver::Error{"The tip does not fall: dry friction balances the pull."};
  }
  const std::size_t out = first(run, in, offset, true);
  const std::size_t back = first(run, out, offset, false);
  if (back >= run.x.size()) {
    return driver::Error{"The tip does not leave the wall, or does not return to it."};
  }
  // A delayed force still acts outside: its energy belongs to the bounce.
  const double after = *std::max_element(run.v.begin() + static_cast<std::ptrdiff_t>(out - 1),
                                         run.v.begin() + static_cast<std::ptrdiff_t>(back));
  const double before = -run.v[in - 1];
  return Bounce{.restitution = after / before,
                .flight = crossing(run, back, offset) - crossing(run, out, offset),
                .speed = before};
}

}  // namespace

driver::Result<Bounce> drop_on_wall(const scene::ArmFile& arm, const DropTrial& trial) {
  auto direction = direction_at_home(arm, trial.n_W);
  if (!direction) return direction.error();
  const auto period_ns = static_cast<std::int64_t>(std::llround(1e9 / trial.rate));
  WallCase wall{.direction = *direction,
                .tip = arm.simulated.plant,
                .hand = {},
                .stiffness = trial.stiffness,
                .damping = trial.damping,
                .one_sided = true,
                .own_step = true,
                .own_limits = true,
                .velocity_corner = arm.velocity_corner_frequency,
                .period_ns = period_ns,
                .own_wire = true,
                .gaps_ns = {},
                .pull = trial.pull,
                .pull_start = arm.limits.soft_start + 0.02};
  const double deepest = 3 * trial.height;
  if (!scene::joint_angles_at(arm, direction->p_WT - deepest * direction->n_W)) {
    return driver::Error{"The wall is outside the arm's workspace."};
  }
  const double mass = moved_mass(arm, direction->n_W);
  Bounce mean;
  for (int i = 0; i < trial.falls; ++i) {
    const double further = (i + 0.5) / trial.falls;
    // The speed at the wall without friction determines how far the tip moves between two ticks
    // there.
    const double speed = std::sqrt(2 * trial.pull * trial.height / mass);
    wall.offset = -(trial.height + further * speed / trial.rate);
    // Three falls and returns with half of the pull, which friction leaves, and half an oscillation
    // in the wall.
    const double fall = std::sqrt(4 * trial.height * mass / trial.pull);
    wall.duration = wall.pull_start + 6 * fall + 4 * std::sqrt(mass / trial.stiffness) + 0.05;
    const auto run = run_wall(arm, wall);
    if (!run) return run.error();
    if (run->fault) return driver::Error{"The arm reported a fault while the tip fell."};
    const auto bounce = bounce_of(*run, wall.offset, wall.pull_start);
    if (!bounce) return bounce.error();
    mean.restitution += bounce->restitution / trial.falls;
    mean.flight += bounce->flight / trial.falls;
    mean.speed += bounce->speed / trial.falls;
  }
  return mean;
}

}  // namespace thimble::stability
