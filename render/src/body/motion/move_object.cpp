#include "body/motion/move_object.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "body/motion/body_motions.h"
#include "body/motion/held_touch.h"
#include "body/motion/support_points.h"

namespace thimble::render {
namespace {

using Moved = driver::Result<std::unique_ptr<ObjectTouch>>;

// Bounds of a scene's numbers catch misplaced decimal points and values in g or mm.
constexpr double kMassMin = 1e-4;         // kg
constexpr double kMassMax = 1e3;          // kg
constexpr double kDensityMin = 0.1;       // kg/m^3, a tenth of air's
constexpr double kDensityMax = 3e4;       // kg/m^3, above osmium's 2.26e4
constexpr double kAccelerationMax = 100;  // m/s^2
constexpr double kDampingMax = 1e3;       // N s/m, N m s
constexpr double kTimeScaleMin = 1e-3;
constexpr double kTimeScaleMax = 100;
constexpr double kPositionMax = 2;        // m
constexpr double kSpeedMax = 10;          // m/s
constexpr double kAngularSpeedMax = 100;  // rad/s
constexpr double kFrictionMax = 10;
constexpr double kHoldMax = 1e5;       // N/m
constexpr double kHoldForceMax = 100;  // N

// Half of these points on a round rim give sides of 11 degrees.
constexpr std::size_t kStandOn = RigidBody::kSupportMax;

/// Returns an error if a hand cannot hold with these settings.
driver::Result<void> check_grip(const MotionChoice& choice) {
  if (!choice.grip) return {};
  const Grip& grip = *choice.grip;
  // Written so that NaN is refused.
  if (!(grip.stiffness > 0 && grip.damping >= 0 && grip.force_max > 0) ||
      !std::isfinite(grip.stiffness + grip.damping + grip.force_max)) {
    return driver::Error{
        "A hand that holds a body needs a stiffness and a force above 0, and a damping."};
  }
  return {};
}

// GCC 12 for ARM treats the storage of an empty optional floor as read.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
TranslatingMotion three_ways(const TriangleMesh& mesh_W, const MotionChoice& choice, double mass,
                             const BodyCoupling& coupling) {
  TranslatingBody body(mass, choice.damping, choice.time_scale, coupling.step);
  body.set_velocity(choice.v_W / choice.time_scale);
  TranslatingMotion::Settings settings{
      .mass = mass, .gravity_W = choice.gravity_W, .floor = choice.floor, .reach = choice.reach};
  if (choice.floor) {
    settings.lowest = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector3d& p : mesh_W.vertices) {
      settings.lowest = std::min(settings.lowest, choice.floor->n_W.dot(p));
    }
  }
  return TranslatingMotion(body, settings);
}
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic pop
#endif

using AnyMotion = std::variant<TranslatingMotion, RigidMotion>;

/// Returns the motion of an object. Errors: as `move_object`.
driver::Result<AnyMotion> motion_of(const TriangleMesh& mesh_W, const MotionChoice& choice,
                                    const BodyCoupling& coupling) {
  // The numbers are checked for both kinds.
  auto rigid = rigid_motion_of(mesh_W, choice);
  if (!rigid) return rigid.error();
  if (choice.kind == MotionKind::kTranslate) {
    return AnyMotion(three_ways(mesh_W, choice, rigid->body().settings().mass.mass, coupling));
  }
  return AnyMotion(std::move(rigid).value());
}

}  // namespace

driver::Result<double> mass_of(const TriangleMesh& mesh_W, const MotionChoice& choice) {
  if (!choice.density) return choice.mass;
  const auto unit = mass_properties(mesh_W, 1);
  if (!unit) return unit.error();
  const double mass = *choice.density * unit->volume;
  // Written so that NaN is refused.
  if (!(mass >= kMassMin && mass <= kMassMax)) {
    return driver::Error{fmt::format(
        "A density of {:g} kg/m^3 gives a mass of {:.3g} kg; expected {:g} to {:g} kg. Check the "
        "size of the mesh ({:.3g} cm^3), or set mass.",
        *choice.density, mass, kMassMin, kMassMax, 1e6 * unit->volume)};
  }
  return mass;
}

driver::Result<RigidMotion> rigid_motion_of(const TriangleMesh& mesh_W, const MotionChoice& choice,
                                            const Eigen::Matrix3d* axes_W) {
  if (!(choice.reach >= 0)) return driver::Error{"The reach of a body must be 0 m or more."};
  if (!choice.v_W.allFinite() || !choice.omega_W.allFinite()) {
    return driver::Error{"The initial velocities of a body must be finite."};
  }
  const auto kg = mass_of(mesh_W, choice);
  if (!kg) return kg.error();
  auto mass = mass_properties(mesh_W, *kg);
  if (!mass) return mass.error();
  if (axes_W != nullptr) prefer_axes(*axes_W, *mass);
  RigidBodySettings settings{.mass = *mass,
                             .gravity_W = choice.gravity_W,
                             .damping = choice.damping,
                             .angular_damping = choice.angular_damping,
                             .time_scale = choice.time_scale,
                             .floor = choice.floor,
                             .support_B = {}};
  if (choice.floor) {
    for (const Eigen::Vector3d& p : support_points(mesh_W, kStandOn)) {
      settings.support_B.push_back(mass->q_WB.conjugate() * (p - mass->p_WC));
    }
  }
  auto body = RigidBody::build(settings);
  if (!body) return body.error();
  if (auto held = check_grip(choice); !held) return held.error();
  const Eigen::Vector3d omega_B = mass->q_WB.conjugate() * choice.omega_W;
  body->set_momentum(*kg * choice.v_W / choice.time_scale,
                     mass->q_WB * mass->inertia.cwiseProduct(omega_B) / choice.time_scale);
  return RigidMotion(*body, choice.reach);
}

void MotionChoice::read(SettingsReader& reader) {
  std::size_t ways = 0;
  reader.choice("kind", ways, {"translate", "rigid"});
  kind = static_cast<MotionKind>(ways);
  if (reader.has("density")) {
    density = 0;
    reader.number("density", *density, {.unit = "kg/m^3", .min = kDensityMin, .max = kDensityMax});
    reader.explain_unused("mass", "cannot be combined with density");
  } else {
    reader.number("mass", mass, {.unit = "kg", .min = kMassMin, .max = kMassMax, .required = true});
  }
  reader.vector("gravity", gravity_W,
                {.unit = "m/s^2", .min = -kAccelerationMax, .max = kAccelerationMax});
  reader.number("damping", damping, {.unit = "N s/m", .min = 0, .max = kDampingMax});
  reader.number("time_scale", time_scale, {.unit = "", .min = kTimeScaleMin, .max = kTimeScaleMax});
  reader.vector("velocity", v_W, {.unit = "m/s", .min = -kSpeedMax, .max = kSpeedMax});
  if (reader.has("reach")) {
    reach = 0;
    reader.number("reach", reach, {.unit = "m", .min = 0, .max = kPositionMax});
  }
  if (reader.has("floor")) {
    floor.emplace();
    reader.number("floor", floor->height, {.unit = "m", .min = -kPositionMax, .max = kPositionMax});
    reader.number("floor_friction", floor->friction, {.unit = "", .min = 0, .max = kFrictionMax});
  } else if (reader.has("floor_friction")) {
    reader.reject("floor_friction", "needs floor, the height of the floor in m");
  }
  if (reader.has("hold")) {
    grip.emplace();
    reader.number("hold", grip->stiffness, {.unit = "N/m", .min = 1, .max = kHoldMax});
    reader.number("hold_damping", grip->damping, {.unit = "N s/m", .min = 0, .max = kDampingMax});
    reader.number("hold_force", grip->force_max, {.unit = "N", .min = 0.01, .max = kHoldForceMax});
  } else {
    for (const char* key : {"hold_damping", "hold_force"}) {
      reader.explain_unused(key, "needs hold, the stiffness of the grip in N/m");
    }
  }
  for (const char* key : {"angular_damping", "angular_velocity"}) {
    if (kind == MotionKind::kTranslate && reader.has(key)) {
      reader.reject(key, "is only for bodies that rotate; set kind: rigid");
    }
  }
  reader.number("angular_damping", angular_damping,
                {.unit = "N m s", .min = 0, .max = kDampingMax});
  reader.vector("angular_velocity", omega_W,
                {.unit = "rad/s", .min = -kAngularSpeedMax, .max = kAngularSpeedMax});
}

Moved move_object(std::unique_ptr<ObjectTouch> surface, const TriangleMesh& mesh_W,
                  const MotionChoice& choice, const BodyCoupling& coupling) {
  const auto motion = motion_of(mesh_W, choice, coupling);
  if (!motion) return motion.error();
  return std::visit(
      [&](const auto& own) {
        return Moved(moving_touch(std::move(surface), own, choice, coupling));
      },
      *motion);
}

driver::Result<SharedObject> move_shared_object(std::vector<std::unique_ptr<ObjectTouch>> surfaces,
                                                const TriangleMesh& mesh_W,
                                                const MotionChoice& choice,
                                                const BodyCoupling& coupling) {
  const auto motion = motion_of(mesh_W, choice, coupling);
  if (!motion) return motion.error();
  return std::visit(
      [&]<class Motion>(const Motion& own) {
        const auto body = std::make_shared<SharedBodyOf<Motion>>(own);
        SharedObject object{.touches = {}, .body = body};
        for (auto& surface : surfaces) {
          object.touches.push_back(moving_touch(
              std::move(surface), SharedMotion<Motion>(body, surfaces.size()), choice, coupling));
        }
        return driver::Result<SharedObject>(std::move(object));
      },
      *motion);
}

}  // namespace thimble::render
