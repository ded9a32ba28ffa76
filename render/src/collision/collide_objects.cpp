#include "collision/collide_objects.h"

#include <utility>

#include "body/motion/held_touch.h"
#include "body/motion/moving_touch.h"
#include "collision/colliding_motion.h"
#include "collision/collision_world.h"

namespace thimble::render {
namespace {

driver::Error named(const CollidingObject& object, const driver::Error& error) {
  return driver::Error{object.name + ": " + error.message};
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
  CollidingTouches result{.touches = {}, .bodies = *world};
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
