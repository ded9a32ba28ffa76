#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "stability/stability_laws.h"
#include "studies/accuracy/axes/axes.h"
#include "studies/accuracy/impact.h"
#include "studies/accuracy/stiffest_wall.h"
#include "studies/accuracy/stroked_ring.h"

namespace thimble::studies {
namespace {

constexpr double kTick = 1e-3;      // s
constexpr double kStiffness = 800;  // N/m, the vintage arm's declared one
constexpr double kViscous = 1e-4;   // N s/m: almost zero, so that e = 1 is the truth

// Returns a pseudo-random number in [0, 1) that depends only on run and tick.
double chance(int run, int k) {
  std::uint64_t z = static_cast<std::uint64_t>(run) * 1000003u + static_cast<std::uint64_t>(k) + 1;
  z *= 0x9e3779b97f4a7c15ull;  // splitmix64 [S Steele, Lea, Flood 2014]
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

// The durations of late or uneven ticks: the k-th tick of a run, s, and the parameters of the laws.
struct Times {
  double period = kTick;
  double spread = 0;  // s, standard deviation
  double delay = 0;   // s
  std::function<double(int run, int k)> period_of = {};
};

enum class Measure { kRestitution, kCompliance };

AccuracyPoint point_of(const std::string& name, const Times& times, Measure felt) {
  const double latency = scene::latency_of(
      {.period = times.period, .period_spread = times.spread, .delay = times.delay});
  AccuracyPoint point{
      .name = name, .knob = 1e3 * latency, .error = {}, .prepare = [] { return ring_work({}); }};
  point.ticks = kRingTicks;
  if (felt == Measure::kRestitution) {
    const Impact impact{.viscous = kViscous,
                        .stiffness = kStiffness,
                        .period = times.period,
                        .delay = times.delay,
                        .period_of = times.period_of};
    point.error = [impact] { return 100 * (mean_restitution(impact) - 1); };
    point.law = 100 * (stability::restitution(kStiffness, kViscous, impact.mass, latency) - 1);
  } else {
    RestedWall wall;
    wall.period = times.period;
    wall.delay = times.delay;
    wall.duration = 4;
    if (times.period_of) wall.period_of = [times](int k) { return times.period_of(0, k); };
    point.error = [wall] { return 1e3 / stiffest(wall); };
    point.law = 1e3 / stability::late_stiffness_limit(wall.viscous, latency, wall.mass);
  }
  return point;
}

std::vector<AccuracyLine> lines_of(Measure felt) {
  AccuracyLine delay{.name = "delay", .title = "delay", .order = {}, .points = {}};
  for (const double ticks : {0.0, 0.25, 0.5, 1.0, 2.0, 3.0}) {
    delay.points.push_back(point_of(std::to_string(static_cast<int>(1000 * ticks)) + "us",
                                    {.delay = ticks * kTick}, felt));
    delay.points.back().is_default = ticks == 1;
    delay.points.back().fits = true;
  }
  if (felt == Measure::kCompliance) delay.order = 1;
  AccuracyLine jitter{
      .name = "jitter", .title = "ticks of uneven length", .order = {}, .points = {}};
  for (const double width : {0.2, 0.5, 0.8, 1.0, 1.4, 1.8}) {
    Times times{.spread = kTick * width / std::sqrt(12.0)};
    times.period_of = [width](int run, int k) {
      return kTick * (1 + width * (chance(run, k) - 0.5));
    };
    jitter.points.push_back(
        point_of(std::to_string(static_cast<int>(100 * width)) + "percent", times, felt));
  }
  AccuracyLine gaps{.name = "gaps", .title = "some ticks take 4 ms", .order = {}, .points = {}};
  for (const double share : {0.005, 0.01, 0.02, 0.05, 0.1, 0.2}) {
    Times times{.period = kTick * (1 + 3 * share), .spread = 3e-3 * std::sqrt(share * (1 - share))};
    times.period_of = [share](int run, int k) { return chance(run, k) < share ? 4e-3 : 1e-3; };
    gaps.points.push_back(
        point_of(std::to_string(static_cast<int>(1000 * share)) + "permille", times, felt));
  }
  std::vector<AccuracyLine> lines;
  lines.push_back(std::move(delay));
  lines.push_back(std::move(jitter));
  lines.push_back(std::move(gaps));
  return lines;
}

AccuracyAxis axis_of(Measure felt) {
  AccuracyAxis axis;
  axis.knob = "latency L = E[T^2] / 2 E[T] + delay";
  axis.knob_unit = "ms";
  axis.over_cost = false;
  axis.given = true;
  axis.default_words =
      "a full-speed USB arm always has one frame of delay: one transfer in and one "
      "out per frame.";
  axis.left_out =
      "The error over the cost: all delays and jitters cost the same to simulate. "
      "Gaps of 30 ms, where the law is 13 % off.";
  axis.lines = lines_of(felt);
  return axis;
}

}  // namespace

AccuracyAxis latency_axis() {
  AccuracyAxis axis = axis_of(Measure::kRestitution);
  axis.name = "latency";
  axis.title = "Delay and jitter: only the mean latency matters (bounce)";
  axis.metric = "speed gained by a bounce, e - 1";
  axis.unit = std::string("%");
  axis.truth =
      "A wall in continuous time: e = 1. Also drawn: the law of restitution, ln e = "
      "pi K L / 2 sqrt(K m).";
  axis.threshold = 3.5;
  axis.threshold_words = "half the noticeable change of impact (3.5 %)";
  return axis;
}

AccuracyAxis latency_stiffness_axis() {
  AccuracyAxis axis = axis_of(Measure::kCompliance);
  axis.name = "latency_stiffness";
  axis.title = "Delay and jitter: the stiffest wall that is stable in a hand";
  axis.metric = "compliance of the stiffest wall";
  axis.unit = "mm/N";
  axis.truth =
      "A wall in continuous time, which can have any stiffness. Also drawn: the law "
      "K = (b / L) u / sin u, u tan u = b L / m, for a hand of 3 N s/m.";
  axis.threshold = kRigidCompliance;
  axis.threshold_words = kRigidWords;
  return axis;
}

}  // namespace thimble::studies
