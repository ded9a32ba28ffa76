#include "thimble/render/body/move_object.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "thimble/render/body/body_motions.h"
#include "thimble/render/body/moving_touch.h"
#include "thimble/render/body/support_points.h"

namespace thimble::render {
namespace {

using Moved = driver::Result<std::unique_ptr<ObjectTouch>>;

// More points to stand on cost time in every tick near the floor; a round rim of this many stands
// as if it were whole to 1 % of its radius. [chosen]
constexpr std::size_t kStandOn = 24;

Moved move_three_ways(std::unique_ptr<ObjectTouch> surface, const TriangleMesh& mesh_W,
                      const MotionChoice& choice, const BodyCoupling& coupling) {
  TranslatingBody body(choice.mass, choice.damping, choice.time_scale, coupling.step);
  body.set_velocity(choice.v_W / choice.time_scale);
  TranslatingMotion::Settings settings{.mass = choice.mass,
                                       .gravity_W = choice.gravity_W,
                                       .floor = choice.floor,
                                       .reach = choice.reach};
  if (choice.floor) {
    settings.lowest = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector3d& p : mesh_W.vertices) {
      settings.lowest = std::min(settings.lowest, choice.floor->n_W.dot(p));
    }
  }
  return Moved(std::make_unique<MovingTouch<TranslatingMotion>>(
      std::move(surface), TranslatingMotion(body, settings), coupling));
}

}  // namespace

Moved move_object(std::unique_ptr<ObjectTouch> surface, const TriangleMesh& mesh_W,
                  const MotionChoice& choice, const BodyCoupling& coupling) {
  if (!(choice.reach >= 0)) return driver::Error{"A body's reach must be 0 m or more."};
  if (!choice.v_W.allFinite() || !choice.omega_W.allFinite()) {
    return driver::Error{"A body's speed at first must be finite."};
  }
  const auto mass = mass_properties(mesh_W, choice.mass);
  if (!mass) return mass.error();
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
  // The numbers have been found right for both kinds.
  if (choice.kind == MotionKind::kTranslate) {
    return move_three_ways(std::move(surface), mesh_W, choice, coupling);
  }
  const Eigen::Vector3d omega_B = mass->q_WB.conjugate() * choice.omega_W;
  body->set_momentum(choice.mass * choice.v_W / choice.time_scale,
                     mass->q_WB * mass->inertia.cwiseProduct(omega_B) / choice.time_scale);
  return Moved(std::make_unique<MovingTouch<RigidMotion>>(
      std::move(surface), RigidMotion(*body, choice.reach), coupling));
}

}  // namespace thimble::render
