#include "studies/stability/wall_measures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "stability/draw.h"

namespace thimble::studies {
namespace {

constexpr double kTouchSpeed = 0.1;  // m/s: a light tap [PHYSICS 1.5 and 1.6]
constexpr double kStartMax = 0.008;  // m, of a small oscillation: far from the joints' limits
constexpr double kFarthest = 0.05;   // m from the middle: a small oscillation that reaches it grows
constexpr double kCeiling = 25;      // times its initial energy
constexpr double kFloor = 1e-3;      // of its energy: a smaller oscillation is no longer detected
constexpr double kStartForce = 0.3;  // N, of a small oscillation: far above a step of the current
constexpr double kOscillations = 20;  // minimum number, for a result independent of the phase

/// Returns the value at which a measurement is no longer good, in equal steps of the logarithm.
template <class Good>
driver::Result<double> bisect(double min, double max, double share, const Good& good) {
  for (const double end : {min, max}) {
    const driver::Result<bool> there = good(end);
    if (!there) return there.error();
    if (end == min && !*there) return 0.0;
    if (end == max && *there) return max;
  }
  while (max / min > 1 + share) {
    const double middle = std::sqrt(min * max);
    const driver::Result<bool> there = good(middle);
    if (!there) return there.error();
    (*there ? min : max) = middle;
  }
  return std::sqrt(min * max);
}

/// Returns whether an oscillation stays below `quiet` (m), or why it was not measured.
driver::Result<bool> is_quiet(const driver::Result<double>& oscillation, double quiet) {
  if (!oscillation) return oscillation.error();
  return *oscillation < quiet;
}

/// Returns the energy of an oscillation at each tick, J.
std::vector<double> oscillation_energies(const stability::WallRun& run,
                                         const stability::WallCase& wall) {
  const double mass = wall.tip.mass + wall.hand.mass;
  const double spring = wall.stiffness + wall.hand.stiffness;
  std::vector<double> energies;
  for (std::size_t i = 0; i < run.x.size(); ++i) {
    energies.push_back(0.5 * (mass * run.v[i] * run.v[i] + spring * run.x[i] * run.x[i]));
  }
  return energies;
}

template <class Times>
void shuffle(Times& times, std::uint64_t seed) {
  stability::Draw draw(seed);
  for (std::size_t i = times.size(); i > 1; --i) std::swap(times[i - 1], times[draw.one_of(i)]);
}

}  // namespace

driver::Result<double> growth_rate(const scene::ArmFile& arm, stability::WallCase wall) {
  const double start = std::min(kStartMax, kStartForce / wall.stiffness);
  const double mass = wall.tip.mass + wall.hand.mass;
  const double frequency = std::sqrt((wall.stiffness + wall.hand.stiffness) / mass);
  wall.kick = start * frequency;
  wall.give_up = kFarthest;
  wall.duration = std::max(wall.duration, kOscillations * 2 * std::numbers::pi / frequency);
  const auto ran = stability::run_wall(arm, wall);
  if (!ran) return ran.error();
  const stability::WallRun& run = *ran;
  if (run.gave_up) return std::log(kFarthest / start) / std::max(run.time.back(), 1e-3);
  const std::vector<double> energies = oscillation_energies(run, wall);
  const std::size_t count = energies.size();
  const auto max = [&](double from, double to) {
    const auto at = [&](double share) {
      return energies.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(count));
    };
    return *std::max_element(at(from), std::max(at(from) + 1, at(to)));
  };
  // If the oscillation soon grows far, or decays to the steps of the motors' current, its time is
  // measured. Otherwise an early and a late interval are compared, both long enough to contain the
  // oscillation's full energy.
  const double first = 0.5 * mass * wall.kick * wall.kick;
  const double late = max(0.85, 1);
  // If the spring's force is below a step of the motors' current, the tip may rest next to the
  // middle, which is no oscillation.
  const double asleep =
      0.5 * wall.direction.force_step * wall.direction.force_step / wall.stiffness;
  const double floor = std::max(kFloor * first, asleep);
  std::size_t last_alive = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (energies[i] > kCeiling * first) return 0.5 * std::log(kCeiling) / run.time[i];
    if (energies[i] > floor) last_alive = i;
  }
  if (late < floor) {
    return 0.5 * std::log(std::min(floor / first, 0.5)) / std::max(run.time[last_alive], 1e-3);
  }
  return 0.5 * std::log(late / max(0.1, 0.25)) / (0.75 * run.time.back());
}

driver::Result<double> linear_edge(const scene::ArmFile& arm, stability::WallCase wall, double min,
                                   double max) {
  return bisect(min, max, 0.003, [&](double stiffness) {
    wall.stiffness = stiffness;
    const auto rate = growth_rate(arm, wall);
    if (!rate) return driver::Result<bool>(rate.error());
    return driver::Result<bool>(*rate <= 0);
  });
}

driver::Result<double> last_oscillation(const scene::ArmFile& arm,
                                        const stability::WallCase& wall) {
  const auto ran = stability::run_wall(arm, wall);
  if (!ran) return ran.error();
  const stability::WallRun& run = *ran;
  if (run.gave_up) return wall.give_up;
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (std::size_t i = 0; i < run.x.size(); ++i) {
    if (run.time[i] < 0.75 * wall.duration) continue;
    low = std::min(low, run.x[i]);
    high = std::max(high, run.x[i]);
  }
  return std::min(high - low, wall.give_up);
}

driver::Result<double> pressed_oscillation(const scene::ArmFile& arm, stability::WallCase wall) {
  constexpr double kWay = 0.005;  // m, to each side of the wall
  wall.one_sided = true;
  wall.offset = -kWay;
  wall.hand_from = 0;
  wall.hand_to = -2 * kWay;
  // The soft start ends before the wall is reached.
  wall.hand_start = arm.limits.soft_start + 0.02;
  wall.hand_end = wall.hand_start + 2 * kWay / kTouchSpeed;
  wall.duration = wall.hand_end + 1.4;
  return last_oscillation(arm, wall);
}

driver::Result<double> released_oscillation(const scene::ArmFile& arm, stability::WallCase wall,
                                            double speed, double duration) {
  const double mass = wall.tip.mass + wall.hand.mass;
  wall.one_sided = false;
  const double step = wall.own_step ? wall.direction.step : wall.step;
  // Between two counts the force is never zero: the worst position for rest [PHYSICS 1.4]. The tip
  // and the hand's target are there at the kick.
  wall.offset = wall.hand_from = wall.hand_to = 0.5 * step;
  wall.hand_start = wall.hand_end = 0;
  wall.kick = speed;
  // During its soft start, the arm's gate would block the kick.
  wall.kick_start = wall.own_limits ? arm.limits.soft_start + 0.02 : 0;
  const double reach = speed * std::sqrt(mass / (wall.stiffness + wall.hand.stiffness));
  wall.duration = wall.kick_start + duration;
  wall.give_up = std::min(20 * reach, 0.05);
  return last_oscillation(arm, wall);
}

driver::Result<double> pressed_edge(const scene::ArmFile& arm, stability::WallCase wall,
                                    double quiet, double min, double max) {
  return bisect(min, max, 0.005, [&](double stiffness) {
    wall.stiffness = stiffness;
    return is_quiet(pressed_oscillation(arm, wall), quiet);
  });
}

driver::Result<double> released_edge(const scene::ArmFile& arm, stability::WallCase wall,
                                     double speed, double duration, double quiet, double min,
                                     double max) {
  return bisect(min, max, 0.005, [&](double stiffness) {
    wall.stiffness = stiffness;
    return is_quiet(released_oscillation(arm, wall, speed, duration), quiet);
  });
}

driver::Result<Restitution> throw_at_wall(const scene::ArmFile& arm, stability::WallCase wall,
                                          int phases) {
  constexpr double kRunUp = 0.002;  // m
  const double mass = wall.tip.mass + wall.hand.mass;
  const double period = static_cast<double>(wall.period_ns) * 1e-9;
  const double delay = static_cast<double>(wall.delay_ns) * 1e-9;
  wall.one_sided = true;
  wall.kick = kTouchSpeed;
  // There and back, and half an oscillation in the wall.
  const double oscillation = std::numbers::pi * std::sqrt(mass / wall.stiffness);
  wall.duration = 2.5 * kRunUp / kTouchSpeed + 1.5 * oscillation + 3 * delay + 10 * period;
  const auto late = static_cast<std::size_t>(std::ceil(delay / period));
  Restitution found{0, HUGE_VAL, 0};
  for (int i = 0; i < phases; ++i) {
    wall.offset = -kRunUp - (i + 0.5) / phases * kTouchSpeed * period;
    const auto ran = stability::run_wall(arm, wall);
    if (!ran) return ran.error();
    const stability::WallRun& run = *ran;
    // In: the last tick before the wall. Out: after the last force has ended, `late` ticks after
    // the first that is outside again.
    std::size_t k = 0;
    while (k + 1 < run.x.size() && run.x[k + 1] > wall.offset) ++k;
    const double in = run.v[k];
    while (++k < run.x.size() && !(run.x[k] > wall.offset)) {
    }
    const double out = run.v[std::min(k + late, run.v.size() - 1)];
    const double e = in < 0 ? std::abs(out / in) : 0;
    found.mean += e / phases;
    found.min = std::min(found.min, e);
    found.max = std::max(found.max, e);
  }
  return found;
}

std::vector<std::int64_t> late_ticks(std::int64_t period_ns, double share, int late_periods,
                                     std::uint64_t seed) {
  constexpr std::size_t kCount = 2000;
  std::vector<std::int64_t> gaps(kCount, period_ns);
  const auto late = static_cast<std::size_t>(std::llround(share * kCount));
  std::fill_n(gaps.begin(), late, period_ns * (1 + late_periods));
  shuffle(gaps, seed);
  return gaps;
}

std::vector<std::int64_t> spread_ticks(std::int64_t period_ns, double spread, std::int64_t grain_ns,
                                       std::uint64_t seed) {
  constexpr std::size_t kCount = 2000;
  std::vector<std::int64_t> gaps;
  const std::int64_t whole_grains = period_ns / grain_ns;
  const auto grains = static_cast<double>(whole_grains);
  for (std::size_t i = 0; i < kCount; ++i) {
    const double u = (static_cast<double>(i) + 0.5) / kCount;
    gaps.push_back(grain_ns * std::llround(grains * (1 + spread * (2 * u - 1))));
  }
  shuffle(gaps, seed);
  return gaps;
}

}  // namespace thimble::studies
