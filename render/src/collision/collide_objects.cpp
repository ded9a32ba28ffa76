#include "collision/collide_objects.h"

#include <fmt/core.h>

#include <utility>

#include "body/motion/held_touch.h"
#include "body/motion/moving_touch.h"
#include "collision/collider_surface.h"
#include "collision/colliding_motion.h"
#include "collision/collision_world.h"

namespace thimble::render {
namespace {

/// Returns the shapes of all objects for drawing. `body_of` has the number of each object's body,
/// -1 if it does not move. Takes the shapes out of the plan, which the solver has copied.
std::shared_ptr<const CollisionSurfaces> surfaces_of(const std::vector<CollidingObject>& objects,
                                                     const std::vector<int>& body_of,
                                                     const CollisionWorld& world,
                                                     SolverPlan& plan) {
  std::vector<PlacedColliders> placed;
  auto fixed_W = plan.fixed_W.begin();
  for (std::size_t i = 0; i < objects.size(); ++i) {
    PlacedColliders& one = placed.emplace_back();
    if (body_of[i] < 0) {
      one.set = std::move(*fixed_W++);
    } else {
      const auto number = static_cast<std::size_t>(body_of[i]);
      const RigidBody& body = world.motion(number).body();
      one.set = std::move(plan.bodies[number].shape_B);
      one.place = {.R_WB = body.q_WB().toRotationMatrix(), .p_WB = body.p_WC()};
    }
    one.own = collides_as_touched(objects[i].solid, objects[i].collision, one.set);
    if (one.own) one.set.shapes.clear();
  }
  return collision_surfaces(std::move(placed));
}

driver::Error named(const CollidingObject& object, const driver::Error& error) {
  return driver::Error{object.name + ": " + error.message};
}

/// Returns a sentence for each pair of objects that overlap.
std::vector<std::string> overlaps_of(const std::vector<CollidingObject>& objects,
                                     const std::vector<int>& body_of, CollisionSolver& solver) {
  std::vector<const CollidingObject*> moving, fixed;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    (body_of[i] < 0 ? fixed : moving).push_back(&objects[i]);
  }
  std::vector<std::string> notes;
  for (const SolverOverlap& one : solver.overlaps()) {
    const std::string other = one.other >= 0   ? moving[static_cast<std::size_t>(one.other)]->name
                              : one.fixed >= 0 ? fixed[static_cast<std::size_t>(one.fixed)]->name
                                               : "its floor";
    notes.push_back(fmt::format(
        "{} and {} overlap by {:.3g} mm at the begin, and will be moved apart. Place them apart, "
        "or set collision: {{shape: none}} for one of them.",
        moving[static_cast<std::size_t>(one.body)]->name, other, 1e3 * one.depth));
  }
  return notes;
}

/// Adds a sentence if the masses of two bodies that may touch differ too much for the solver.
void note_masses(const std::vector<CollidingObject>& objects, const std::vector<int>& body_of,
                 const SolverPlan& plan, std::vector<std::string>& notes) {
  constexpr double kRatio = 100;  // a body of 1 kg sinks into one of 1 g below it [measured]
  const CollidingObject *light = nullptr, *heavy = nullptr;
  double least = 0, most = 0;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (body_of[i] < 0) continue;
    const SolverBody& body = plan.bodies[static_cast<std::size_t>(body_of[i])];
    if (body.shape_B.shapes.empty()) continue;
    if (light == nullptr || body.mass < least) {
      light = &objects[i];
      least = body.mass;
    }
    if (heavy == nullptr || body.mass > most) {
      heavy = &objects[i];
      most = body.mass;
    }
  }
  if (light == nullptr || !(most > kRatio * least)) return;
  notes.push_back(
      fmt::format("{} has {:.3g} times the mass of {}. A body of more than {:g} times the mass of "
                  "one that it rests on or pulls at sinks into it, or opens the joint. Choose "
                  "masses that are nearer to each other.",
                  heavy->name, most / least, light->name, kRatio));
}

}  // namespace

driver::Result<CollidingTouches> collide_objects(std::vector<CollidingObject> objects,
                                                 const std::vector<ObjectJoint>& joints,
                                                 const CollisionQuality& quality,
                                                 std::size_t hands) {
  SolverPlan plan{.bodies = {}, .fixed_W = {}, .joints = {}, .quality = quality};
  std::vector<CollisionWorld::Member> members;
  std::vector<int> body_of;  // of each object; -1 if it does not move
  std::vector<CollidingObject*> moving;
  for (CollidingObject& object : objects) {
    if (!object.motion) {
      auto set = collider_of(object.solid, object.collision, {});
      if (!set) return named(object, set.error());
      plan.fixed_W.push_back(std::move(set).value());
      body_of.push_back(-1);
      continue;
    }
    const MotionChoice& choice = *object.motion;
    if (choice.time_scale != 1) {
      return named(object, driver::Error{"a body that collides cannot have a time_scale; remove "
                                         "it, or set collision: {shape: none}"});
    }
    auto added = add_body(object.solid, object.collision, choice, plan, members);
    if (!added) return named(object, added.error());
    plan.step = object.coupling.step;
    body_of.push_back(static_cast<int>(moving.size()));
    moving.push_back(&object);
  }
  std::vector<SpringJoint> springs;
  for (const ObjectJoint& joint : joints) {
    const auto number = [&](int i) { return i < 0 ? -1 : body_of[static_cast<std::size_t>(i)]; };
    const int a = number(joint.a), b = number(joint.b);
    if (a < 0 && b < 0) {
      return driver::Error{
          "A joint needs at least one object that moves; add body: {motion: "
          "{mass: ...}} to it."};
    }
    if (joint.choice.kind == JointKind::kSpring) {
      springs.push_back(spring_of(joint.choice, a, b));
    } else {
      plan.joints.push_back({joint.choice, a, b});
    }
  }
  auto world = CollisionWorld::build(std::move(members), plan, std::move(springs), hands);
  if (!world) return world.error();
  std::vector<std::string> notes = overlaps_of(objects, body_of, (*world)->solver());
  note_masses(objects, body_of, plan, notes);
  CollidingTouches result{.touches = {},
                          .bodies = *world,
                          .surfaces = surfaces_of(objects, body_of, **world, plan),
                          .notes = std::move(notes)};
  for (std::size_t body = 0; body < moving.size(); ++body) {
    CollidingObject& object = *moving[body];
    auto& own = result.touches.emplace_back();
    for (std::size_t hand = 0; hand < hands; ++hand) {
      own.push_back(moving_touch(std::move(object.surfaces[hand]),
                                 CollidingMotion(*world, body, hand), *object.motion,
                                 object.coupling));
    }
  }
  return result;
}

}  // namespace thimble::render
