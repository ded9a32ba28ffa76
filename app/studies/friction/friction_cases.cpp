#include "studies/friction/friction_cases.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <span>

#include "stability/signal.h"
#include "surface/friction/bristle.h"
#include "thimble/render/effect/effect_table.h"
#include "thimble/render/effect/map_settings.h"

namespace thimble::studies {
namespace {

constexpr double kCoefficient = 0.5;   // of 1 N [PHYSICS 2.2]
constexpr double kCorner = 50;         // Hz [PHYSICS 2.5]
constexpr double kNothing = 1e-12;     // N or m
constexpr double kOscillates = 0.001;  // N RMS [PHYSICS 7, case 14]

/// Returns the RMS above the corner in the last `ticks`; the remaining transient of the filter
/// counts as 0.
double above_corner(std::span<const double> signal, double rate, std::size_t ticks) {
  const std::vector<double> fast = stability::high_passed(signal, rate, kCorner);
  const double found = stability::root_mean_square(std::span(fast).last(ticks));
  return found > kNothing ? found : 0;
}

/// Creeps at `speed` long enough to slide, symmetric about the arm's home.
stability::RigRun creep_run(const FrictionCase& which, const stability::FrictionRigSettings& rig,
                            double speed) {
  const auto friction = build_friction(which, rig);
  return stability::rub(*friction, {{0, -3 * speed}, {0.5, -3 * speed}, {6.5, 3 * speed}}, 6.5,
                        rig);
}

}  // namespace

const std::vector<FrictionCase>& friction_cases() {
  // The last one violates the arm's bound on purpose: z_max of one count, which a scene may not
  // have.
  static const std::vector<FrictionCase> cases{
      {"naive", "naive, zero at rest", "A", "naive", "at_rest", "zero"},
      {"naive_hold", "naive, holds the last direction", "B", "naive", "at_rest", "hold"},
      {"paper_direction", "paper, direction smoothed", "E", "paper", "smooth", "direction"},
      {"paper_velocity", "paper, velocity smoothed", "D", "paper", "smooth", "velocity"},
      {"paper_twice", "paper, smoothed twice", "F", "paper", "smooth", "twice"},
      {"stiction_point", "stiction point", "", "stiction_point", "", ""},
      {"bristle", "bristle (default)", "H", "bristle", "", ""},
      {"dahl", "Dahl", "I", "dahl", "", ""},
      {"lugre", "LuGre", "", "lugre", "", "", 0.6},
      {"karnopp", "Karnopp, stick spring", "G", "karnopp", "", ""},
      {"implicit_coulomb", "implicit Coulomb", "J", "implicit_coulomb", "", ""},
      {"bristle_one_count", "bristle of one count (refused)", "H3", "bristle", "", "", 0,
       kCoefficient / 3e-5},
  };
  return cases;
}

std::unique_ptr<render::AnyStage> build_friction(const FrictionCase& which,
                                                 const stability::FrictionRigSettings& rig) {
  if (which.stiffness > 0) {
    return std::make_unique<render::AnyStageOf<render::BristleFriction>>(
        render::BristleFriction({.coulomb = {.sliding = kCoefficient, .holding = kCoefficient},
                                 .stiffness = which.stiffness},
                                stability::effect_context_of(rig)));
  }
  std::map<std::string, double> numbers{{"coefficient", kCoefficient}};
  if (which.static_coefficient > 0) numbers["static_coefficient"] = which.static_coefficient;
  std::map<std::string, std::string> words;
  if (!which.word_key.empty()) words[which.word_key] = which.word;
  const auto table = render::effect_table();
  const auto kind = std::find_if(table.begin(), table.end(), [&](const render::EffectKind& one) {
    return one.group == "friction" && one.name == which.kind;
  });
  assert(kind != table.end());
  render::MapSettings settings(numbers, words);
  const render::StageBuilder build = kind->read(settings, stability::effect_context_of(rig));
  assert(settings.mistakes().empty());
  return build();
}

stability::RigRun stop_run(const FrictionCase& which, const stability::FrictionRigSettings& rig,
                           double stop) {
  const auto friction = build_friction(which, rig);
  return stability::rub(*friction,
                        {{0, stop - 0.02}, {kStopTime - 0.4, stop - 0.02}, {kStopTime, stop}},
                        kStopTime + 2, rig);
}

FrictionMeasures measure(const FrictionCase& which, const stability::FrictionRigSettings& rig) {
  FrictionMeasures found;
  found.stop = stop_run(which, rig);
  const double rate = 1 / found.stop.period;
  const auto second = static_cast<std::size_t>(std::llround(rate));
  found.rest_force = above_corner(found.stop.force, rate, second);
  found.rest_way = above_corner(found.stop.x, rate, second);
  std::vector<double> rest(found.stop.force.end() - std::llround(rate), found.stop.force.end());
  const double held = std::abs(stability::mean(rest));
  if (found.rest_force > kOscillates) {
    const double middle = stability::mean(rest);
    for (double& force : rest) force -= middle;
    found.rest_frequency = stability::sign_changes_per_second(rest, rate) / 2;
  }
  found.rest_held = held > kNothing ? held : 0;

  const stability::RigRun creep = creep_run(which, rig, 0.001);
  found.creep_force = above_corner(creep.force, rate, 2 * second);
  found.creep_mean = -stability::mean(std::span<const double>(creep.force).last(2 * second));
  const stability::RigRun slow = creep_run(which, rig, 0.005);
  found.slow_mean = -stability::mean(std::span<const double>(slow.force).last(2 * second));

  stability::FrictionRigSettings tremulous = rig;
  tremulous.tremor_amplitude = 300e-6;  // [PHYSICS 2.2]
  const auto friction = build_friction(which, tremulous);
  found.tremor_force =
      above_corner(stability::rub(*friction, {{0, 0}}, 3, tremulous).force, rate, 2 * second);
  return found;
}

EvenSliding slide_evenly(stability::FrictionRigSettings rig, double speed) {
  rig.hand_stiffness = 1e7;
  rig.hand_damping = 2000;
  constexpr int kRuns = 20;
  double sum = 0;
  double squares = 0;
  double count = 0;
  for (int i = 0; i < kRuns; ++i) {
    const double begin = i * 3e-5 / kRuns - 0.0015;
    const auto friction = build_friction(friction_cases().front(), rig);
    const double duration = 0.5 + 0.003 / speed;
    const stability::RigRun run = stability::rub(
        *friction, {{0, begin}, {0.5, begin}, {duration, begin + 0.003}}, duration, rig);
    // 2.7 mm are 90 whole counts.
    const auto ticks = static_cast<std::size_t>(std::llround(0.0027 / speed / run.period));
    for (const double force : std::span(run.force).last(ticks)) {
      sum += force;
      squares += force * force;
      count += 1;
    }
  }
  const double average = sum / count;
  return {-average, std::sqrt(squares / count - average * average)};
}

}  // namespace thimble::studies
