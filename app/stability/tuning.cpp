#include "stability/tuning.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "energy_guard_settings.h"
#include "log/progress.h"
#include "stability/rest_trial.h"
#include "stability/rest_warnings.h"
#include "stability/wall_trial.h"
#include "thimble/scene/shared_meshes.h"

namespace thimble::stability {
namespace {

/// Safe share of the limit: a tighter grip adds stiffness as well as damping [chosen]. It does not
/// suffice for hands that differ by a factor of three, which are evaluated separately.
constexpr double kShare = 0.7;

/// Safe share of the limit with the worst of those hands: there oscillations decay within a second
/// [measured, tests/sim/hand_constants_test].
constexpr double kShareAnyHand = 0.8;

/// Returns the time between the reports of an arm, or between those requested from a Falcon, ms.
double report_period_ms(const scene::ArmFile& arm, double rate) {
  return arm.is<driver::DeltaArm>()
             ? 1e3 / rate
             : 1e-6 * static_cast<double>(arm.simulated.firmware.report_period_ns);
}

/// Max. delay in periods for the exact map of a tick [chosen].
constexpr double kPeriodsLate = 32;

/// A wall in the linear loop of an arm.
class WallLoop {
 public:
  WallLoop(const scene::ArmFile& arm, const scene::LoopTimes& times, double damping)
      : arm_(arm),
        latency_(scene::latency_of(times)),
        tip_(scene::worst_over_workspace(arm)),
        damping_(damping) {
    // A delay of many periods is equivalent to a coarser loop of the same latency, whose map of a
    // tick stays small.
    const bool many = latency_ - times.period / 2 > kPeriodsLate * times.period;
    period_ = many ? latency_ / (kPeriodsLate + 0.5) : times.period;
  }
  double latency() const { return latency_; }
  const scene::TipLimits& tip() const { return tip_; }

  /// Returns the largest stable stiffness of the wall with a hand, N/m.
  double edge_with(const device_sim::HandSettings& hand) const {
    return stiffness_edge({.mass = tip_.mass + hand.mass,
                           .viscous = tip_.damping + hand.damping,
                           .hand_stiffness = hand.stiffness,
                           .damping = damping_,
                           .velocity_corner = arm_.velocity_corner_frequency,
                           .period = period_,
                           .delay = latency_ - period_ / 2});
  }
  /// Returns the largest stable stiffness of the wall with the hand of the arm file, N/m.
  double edge() const { return edge_with(arm_.simulated.hand); }

 private:
  const scene::ArmFile& arm_;
  double latency_;  // s
  scene::TipLimits tip_;
  double damping_;  // N s/m
  double period_;   // s
};

/// Smallest limits of the simulated walls.
struct Edges {
  double linear = std::numeric_limits<double>::infinity();  // without dry friction and steps, N/m
  double as_is = std::numeric_limits<double>::infinity();   // N/m
  int walls = 0;
};

/// Removes dry friction, encoder steps and tremor from an arm; the law describes the remainder.
scene::ArmFile without_friction(scene::ArmFile arm) {
  arm.simulated.plant.coulomb = 0;
  arm.simulated.firmware.ideal_encoders = !arm.is<driver::DeltaArm>();
  return arm;
}

Edges try_walls(const scene::ArmFile& file, double rate, double damping,
                const StabilityLimits& carried, int per_side) {
  scene::ArmFile arm = file;
  arm.simulated.hand.tremor_amplitude = 0;
  // Room for the hand's path within the workspace.
  const Eigen::Vector3d room =
      (0.02 * Eigen::Vector3d::Ones()).cwiseMin(0.25 * (arm.workspace.max_W - arm.workspace.min_W));
  arm.workspace.min_W += room;
  arm.workspace.max_W -= room;
  const scene::ArmFile smooth = without_friction(arm);
  const double quiet = kQuietAtRest + kQuietSteps * carried.tip.encoder_step;
  Edges edges;
  for (const Eigen::Vector3d& p_W : scene::points_of_workspace(arm, per_side)) {
    for (int axis = 0; axis < 3; ++axis) {
      const WallTrial trial{
          .p_W = p_W, .n_W = Eigen::Vector3d::Unit(axis), .damping = damping, .rate = rate};
      const auto linear = simulated_edge(smooth, trial, carried.stiffness_exact, quiet);
      const auto as_is = simulated_edge(arm, trial, carried.stiffness_exact, quiet);
      if (!linear || !as_is) continue;
      edges.linear = std::min(edges.linear, *linear);
      edges.as_is = std::min(edges.as_is, *as_is);
      ++edges.walls;
    }
  }
  return edges;
}

/// Max. rate of a loop that advice names, Hz [chosen: the max. rate of a scene].
constexpr double kRateMax = 1e5;

/// Returns a rate at which the law allows the values of an object, an integer multiple of the
/// scene's. Empty if a faster loop would wait for the arm's reports and wire.
std::optional<double> stable_rate(const scene::Scene& scene, const scene::SceneObject& object) {
  const auto carries = [&](double rate) {
    const scene::ArmFile& arm = scene.arms.front().arm;
    return WallLoop(arm, loop_times(arm, rate), object.damping).edge() >= object.stiffness;
  };
  for (int times = 2; times <= 8; ++times) {
    if (times * scene.rate <= kRateMax && carries(times * scene.rate)) return times * scene.rate;
  }
  return {};
}

/// Returns the largest damping below an object's own at which its stiffness is safe, N s/m; empty
/// if less damping does not help.
std::optional<double> stable_damping(const scene::Scene& scene, const scene::SceneObject& object,
                                     const scene::LoopTimes& times) {
  const auto carries = [&](double damping) {
    const scene::ArmFile& arm = scene.arms.front().arm;
    // Most damping fails with the hand of the file already; other hands take 8 times as long.
    return kShare * WallLoop(arm, times, damping).edge() >= object.stiffness &&
           stability_limits(arm, times, object.stiffness, damping).stiffness_safe >=
               object.stiffness;
  };
  double low = object.damping;
  for (int halved = 0; halved < 12; ++halved) {
    low /= 2;
    if (!carries(low)) continue;
    double high = 2 * low;
    for (int i = 0; i < 7; ++i) {
      const double middle = (low + high) / 2;
      (carries(middle) ? low : high) = middle;
    }
    return low;
  }
  return carries(0) ? std::optional<double>(0) : std::nullopt;
}

/// Returns `value` rounded down to two digits.
double rounded_down(double value) {
  if (!(value > 0)) return 0;
  double digit = 1e-9;
  while (digit * 100 <= value) digit *= 10;
  return digit * std::floor(value / digit);
}

/// Returns the name of the stiffness of an object in its scene: `stiffness`, or the larger end of
/// its map.
std::string name_of_stiffness(const scene::SceneObject& object) {
  if (!object.stiffness_map) return "stiffness";
  const bool black = object.stiffness_map->black > object.stiffness_map->white;
  return std::string(black ? "min" : "max") + " of its stiffness_map";
}

/// Returns advice for a wall whose damping makes it grow at any stiffness.
std::string advice_to_damp_less(const scene::Scene& scene, const scene::SceneObject& object,
                                const StabilityLimits& carried) {
  const std::optional<double> damping = stable_damping(scene, object, carried.times);
  std::string text = fmt::format(
      "{}: a damping of {:.3g} N s/m is unstable at any stiffness with a latency of "
      "{:.2f} ms. ",
      object.name, object.damping, 1e3 * carried.latency);
  if (damping) return text + fmt::format("Set it to {:.2g} N s/m or less.", rounded_down(*damping));
  // At most the value without the surface's damping.
  const double safe =
      stability_limits(scene.arms.front().arm, carried.times, object.stiffness, 0).stiffness_safe;
  return text + fmt::format("Set it to 0, and the {} to {:.0f} N/m or less.",
                            name_of_stiffness(object), std::floor(safe));
}

/// Returns advice for a wall that is too stiff.
std::string advice(const scene::Scene& scene, const scene::SceneObject& object,
                   const StabilityLimits& carried) {
  if (!(carried.stiffness_exact > 0)) return advice_to_damp_less(scene, object, carried);
  std::string text = fmt::format(
      "{}: a stiffness of {:.0f} N/m is unstable; with this arm, loop and hand the "
      "limit is {:.0f} N/m (damping {:.3g} N s/m, latency {:.2f} ms). Set {} to {:.0f} N/m or less",
      object.name, object.stiffness, carried.stiffness_exact, carried.damping + object.damping,
      1e3 * carried.latency, (object.stiffness_map ? "the " : "its ") + name_of_stiffness(object),
      carried.stiffness_safe);
  const std::optional<double> damping =
      object.damping > 0 ? stable_damping(scene, object, carried.times) : std::nullopt;
  if (damping && *damping > 0) {
    text += fmt::format(", or its damping to {:.2g} N s/m", rounded_down(*damping));
  }
  if (const auto rate = stable_rate(scene, object)) {
    return text + fmt::format(", or run at {:.0f} Hz.", *rate);
  }
  return text + fmt::format(
                    ". A faster loop does not suffice: the arm reports every {:.3g} ms, and its "
                    "wire adds {:.3g} ms.",
                    report_period_ms(scene.arms.front().arm, scene.rate),
                    1e3 * scene::loop_delay(scene.arms.front().arm));
}

// Shares of the time of `tune` after the rests with the hand of the scene, and after the walls of
// all objects; the rest is other hands [chosen].
constexpr double kFirstRestsShare = 0.2, kWallsShare = 0.5;

/// Adds how the hand of the scene rested in `trial`, and how hands of other firmness rest.
void report_rests(const scene::Scene& scene, const RestTrial& trial,
                  const std::shared_ptr<scene::SharedMeshes>& meshes, scene::Progress& progress,
                  TuneResult& result) {
  const device_sim::HandSettings& own = scene.arms.front().arm.simulated.hand;
  for (const Rest& rest : trial.rests) {
    result.text +=
        fmt::format("Rest      at {:.2f} s{}: {:.2g} N, oscillates by {:.2f} mN RMS\n", rest.time,
                    rest.on.empty() ? "" : " on " + rest.on, rest.force, 1e3 * rest.oscillation);
  }
  const std::vector<std::string> warnings = rest_warnings(scene, trial);
  for (const std::string& warning : warnings) result.text += "Warning   " + warning + "\n";
  const Rest* const worst = trial.worst();
  result.figures.push_back(
      {"rest_oscillation", worst ? worst->oscillation : 0, "N", fmt::format("<= {:g}", kRestFelt)});
  result.figures.push_back({"rest_warnings", static_cast<double>(warnings.size()), "", ""});

  device_sim::HandSettings low = own, high = own;
  double safe = std::numeric_limits<double>::infinity();
  std::vector<std::pair<std::string, device_sim::HandSettings>> others;
  for (const auto& [hand, times] : {std::pair{&low, 1.0 / 3}, std::pair{&high, 3.0}}) {
    hand->mass *= times;
    hand->stiffness *= times;
    hand->damping *= times;
  }
  others.emplace_back("a third of the hand's mass, stiffness and damping", low);
  others.emplace_back("three times these constants", high);
  double stiffest = 0;
  for (const scene::SceneObject& object : scene.objects) {
    if (object.build_field || !(object.stiffness > stiffest)) continue;
    stiffest = object.stiffness;
    const StabilityLimits carried =
        stability_limits(scene.arms.front().arm, loop_times(scene.arms.front().arm, scene.rate),
                         object.stiffness, object.damping);
    safe = carried.stiffness_safe;
    if (others.size() > 2) others.pop_back();
    others.emplace_back("worst hand in this range", carried.worst_hand);
  }
  std::size_t tried = 0;
  for (const auto& [words, hand] : others) {
    const auto found = try_rests(scene, hand, meshes);
    progress.set_share(kWallsShare + (1 - kWallsShare) * static_cast<double>(++tried) /
                                         static_cast<double>(others.size()));
    if (!found) continue;
    const Rest* const most = found->worst();
    if (most == nullptr) continue;
    result.text += fmt::format(
        "Hands     {} ({:.3g} kg, {:.3g} N/m, {:.3g} N s/m): oscillates by up to {:.2f} mN RMS{}\n",
        words, hand.mass, hand.stiffness, hand.damping, 1e3 * most->oscillation,
        most->oscillation > kRestFelt
            ? fmt::format(", which can be felt; up to {:.0f} N/m is safe for all of them", safe)
            : std::string());
  }
}

/// Reports the limit of a wall that another program computes, over topics.
void report_topics(const scene::Scene& scene, const scene::LoopTimes& times, const AnswerAges& ages,
                   TuneResult& result) {
  scene::LoopTimes late = times;
  late.delay += ages.percentile_99;
  const StabilityLimits here = stability_limits(scene.arms.front().arm, times, 1000, 0);
  const StabilityLimits there = stability_limits(scene.arms.front().arm, late, 1000, 0);
  result.text += fmt::format(
      "ROS 2     forces are based on positions that are {:.2f} ms old (median), "
      "{:.2f} ms (99 %). Limit of a wall without damping that the other program "
      "computes: {:.0f} N/m by the law, {:.0f} N/m safe; computed here: {:.0f} N/m, "
      "{:.0f} N/m.\n",
      1e3 * ages.median, 1e3 * ages.percentile_99, there.stiffness_exact, there.stiffness_safe,
      here.stiffness_exact, here.stiffness_safe);
  result.figures.push_back({"topics.age_median", 1e3 * ages.median, "ms", ""});
  result.figures.push_back({"topics.age_99", 1e3 * ages.percentile_99, "ms", ""});
  result.figures.push_back({"topics.stiffness", there.stiffness_exact, "N/m", ""});
  result.figures.push_back({"topics.stiffness_safe", there.stiffness_safe, "N/m", ""});
}

}  // namespace

scene::LoopTimes loop_times(const scene::ArmFile& arm, double rate, double period_spread) {
  scene::LoopTimes times = scene::loop_pace(arm, rate);
  times.period_spread =
      std::sqrt(times.period_spread * times.period_spread + period_spread * period_spread);
  return times;
}

StabilityLimits stability_limits(const scene::ArmFile& arm, const scene::LoopTimes& times,
                                 double stiffness, double damping) {
  const WallLoop loop(arm, times, damping);
  StabilityLimits carried;
  carried.times = times;
  carried.latency = loop.latency();
  carried.tip = loop.tip();
  carried.damping = carried.tip.damping + arm.simulated.hand.damping;
  carried.stiffness_law = scene::stiffness_limit(carried.damping + damping, carried.latency);
  // Jitter acts like this additional delay [PHYSICS 1.1].
  const double more = carried.latency - times.period / 2;
  carried.stiffness_exact = loop.edge();
  carried.stiffness_any_hand = carried.stiffness_exact;
  carried.worst_hand = arm.simulated.hand;
  for (int corner = 0; corner < 8; ++corner) {
    const auto times_of = [corner](int bit) { return (corner >> bit & 1) != 0 ? 3.0 : 1.0 / 3; };
    device_sim::HandSettings hand = arm.simulated.hand;
    hand.mass *= times_of(0);
    hand.stiffness *= times_of(1);
    hand.damping *= times_of(2);
    const double edge = loop.edge_with(hand);
    if (edge < carried.stiffness_any_hand) {
      carried.stiffness_any_hand = edge;
      carried.worst_hand = hand;
    }
  }
  carried.stiffness_safe =
      std::min(kShare * carried.stiffness_exact, kShareAnyHand * carried.stiffness_any_hand);
  const double step = carried.tip.encoder_step;
  carried.passive =
      std::min(passive_stiffness(carried.tip.damping, 0, times.period, more),
               passive_stiffness_quantised(carried.tip.damping, arm.simulated.plant.coulomb, step,
                                           times.period));
  carried.held_speed = oscillation_speed_limit(stiffness, carried.tip.damping,
                                               arm.simulated.plant.coulomb, carried.latency);
  // The length that a bristle needs is proportional to its force, so their quotient depends only on
  // the arm.
  carried.bristle_stiffness =
      1 / bristle_length(1, carried.latency, carried.damping, step, arm.simulated.plant.coulomb);
  return carried;
}

std::vector<std::string> stability_warnings(const scene::Scene& scene) {
  std::vector<std::string> warnings;
  if (!scene.arms.front().arm.can_simulate) return warnings;  // its tip is unknown
  const scene::ArmFile& arm = scene.arms.front().arm;
  const scene::LoopTimes times = loop_times(arm, scene.rate);
  bool stable = true;
  const scene::SceneObject* before = nullptr;  // object of `stable`
  for (const scene::SceneObject& object : scene.objects) {
    if (object.build_field || !(object.stiffness > 0)) continue;
    // Many objects of a large scene are alike.
    if (before == nullptr || object.stiffness != before->stiffness ||
        object.damping != before->damping) {
      stable = object.stiffness <= WallLoop(arm, times, object.damping).edge();
      before = &object;
    }
    if (!stable) {  // the other limits are needed only for advice
      warnings.push_back(
          advice(scene, object, stability_limits(arm, times, object.stiffness, object.damping)));
    }
  }
  for (std::string& warning : energy_warnings(scene)) warnings.push_back(std::move(warning));
  for (std::size_t i = 1; i < scene.arms.size(); ++i) {
    const scene::SceneArm& other = scene.arms[i];
    scene::Scene with_it = scene;
    with_it.arms = {other};
    for (const std::string& warning : stability_warnings(with_it)) {
      warnings.push_back("The arm \"" + other.name + "\": " + warning);
    }
  }
  return warnings;
}

driver::Result<TuneResult> tune(const scene::Scene& scene, const TuneOptions& options) {
  scene::Progress progress("tune");
  const auto meshes = std::make_shared<scene::SharedMeshes>();  // shared by all hands
  // First, because a scene that cannot be opened fails here.
  const auto trial = try_rests(scene, scene.arms.front().arm.simulated.hand, meshes);
  if (!trial) return trial.error();
  progress.set_share(kFirstRestsShare);
  TuneResult result;
  const scene::ArmFile& arm = scene.arms.front().arm;
  const scene::LoopTimes times = loop_times(arm, scene.rate, options.period_spread);
  const StabilityLimits bare = stability_limits(arm, times, 1000, 0);
  const double waited = times.delay - scene::loop_delay(arm);
  result.text += fmt::format(
      "{} at {:.0f} Hz, with the hand of its file ({:.3g} kg, {:.3g} N/m, {:.3g} N s/m):\n",
      arm.name, scene.rate, arm.simulated.hand.mass, arm.simulated.hand.stiffness,
      arm.simulated.hand.damping);
  result.text += fmt::format(
      "Latency   {:.3f} ms: half a period {}{:.3f}, jitter {:.3f}, wire {:.3f}{}.\n",
      1e3 * bare.latency, times.period > 1.001 / scene.rate ? "of the arm's reports " : "",
      0.5e3 * times.period, 1e3 * (bare.latency - times.period / 2 - times.delay),
      1e3 * scene::loop_delay(arm),
      waited > 0 ? fmt::format(", wait of reports for a tick {:.3f}", 1e3 * waited)
                 : std::string());
  result.text += fmt::format(
      "Tip       {:.3g} kg, {:.3g} N s/m, {:.3g} N of dry friction; encoder step up "
      "to {:.0f} um.\n",
      bare.tip.mass, bare.tip.damping, arm.simulated.plant.coulomb, 1e6 * bare.tip.encoder_step);
  result.text += fmt::format(
      "Passive   with any hand up to {:.3g} N/m (much less than such arms are used "
      "with); without a hand, dry friction keeps a wall of 1000 N/m stable for "
      "oscillations up to {:.3f} m/s.\n",
      bare.passive, bare.held_speed);
  result.text += fmt::format(
      "Friction  a bristle of up to {:.0f} N/m does not oscillate: z_max >= {:.3g} "
      "mm per newton of friction.\n",
      bare.bristle_stiffness, 1e3 / bare.bristle_stiffness);
  result.figures = {{"latency", 1e3 * bare.latency, "ms", ""},
                    {"encoder_step", 1e6 * bare.tip.encoder_step, "um", ""},
                    {"passive_stiffness", bare.passive, "N/m", ""},
                    {"bristle_stiffness", bare.bristle_stiffness, "N/m", ""},
                    {"bristle_length_per_newton", 1e3 / bare.bristle_stiffness, "mm/N", ""}};
  if (options.topics) report_topics(scene, times, *options.topics, result);
  std::size_t objects_done = 0;
  for (const scene::SceneObject& object : scene.objects) {
    if (object.build_field || !(object.stiffness > 0)) continue;
    const StabilityLimits carried = stability_limits(arm, times, object.stiffness, object.damping);
    result.text += fmt::format("{}: the scene sets {:.0f} N/m and {:.3g} N s/m.\n", object.name,
                               object.stiffness, object.damping);
    result.text +=
        fmt::format("  law       (b + B) / L = {:.0f} N/m; the exact linear loop {:.0f} N/m\n",
                    carried.stiffness_law, carried.stiffness_exact);
    const std::string name = object.name;
    result.figures.push_back({name + ".asked", object.stiffness, "N/m", ""});
    result.figures.push_back({name + ".law", carried.stiffness_law, "N/m", ""});
    result.figures.push_back({name + ".exact", carried.stiffness_exact, "N/m", ""});
    double edge = carried.stiffness_exact;
    if (!(carried.stiffness_exact > 0)) {
      result.text += "  simulated no: its damping makes it unstable at any stiffness\n";
    } else if (arm.is<driver::DeltaArm>()) {
      result.text += "  simulated no: the simulation of a Falcon supports whole scenes only\n";
    } else {
      const Edges edges =
          try_walls(arm, scene.rate, object.damping, carried, options.places_per_side);
      if (edges.walls > 0) {
        edge = std::min(edge, edges.as_is);
        result.text += fmt::format(
            "  simulated {:.0f} N/m without dry friction and steps, {:.0f} N/m with both; "
            "the worst of {} walls across the workspace, through wire and gate\n",
            edges.linear, edges.as_is, edges.walls);
        result.figures.push_back({name + ".simulated_linear", edges.linear, "N/m", ""});
        result.figures.push_back({name + ".simulated", edges.as_is, "N/m", ""});
        result.figures.push_back(
            {name + ".simulated_over_exact", edges.linear / carried.stiffness_exact, "1", ""});
      }
    }
    const device_sim::HandSettings& hand = carried.worst_hand;
    result.text += fmt::format(
        "  hands     of a third to three times these constants: {:.0f} "
        "N/m; the worst has {:.3g} kg, {:.3g} N/m, {:.3g} N s/m\n",
        carried.stiffness_any_hand, hand.mass, hand.stiffness, hand.damping);
    result.figures.push_back({name + ".any_hand", carried.stiffness_any_hand, "N/m", ""});
    result.figures.push_back(
        {name + ".margin_any_hand", carried.stiffness_any_hand / object.stiffness, "1", ">= 1"});
    const double safe = std::min(kShare * edge, carried.stiffness_safe);
    const double margin = edge / object.stiffness;
    result.figures.push_back({name + ".margin", margin, "1", fmt::format(">= {:g}", 1 / kShare)});
    result.text += fmt::format("  margin    {:.2f}; up to {:.0f} N/m is safe here{}\n", margin,
                               safe, object.stiffness <= safe ? "." : "; reduce the stiffness.");
    progress.set_share(kFirstRestsShare + (kWallsShare - kFirstRestsShare) *
                                              static_cast<double>(++objects_done) /
                                              static_cast<double>(scene.objects.size()));
  }
  for (const std::string& warning : stability_warnings(scene)) {
    result.text += "Warning   " + warning + "\n";
  }
  report_rests(scene, *trial, meshes, progress, result);
  return result;
}

}  // namespace thimble::stability
