#pragma once

#include <btBulletDynamicsCommon.h>

#include <memory>

#include "thimble/render/body/joint_choice.h"

namespace thimble::render {

/// One end of a joint: a body, and its place when the joint is made, in Bullet's units.
struct JointEnd {
  btRigidBody& body;
  btTransform place;
};

/// Makes a joint for Bullet, of steps of `step` s; `scale` in its units per m. Null for a spring,
/// which is a force (CollisionWorld). Real-time: never from the servo thread.
std::unique_ptr<btTypedConstraint> joint_of(const JointChoice& choice, const JointEnd& a,
                                            const JointEnd& b, double scale, double step);

}  // namespace thimble::render
