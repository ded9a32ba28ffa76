#include "study/accuracy/gating.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <memory>
#include <utility>

#include "meshes.h"
#include "scene_effects.h"
#include "session.h"
#include "study/accuracy/axis_words.h"
#include "study/accuracy/probed_stroke.h"

namespace thimble::app {
namespace {

// [STABILITY 6 and 8]
constexpr double kForceFelt = 0.02;   // N
constexpr double kShareFelt = 0.035;  // half of 7 %
constexpr double kLatencyShare = 0.05;
constexpr int kRounds = 5;

using Adjust = std::function<void(Scene&)>;

driver::Result<std::unique_ptr<Session>> open_with(const std::filesystem::path& scene,
                                                   const Adjust& adjust) {
  SessionOptions options;
  options.mesh_folder = mesh_folder();
  options.adjust = adjust;
  return Session::open(scene, options);
}

void leave_out(const std::string& name, Scene& scene) {
  auto& simulated = scene.arm.simulated;
  if (name == "quantisation") scene.arm.model.fractional_counts = true;
  if (name == "delay") simulated.wire.delay_in_ns = simulated.wire.delay_out_ns = 0;
  if (name == "coulomb") simulated.plant.coulomb = 0;
}

Adjust without(const std::vector<GateDecision>& decisions) {
  return [decisions](Scene& scene) {
    for (const GateDecision& one : decisions) {
      if (one.left_out) leave_out(one.name, scene);
    }
  };
}

double length(const std::array<double, 3>& v) {
  return std::hypot(v[0], v[1], v[2]);
}

// What the rules look at, found in a run of the full model.
struct Seen {
  double force_rms = 0, force_max = 0;  // N, in contact
  double acceleration = 0;              // m/s^2, 99th percentile in contact
  double depth_max = 0;                 // m
};

Seen look_at(std::span<const driver::TickRecord> rows, double tick) {
  Seen seen;
  std::vector<double> accelerations;
  double squares = 0;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    if (!rows[i].in_contact) continue;
    const double f = length(rows[i].f_sent_W);
    squares += f * f;
    seen.force_max = std::max(seen.force_max, f);
    seen.depth_max = std::max(seen.depth_max, rows[i].depth);
    std::array<double, 3> change{};
    for (std::size_t k = 0; k < 3; ++k) change[k] = rows[i].v_WT[k] - rows[i - 1].v_WT[k];
    accelerations.push_back(length(change) / tick);
  }
  if (accelerations.empty()) return seen;
  seen.force_rms = std::sqrt(squares / static_cast<double>(accelerations.size()));
  std::sort(accelerations.begin(), accelerations.end());
  seen.acceleration = accelerations[accelerations.size() * 99 / 100];
  return seen;
}

double compare(std::span<const driver::TickRecord> full, std::span<const driver::TickRecord> some) {
  double squares = 0, size = 0;
  for (std::size_t i = 0; i < std::min(full.size(), some.size()); ++i) {
    if (!full[i].in_contact && !some[i].in_contact) continue;
    std::array<double, 3> off{};
    for (std::size_t k = 0; k < 3; ++k) off[k] = some[i].f_sent_W[k] - full[i].f_sent_W[k];
    squares += length(off) * length(off);
    size += length(full[i].f_sent_W) * length(full[i].f_sent_W);
  }
  return size > 0 ? std::sqrt(squares / size) : 0;
}

std::string numbers(const char* text, double a, double b) {
  char line[200];
  std::snprintf(line, sizeof line, text, a, b);
  return line;
}

std::vector<GateDecision> decide(const Scene& scene, const Seen& seen) {
  double stiffness = 0, damping = 0;
  bool friction = false;
  for (const SceneObject& object : scene.objects) {
    stiffness = std::max(stiffness, object.stiffness);
    damping = std::max(damping, object.damping);
    for (const auto& plan : object.effects) friction = friction || plan.kind->group == "friction";
  }
  const auto surroundings = surroundings_of(scene.arm, scene.rate);
  const auto& simulated = scene.arm.simulated;
  std::vector<GateDecision> all;
  const double step = surroundings.encoder_step;
  const double by_spring = stiffness * step;
  const double by_damper = damping * step / surroundings.tick;
  all.push_back({.effect = "steps of the encoders",
                 .name = "quantisation",
                 .rule = numbers("K step = %.1f mN and B step / T = %.1f mN, to be at most 20 mN, "
                                 "and no friction",
                                 1e3 * by_spring, 1e3 * by_damper) +
                         (friction ? " (there is one)" : " (there is none)"),
                 .left_out = by_spring <= kForceFelt && by_damper <= kForceFelt && !friction});
  const double delay = surroundings.delay;
  const double holds = simulated.plant.viscous + damping + simulated.hand.damping;
  all.push_back({.effect = "delay and jitter",
                 .name = "delay",
                 .rule = numbers("K (L - T/2) = %.3f N s/m, to be below 5 %% of the damping that "
                                 "holds the tip, %.3f N s/m",
                                 stiffness * delay, kLatencyShare * holds),
                 .left_out = stiffness * delay < kLatencyShare * holds});
  all.push_back({.effect = "dry friction of the arm",
                 .name = "coulomb",
                 .rule = numbers("c = %.1f mN, to be below %.0f mN", 1e3 * simulated.plant.coulomb,
                                 1e3 * kForceFelt),
                 .left_out = simulated.plant.coulomb < kForceFelt});
  const double inertia = simulated.plant.mass * seen.acceleration;
  all.push_back({.effect = "inertia of the arm",
                 .name = "inertia",
                 .rule = numbers("m a = %.3f N, to be below 3.5 %% of the force, %.3f N", inertia,
                                 kShareFelt * seen.force_rms) +
                         "; the exact map costs the same with it, so it stays",
                 .left_out = false,
                 .changes = false});
  all.push_back({.effect = "lag of the amplifiers",
                 .name = "amplifier",
                 .rule = "to be below 5 % of the latency; this simulator has none",
                 .left_out = true,
                 .changes = false});
  all.push_back({.effect = "saturation",
                 .name = "saturation",
                 .rule = numbers("K x = %.2f N at most, to be below the arm's %.2f N; the limit is "
                                 "the gate's, which nothing leaves out",
                                 stiffness * seen.depth_max, scene.arm.limits.force_max),
                 .left_out = stiffness * seen.depth_max < scene.arm.limits.force_max,
                 .changes = false});
  all.push_back({.effect = "model of the hand",
                 .name = "hand",
                 .rule = "leads the tip in this scene, so it stays; a replay needs none",
                 .left_out = false,
                 .changes = false});
  return all;
}

// ns per tick of both, in turns, by the processor time of this thread.
driver::Result<std::pair<double, double>> time_both(const std::filesystem::path& scene,
                                                    const Adjust& reduced) {
  std::vector<double> ns[2];
  for (int round = 0; round < kRounds; ++round) {
    for (const int which : {0, 1}) {
      auto session = open_with(scene, which == 0 ? Adjust() : reduced);
      if (!session) return session.error();
      const std::atomic<bool> stop{false};
      timespec begin{}, end{};
      clock_gettime(CLOCK_THREAD_CPUTIME_ID, &begin);
      (*session)->run(stop);
      clock_gettime(CLOCK_THREAD_CPUTIME_ID, &end);
      const double spent = 1e9 * static_cast<double>(end.tv_sec - begin.tv_sec) +
                           static_cast<double>(end.tv_nsec - begin.tv_nsec);
      ns[which].push_back(spent / static_cast<double>((*session)->ticks_planned()));
    }
  }
  for (auto& list : ns) std::sort(list.begin(), list.end());
  return std::pair{ns[0][kRounds / 2], ns[1][kRounds / 2]};
}

driver::Result<std::vector<driver::TickRecord>> trace_of(const std::filesystem::path& scene,
                                                         const Adjust& adjust) {
  auto session = open_with(scene, adjust);
  if (!session) return session.error();
  const std::atomic<bool> stop{false};
  (*session)->run(stop);
  const auto rows = (*session)->trace().rows();
  return std::vector<driver::TickRecord>(rows.begin(), rows.end());
}

std::optional<double> instructions_per_tick_of(const std::string& kind,
                                               const std::filesystem::path& scene, double ticks) {
  const auto counts = count_subject("gating/" + kind + "/" + scene.string());
  if (!counts || counts->size() != 1) return std::nullopt;
  return counts->front() / ticks;
}

}  // namespace

driver::Result<GatingReport> decide_gating(const std::filesystem::path& scene, bool count) {
  auto session = open_with(scene, {});
  if (!session) return session.error();
  if ((*session)->simulation() == nullptr) return driver::Error{"The arm is not simulated."};
  const double ticks = static_cast<double>((*session)->ticks_planned());
  const std::atomic<bool> stop{false};
  (*session)->run(stop);
  const auto full = (*session)->trace().rows();
  const Seen seen = look_at(full, 1 / (*session)->scene().rate);
  GatingReport report;
  report.force = seen.force_rms;
  report.decisions = decide((*session)->scene(), seen);
  // Each effect alone, whatever was decided: the check on the rule.
  for (GateDecision& one : report.decisions) {
    if (!one.changes) continue;
    const auto rows = trace_of(scene, [&](Scene& changed) { leave_out(one.name, changed); });
    if (!rows) return rows.error();
    one.change = compare(full, *rows);
    // Rules look at sizes; only the run knows what a hand makes of them.
    if (one.left_out && !(*one.change <= kShareFelt)) {
      one.left_out = false;
      one.rule += "; it is, but the check below says no";
    }
  }
  const Adjust reduced = without(report.decisions);
  const auto rows = trace_of(scene, reduced);
  if (!rows) return rows.error();
  report.change = compare(full, *rows);
  report.holds = report.change <= kShareFelt;
  const auto times = time_both(scene, reduced);
  if (!times) return times.error();
  report.full_ns = times->first;
  report.reduced_ns = times->second;
  if (count) {
    report.full_instructions = instructions_per_tick_of("full", scene, ticks);
    report.reduced_instructions = instructions_per_tick_of("reduced", scene, ticks);
  }
  return report;
}

std::string gating_text(const GatingReport& report) {
  std::string text;
  for (const GateDecision& one : report.decisions) {
    text += one.effect + ": " + (one.left_out ? "may be left out" : "is needed") + ". " + one.rule +
            ".";
    if (one.change) {
      text += " Without it alone the force changes by " + three_digits(100 * *one.change) + " %.";
    }
    text += "\n";
  }
  text += numbers("\nWithout all that may be left out the force (%.2f N) changes by %.2f %%: ",
                  report.force, 100 * report.change);
  text += report.holds ? "less than can be felt, the choice holds.\n"
                       : "more than can be felt, this scene needs the full model.\n";
  const bool saves =
      std::any_of(report.decisions.begin(), report.decisions.end(),
                  [](const GateDecision& one) { return one.left_out && one.changes; });
  if (!saves) text += "This scene calls for every effect that costs anything: nothing is saved.\n";
  text += numbers("A whole tick takes %.0f ns, or %.0f ns without them", report.full_ns,
                  report.reduced_ns);
  if (report.full_instructions && report.reduced_instructions) {
    text += numbers("; %.0f instructions, or %.0f without", *report.full_instructions,
                    *report.reduced_instructions);
  }
  return text + ".\n";
}

std::vector<Figure> figures_of(const GatingReport& report) {
  std::vector<Figure> figures;
  for (const GateDecision& one : report.decisions) {
    figures.push_back({.name = one.effect + ": may be left out",
                       .value = one.left_out ? 1.0 : 0.0,
                       .unit = "",
                       .goal = {}});
    if (one.change) {
      figures.push_back({.name = one.effect + ": change of force without",
                         .value = 100 * *one.change,
                         .unit = "%",
                         .goal = one.left_out ? "<= 3.5" : ""});
    }
  }
  figures.push_back({.name = "all that may be left out: change of force",
                     .value = 100 * report.change,
                     .unit = "%",
                     .goal = "<= 3.5"});
  figures.push_back(
      {.name = "full model: time", .value = report.full_ns, .unit = "ns/tick", .goal = {}});
  figures.push_back(
      {.name = "reduced model: time", .value = report.reduced_ns, .unit = "ns/tick", .goal = {}});
  if (report.full_instructions && report.reduced_instructions) {
    figures.push_back({.name = "full model: instructions",
                       .value = *report.full_instructions,
                       .unit = "per tick",
                       .goal = {}});
    figures.push_back({.name = "reduced model: instructions",
                       .value = *report.reduced_instructions,
                       .unit = "per tick",
                       .goal = {}});
  }
  return figures;
}

bool probe_gating(const std::string& subject) {
  const auto slash = subject.find('/');
  if (slash == std::string::npos) return false;
  const std::filesystem::path scene = subject.substr(slash + 1);
  Adjust adjust;
  if (subject.substr(0, slash) == "reduced") {
    const auto report = decide_gating(scene, false);
    if (!report) return false;
    adjust = without(report->decisions);
  }
  auto session = open_with(scene, adjust);
  if (!session) return false;
  const std::atomic<bool> stop{false};
  thimble_probed_stroke([&] {
    (*session)->run(stop);
    return 0.0;
  });
  return true;
}

}  // namespace thimble::app
