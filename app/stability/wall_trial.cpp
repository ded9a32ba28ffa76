#include "stability/wall_trial.h"

#include <algorithm>
#include <cmath>

#include "stability/raised_edge.h"
#include "stability/wall_bench.h"
#include "thimble/scene/arm_simulation.h"

namespace thimble::stability {
namespace {

constexpr double kAway = 0.003;   // m; the hand waits there before it moves in
constexpr double kBegin = 0.35;   // s; the soft start is over
constexpr double kEnd = 1.55;     // s
constexpr double kWatched = 0.2;  // s, measured part at its end
constexpr double kBefore = 0.4;   // s; time from the earlier measurement

/// Returns the peak-to-peak motion of the tip in a period of time, m.
double oscillation_between(const WallRun& run, double from, double to) {
  double min = 1e9, max = -1e9;
  for (std::size_t i = 0; i < run.x.size(); ++i) {
    if (run.time[i] < from || run.time[i] >= to) continue;
    min = std::min(min, run.x[i]);
    max = std::max(max, run.x[i]);
  }
  return std::max(0.0, max - min);
}

/// Returns the RMS deviation of the force from its mean after a time, N.
double force_rms(const WallRun& run, double from) {
  double sum = 0, squares = 0;
  int seen = 0;
  for (std::size_t i = 0; i < run.f.size(); ++i) {
    if (run.time[i] < from) continue;
    ++seen;
    sum += run.f[i];
    squares += run.f[i] * run.f[i];
  }
  const double mean = seen > 0 ? sum / seen : 0;
  return seen > 0 ? std::sqrt(std::max(0.0, squares / seen - mean * mean)) : 0;
}

}  // namespace

driver::Result<WallTouch> press_on_wall(const scene::ArmFile& arm, const WallTrial& trial) {
  // The hand's spring presses with `press` if its target is this far inside.
  const double deep = trial.press / std::max(1.0, arm.simulated.hand.stiffness);
  if (!scene::joint_angles_at(arm, trial.p_W + kAway * trial.n_W) ||
      !scene::joint_angles_at(arm, trial.p_W - deep * trial.n_W)) {
    return driver::Error{"The wall is outside the arm's workspace."};
  }
  const WallCase wall{.direction = {.n_W = trial.n_W, .p_WT = trial.p_W, .step = 0},
                      .tip = arm.simulated.plant,
                      .hand = arm.simulated.hand,
                      .stiffness = trial.stiffness,
                      .damping = trial.damping,
                      .one_sided = true,
                      .own_step = true,
                      .energy = trial.energy,
                      .own_limits = true,
                      .velocity_corner = arm.velocity_corner_frequency,
                      .period_ns = std::llround(1e9 / trial.rate),
                      .own_wire = true,
                      .gaps_ns = {},
                      .hand_from = kAway,
                      .hand_to = -deep,
                      .hand_start = kBegin,
                      .hand_end = kBegin + (kAway + deep) / trial.speed,
                      .duration = kEnd,
                      .give_up = HUGE_VAL};
  const auto run = run_wall(arm, wall);
  if (!run) return run.error();
  return WallTouch{
      .oscillation = oscillation_between(*run, kEnd - kWatched, HUGE_VAL),
      .oscillation_before = oscillation_between(*run, kEnd - kWatched - kBefore, kEnd - kBefore),
      .force_max = *std::max_element(run->f.begin(), run->f.end()),
      .energy_given = *std::max_element(run->work.begin(), run->work.end()),
      .force_rms = force_rms(*run, kEnd - kWatched),
      .fault = run->fault,
      .gate = run->gate};
}

bool comes_to_rest(const WallTouch& touch, double quiet) {
  // Near the edge an oscillation decays slowly, so a decrease is sufficient: 5 % in 0.4 s are 0.5 %
  // below the edge for 0.1 kg and a latency of 1.5 ms. Written so that NaN is not quiet.
  return !touch.fault &&
         (touch.oscillation <= quiet || touch.oscillation < 0.95 * touch.oscillation_before);
}

driver::Result<double> simulated_edge(const scene::ArmFile& arm, WallTrial trial, double guess,
                                      double quiet) {
  return raised_edge(guess / 10, 10 * guess, [&](double stiffness) -> driver::Result<bool> {
    trial.stiffness = stiffness;
    const auto touch = press_on_wall(arm, trial);
    if (!touch) return touch.error();
    return comes_to_rest(*touch, quiet);
  });
}

}  // namespace thimble::stability
