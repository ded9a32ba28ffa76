#include "studies/accuracy/gating/gating_rules.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "object_sections.h"
#include "report/picture_style.h"

namespace thimble::studies {
namespace {

// [PHYSICS 6 and 8]
constexpr double kForceFelt = 0.02;  // N
constexpr double kLatencyShare = 0.05;

}  // namespace

bool is_felt(const driver::TickRecord& row) {
  return row.in_contact || report::length_of(row.f_sent_W) > 0;
}

RunObservations look_at(std::span<const driver::TickRecord> rows, double tick) {
  RunObservations seen;
  std::vector<double> accelerations;
  double squares = 0;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    if (!is_felt(rows[i])) continue;
    const double f = report::length_of(rows[i].f_sent_W);
    squares += f * f;
    seen.force_max = std::max(seen.force_max, f);
    seen.depth_max = std::max(seen.depth_max, rows[i].depth);
    std::array<double, 3> change{};
    for (std::size_t k = 0; k < 3; ++k) change[k] = rows[i].v_WT[k] - rows[i - 1].v_WT[k];
    accelerations.push_back(report::length_of(change) / tick);
  }
  if (accelerations.empty()) return seen;
  seen.force_rms = std::sqrt(squares / static_cast<double>(accelerations.size()));
  std::sort(accelerations.begin(), accelerations.end());
  seen.acceleration = accelerations[accelerations.size() * 99 / 100];
  return seen;
}

std::vector<GateDecision> decide(const scene::Scene& scene, const RunObservations& seen) {
  double stiffness = 0, damping = 0;
  bool friction = false;
  for (const scene::SceneObject& object : scene.objects) {
    stiffness = std::max(stiffness, object.stiffness);
    damping = std::max(damping, object.damping);
    for (const auto& plan : object.effects) friction = friction || plan.kind->group == "friction";
  }
  const auto context = scene::effect_context_of(scene.arms.front().arm, scene.rate);
  const auto& simulated = scene.arms.front().arm.simulated;
  std::vector<GateDecision> all;
  const double step = context.encoder_step;
  const double by_spring = stiffness * step;
  const double by_damper = damping * step / context.tick;
  all.push_back(
      {.effect = "steps of the encoders",
       .name = "quantisation",
       .rule =
           fmt::format("K step = {:.1f} mN and B step / T = {:.1f} mN; both must be at most 20 mN, "
                       "without friction",
                       1e3 * by_spring, 1e3 * by_damper) +
           (friction ? " (the scene has friction)" : " (the scene has none)"),
       .left_out = by_spring <= kForceFelt && by_damper <= kForceFelt && !friction});
  const double delay = context.delay;
  const double holds = simulated.plant.viscous + damping + simulated.hand.damping;
  all.push_back({.effect = "delay and jitter",
                 .name = "delay",
                 .rule = fmt::format(
                     "K (L - T/2) = {:.3f} N s/m; must be below 5 % of the total damping at the "
                     "tip, {:.3f} N s/m",
                     stiffness * delay, kLatencyShare * holds),
                 .left_out = stiffness * delay < kLatencyShare * holds});
  all.push_back({.effect = "dry friction of the arm",
                 .name = "coulomb",
                 .rule = fmt::format("c = {:.1f} mN; must be below {:.0f} mN",
                                     1e3 * simulated.plant.coulomb, 1e3 * kForceFelt),
                 .left_out = simulated.plant.coulomb < kForceFelt});
  const double inertia = simulated.plant.mass * seen.acceleration;
  all.push_back({.effect = "inertia of the arm",
                 .name = "inertia",
                 .rule = fmt::format("m a = {:.3f} N; must be below 3.5 % of the force, {:.3f} N",
                                     inertia, kShareFelt * seen.force_rms) +
                         "; kept, because the exact map costs the same with it",
                 .left_out = false,
                 .changes = false});
  all.push_back({.effect = "lag of the amplifiers",
                 .name = "amplifier",
                 .rule = "must be below 5 % of the latency; this simulator has no lag",
                 .left_out = true,
                 .changes = false});
  all.push_back({.effect = "saturation",
                 .name = "saturation",
                 .rule = fmt::format(
                     "K x = {:.2f} N at most; must be below the arm's {:.2f} N. The gate always "
                     "applies this limit",
                     stiffness * seen.depth_max, scene.arms.front().arm.limits.force_max),
                 .left_out = stiffness * seen.depth_max < scene.arms.front().arm.limits.force_max,
                 .changes = false});
  all.push_back({.effect = "model of the hand",
                 .name = "hand",
                 .rule = "kept, because it moves the tip in this scene; a replay needs none",
                 .left_out = false,
                 .changes = false});
  return all;
}

void leave_out(const std::string& name, scene::Scene& scene) {
  auto& simulated = scene.arms.front().arm.simulated;
  if (name == "quantisation") scene.arms.front().arm.simulated.firmware.ideal_encoders = true;
  if (name == "delay") simulated.wire.delay_in_ns = simulated.wire.delay_out_ns = 0;
  if (name == "coulomb") simulated.plant.coulomb = 0;
}

}  // namespace thimble::studies
