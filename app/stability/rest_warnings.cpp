#include "stability/rest_warnings.h"

#include <fmt/core.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "body/motion/move_object.h"
#include "math/elementary.h"
#include "mesh/contact_mesh.h"
#include "mesh/smooth_normals.h"
#include "meshes/object_mesh.h"
#include "stability/draw.h"
#include "stability/tuning.h"

namespace thimble::stability {
namespace {

using Eigen::Vector3d;

constexpr double kFelt = 0.02;  // N RMS [PHYSICS 6]
constexpr double kDegree = std::numbers::pi / 180;
constexpr double kPressed = 1;   // N, force of a resting hand [chosen]
constexpr double kCreep = 1e-3;  // m/s: at lower speeds, a count takes 30 ms and more
constexpr double kStroke = 0.1;  // m/s; slower oscillations are always there [chosen]
constexpr double kProbe = 1e-6;  // m
constexpr int kTries = 4000;     // points of a texture; finds a sine's curvature within 2 %

/// Effect of a field, found by evaluation.
struct FieldTried {
  double push = 0;     // N, on a tip at rest
  double damping = 0;  // N s/m
};

FieldTried try_field(const scene::SceneObject& object, const scene::ArmFile& arm) {
  FieldTried found;
  const auto field = object.build_field();
  for (const Vector3d& p_W : scene::points_of_workspace(arm, 7)) {
    driver::DeviceState state;
    state.p_WT = p_W;
    const Vector3d at_rest = field->update(state).f_T_W;
    found.push = std::max(found.push, at_rest.norm());
    state.v_WT = {0.01, 0, 0};
    found.damping = std::max(found.damping, -(field->update(state).f_T_W - at_rest).x() / 0.01);
  }
  return found;
}

bool bends(const scene::SceneObject& object) {
  return object.body.dent || object.body.shape.named();
}

bool is_flat(const scene::SceneObject& object) {
  const render::ContactChoice& contact = object.contact;
  if (contact.blending) return *contact.blending == render::BlendingChoice::kFlat;
  // These are smooth, or push towards a proxy.
  return contact.tracker != render::TrackerChoice::kOffset &&
         contact.tracker != render::TrackerChoice::kPacked &&
         contact.tracker != render::TrackerChoice::kGodObject;
}

void warn_of_facets(const scene::SceneObject& object, std::vector<std::string>& warnings) {
  if (object.mesh_file.empty() || object.paged) return;
  // Facets that the body bends are concave wherever it yields, with any tracker.
  const bool god_object = object.contact.tracker == render::TrackerChoice::kGodObject;
  const bool flat = is_flat(object);
  if (bends(object) && (flat || god_object)) {
    warnings.push_back(
        fmt::format("{} is deformable and has flat shading, so pressing it makes concave edges. A "
                    "tip that rests on such an edge jumps between facets. Set contact: {{blending: "
                    "phong}}, or tracker: compact.",
                    object.name));
    return;
  }
  // With all other trackers, both faces of a concave edge hold the tip at once.
  if (object.contact.tracker != render::TrackerChoice::kNormalProjection) return;
  const auto file = scene::load_object_mesh(object);
  if (!file) return;
  const auto mesh = render::ContactMesh::build(file->mesh_W);
  if (!mesh) return;
  // A jump of 2 F sin(angle / 2), back and forth, has half of it as its RMS.
  const double felt = 2 * math::asin(kFelt / kPressed);
  const double smooth_up_to = object.contact.crease_angle.value_or(render::kCreaseAngle);
  const double concave_angle =
      sharpest_concave_edge(*mesh, flat ? felt : std::max(felt, smooth_up_to));
  if (!(concave_angle > 0)) return;
  warnings.push_back(
      fmt::format("{} has concave edges of up to {:.0f} degrees and flat shading there. On such "
                  "an edge, each encoder count makes the force jump sideways by {:.2g} N per "
                  "newton pressed. Choose another tracker.",
                  object.name, concave_angle / kDegree, 2 * math::sin(concave_angle / 2)));
}

/// Returns the mass of a body, kg; 0 if its mesh cannot be read.
double mass_of(const scene::SceneObject& object) {
  const render::MotionChoice& motion = *object.body.motion;
  if (!motion.density) return motion.mass;
  const auto inside = [&](const render::TriangleMesh& mesh_W) {
    const auto mass = render::mass_of(mesh_W, motion);
    return mass ? *mass : 0;
  };
  if (object.shape) return inside(object.shape->mesh_W());
  const auto file = scene::load_object_mesh(object);
  return file ? inside(file->mesh_W) : 0;
}

/// Limits of a loop with the hand of the scene.
struct Loop {
  const scene::Scene& scene;
  scene::LoopTimes times;

  double edge(double damping) const {
    return stability_limits(scene.arms.front().arm, times, 0, damping).stiffness_exact;
  }
};

void warn_of_effects(const scene::SceneObject& object, const Loop& loop, double bare_edge,
                     std::vector<std::string>& warnings) {
  const double force = loop.scene.arms.front().arm.limits.force_max;
  for (const render::EffectPlan& effect : object.effects) {
    if (effect.kind->group == "texture") {
      const double curvature = curvature_of(effect);
      const double from = bare_edge / curvature;
      if (!(from < force)) continue;
      warnings.push_back(fmt::format(
          "{}: its texture adds {:.0f} N/m along the surface per newton pressed. Above "
          "{:.2g} N that exceeds the {:.0f} N/m that are stable with this arm, loop and "
          "hand, and the tip oscillates in the grooves. Reduce amplitude / wavelength^2.",
          object.name, curvature, from, bare_edge));
    } else if (effect.kind->group == "friction") {
      const double hold = hold_of(effect);
      // The arm's own dry friction stops slow oscillations [PHYSICS 1.4].
      const StabilityLimits carried =
          stability_limits(loop.scene.arms.front().arm, loop.times, 0, 0);
      const double held_speed = oscillation_speed_limit(
          hold, carried.damping, loop.scene.arms.front().arm.simulated.plant.coulomb,
          carried.latency);
      if (!(hold > bare_edge && held_speed < kStroke)) continue;
      warnings.push_back(fmt::format(
          "{}: its friction has a stiffness of {:.0f} N/m, but with this hand ({:.3g} N "
          "s/m) the loop is stable up to {:.0f} N/m. Set the friction's stiffness to "
          "{:.0f} N/m or less.",
          object.name, hold, loop.scene.arms.front().arm.simulated.hand.damping, bare_edge,
          0.7 * bare_edge));
    } else if (effect.kind->group == "law") {
      const double added = effect.build()->spring_stiffness(), edge = loop.edge(object.damping);
      if (!(added > 0 && object.stiffness + added > edge)) continue;
      warnings.push_back(fmt::format(
          "{}: its formula adds up to {:.0f} N/m to the stiffness of {:.0f} N/m, but the loop is "
          "stable up to {:.0f} N/m with this arm and hand. Reduce one of them.",
          object.name, added, object.stiffness, edge));
    }
  }
}

/// Warns of a light body that a friction holds. Tip and body oscillate against each other, and the
/// hand damps that mode only by the tip's share in it.
///
/// With s = m / (m + m_tip) the tip's share, K L <= b_tip s^2 + b (1 - s)^2. A friction also turns
/// a free body; at its rim a ball counts as 1 / (1 + 5 / 2) of its mass.
void warn_of_light_body(const scene::SceneObject& object, const Loop& loop,
                        std::vector<std::string>& warnings) {
  if (!object.body.motion) return;
  const render::MotionChoice& motion = *object.body.motion;
  double hold = 0;
  for (const render::EffectPlan& effect : object.effects) {
    if (effect.kind->group == "friction") hold = std::max(hold, hold_of(effect));
  }
  const StabilityLimits carried = stability_limits(loop.scene.arms.front().arm, loop.times, 0, 0);
  const double mass = mass_of(object);
  if (!(mass > 0)) return;
  const double felt = motion.kind == render::MotionKind::kRigid ? mass / 3.5 : mass;
  const double share =
      felt / (felt + carried.tip.mass + loop.scene.arms.front().arm.simulated.hand.mass);
  const double damping =
      carried.damping * share * share + motion.damping * (1 - share) * (1 - share);
  if (!(hold * carried.latency > damping)) return;
  warnings.push_back(
      fmt::format("{} has a mass of {:.3g} kg and a friction of {:.0f} N/m. The hand hardly "
                  "damps the oscillation of such a light body, and the loop is stable up to "
                  "{:.0f} N/m. Increase its mass or damping, or reduce the friction's stiffness.",
                  object.name, mass, hold, damping / carried.latency));
}

/// Warns of springs that add up where a tip touches all of them, although each of them is stable by
/// itself.
void warn_of_sum(const Loop& loop, std::vector<std::string>& warnings) {
  double sum = 0, damping = 0;
  int count = 0;
  for (const scene::SceneObject& object : loop.scene.objects) {
    if (object.build_field || !(object.stiffness > 0)) continue;
    sum += object.stiffness;
    damping += object.damping;
    ++count;
  }
  if (count < 2 || !(sum > loop.edge(damping))) return;
  warnings.push_back(
      fmt::format("The stiffness of the {} surfaces sums to {:.0f} N/m, more than the {:.0f} N/m "
                  "that are stable with this arm, loop and hand. A tip inside all of them enters "
                  "a limit cycle. Keep them apart, or reduce their stiffness.",
                  count, sum, loop.edge(damping)));
}

void warn_of_quantisation_noise(const Loop& loop, std::vector<std::string>& warnings) {
  const scene::ArmFile& arm = loop.scene.arms.front().arm;
  const device_sim::HandSettings& hand = arm.simulated.hand;
  double surfaces = 0, fields = 0;
  for (const scene::SceneObject& object : loop.scene.objects) {
    if (object.build_field) {
      fields += try_field(object, arm).damping;
    } else {
      surfaces = std::max(surfaces, object.damping);
    }
  }
  const double step = scene::worst_over_workspace(arm).encoder_step;
  const double tremor =
      std::sqrt(2.0) * std::numbers::pi * hand.tremor_frequency * hand.tremor_amplitude;  // RMS
  const double speed = std::max(kCreep, tremor);
  const double noise = quantisation_noise_of(fields + surfaces, step, speed,
                                             arm.velocity_corner_frequency, loop.times.period);
  if (!(noise > kFelt)) return;
  warnings.push_back(
      fmt::format("The damping of this scene (up to {:.2g} N s/m) acts on encoder steps of "
                  "{:.0f} um. At {:.1f} mm/s (tremor, or a hand that comes to rest) that gives "
                  "{:.0f} mN of quantisation noise. Reduce the damping, or the arm's "
                  "velocity_corner_frequency.",
                  fields + surfaces, 1e6 * step, 1e3 * speed, 1e3 * noise));
}

}  // namespace

double curvature_of(const render::EffectPlan& texture) {
  const auto stage = texture.build();
  Draw draw(1);
  double max = 0;
  // Pressed so deep that the height itself is negligible: the force for each newton.
  const auto force = [&stage](const Vector3d& p_W, const Vector3d& n_W) -> Vector3d {
    driver::DeviceState state;
    state.p_WT = p_W;
    render::SurfaceResponse feel{
        .contact = {.touching = true, .triangle = 0, .depth = 1, .n_W = n_W, .p_WP = p_W + n_W}};
    stage->touch(state, feel);
    return feel.contact.depth * feel.contact.n_W;
  };
  for (int i = 0; i < kTries; ++i) {
    const Vector3d p_W = draw.in_box(0.05), n_W = draw.direction();
    const Vector3d u_W = n_W.cross(draw.direction()).normalized();
    const Vector3d change = force(p_W + kProbe * u_W, n_W) - force(p_W - kProbe * u_W, n_W);
    max = std::max(max, std::abs(change.dot(u_W)) / (2 * kProbe));
  }
  return max;
}

double hold_of(const render::EffectPlan& friction) {
  const auto stage = friction.build();
  const auto force_at = [&stage](double x, std::int64_t tick) {
    driver::DeviceState state;
    state.tick = static_cast<std::uint64_t>(tick);
    state.time_ns = tick * 1'000'000;
    state.dt = 1e-3;
    state.p_WT = {x, 0, -1e-3};
    state.fresh = true;
    render::SurfaceResponse feel{
        .contact = {.touching = true, .triangle = 0, .depth = 1e-3, .n_W = {0, 0, 1}}};
    feel.contact.p_WP = {x, 0, 0};
    feel.f_T_W = {0, 0, 10};  // so that nothing slips
    stage->touch(state, feel);
    return feel.f_T_W.x();
  };
  for (int tick = 0; tick < 20; ++tick) force_at(0, tick);
  return std::max(0.0, (force_at(0, 20) - force_at(kProbe, 21)) / kProbe);
}

double sharpest_concave_edge(const render::ContactMesh& mesh, double from) {
  double max = 0;
  for (std::int32_t t = 0; t < mesh.triangle_count(); ++t) {
    const render::TriangleCell& cell = mesh.cell(t);
    for (std::size_t k = 0; k < 3; ++k) {
      if (!mesh.concave_edge(t, k)) continue;
      // An edge plane leans back by half the angle.
      const double angle = 2 * math::asin(std::min(1.0, -mesh.edge_plane(t, k).n.dot(cell.face.n)));
      if (angle > from) max = std::max(max, angle);
    }
  }
  return max;
}

double quantisation_noise_of(double damping, double step, double speed, double corner,
                             double period) {
  if (!(step > 0)) return 0;
  const double p = std::min(0.5, speed * period / step);
  const double gain = corner > 0 ? -math::expm1(-2 * std::numbers::pi * corner * period) : 1;
  return damping * step / period * std::sqrt(p * (1 - p) * gain / (2 - gain));
}

std::vector<std::string> energy_warnings(const scene::Scene& scene) {
  std::vector<std::string> warnings;
  // The account of the passivity stage includes fields, weights and the energy that the motors
  // give.
  const driver::EnergyStage stage = scene.energy.value_or(scene.arms.front().arm.energy.stage);
  if (stage != driver::EnergyStage::kBounding) return warnings;
  constexpr double kPushFelt = 0.02;  // N [PHYSICS 6]
  const auto warn = [&warnings](const std::string& what, double push) {
    if (!(push > kPushFelt)) return;
    warnings.push_back(
        fmt::format("{} (up to {:.2g} N) although the hand does not press. The gate's energy bound "
                    "blocks that: it lets a force rise only while the hand presses. Set gate: "
                    "{{energy: passivity}} in the scene.",
                    what, push));
  };
  warn("The motors support the arm's weight", scene.arms.front().arm.max_carried_force);
  for (const scene::SceneObject& object : scene.objects) {
    if (object.build_field) {
      warn(object.name + " pushes the hand", try_field(object, scene.arms.front().arm).push);
    } else if (object.body.motion && object.body.motion->grip) {  // on the floor it does not pull
      warn(object.name + " pulls the hand down by its weight",
           mass_of(object) * object.body.motion->gravity_W.norm());
    }
  }
  return warnings;
}

std::vector<std::string> rest_causes(const scene::Scene& scene, const std::string& on) {
  std::vector<std::string> causes;
  if (!scene.arms.front().arm.can_simulate) return causes;  // its tip is unknown
  const Loop loop{scene, loop_times(scene.arms.front().arm, scene.rate)};
  const double bare_edge = loop.edge(0);
  for (const scene::SceneObject& object : scene.objects) {
    if (object.build_field || !(on.empty() || object.name == on)) continue;
    warn_of_facets(object, causes);
    warn_of_effects(object, loop, bare_edge, causes);
    warn_of_light_body(object, loop, causes);
  }
  warn_of_sum(loop, causes);
  warn_of_quantisation_noise(loop, causes);
  return causes;
}

std::vector<std::string> rest_warnings(const scene::Scene& scene, const RestTrial& trial) {
  std::vector<std::string> warnings;
  for (const Rest& rest : trial.rests) {
    if (rest.oscillation <= kRestFelt) continue;
    std::string warning = fmt::format(
        "At rest{} ({:.2f} s) the force oscillates by {:.3f} N RMS at {:.0f} Hz, of "
        "{:.2g} N; {:.2f} N or more can be felt.",
        rest.on.empty() ? "" : " on " + rest.on, rest.time, rest.oscillation, rest.frequency,
        rest.force, kRestFelt);
    const std::vector<std::string> causes = rest_causes(scene, rest.on);
    for (const std::string& cause : causes) warning += " " + cause;
    if (causes.empty()) warning += " Reduce the stiffness there, or add damping.";
    warnings.push_back(std::move(warning));
  }
  if (trial.fault != driver::Fault::kNone) {
    warnings.push_back(
        fmt::format("The simulated run ended with a fault: {}.", driver::describe(trial.fault)));
  }
  return warnings;
}

}  // namespace thimble::stability
