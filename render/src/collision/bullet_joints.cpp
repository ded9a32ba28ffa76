#include "collision/bullet_joints.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "collision/bullet_units.h"

namespace thimble::render {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Returns a rotation that turns `own` to an axis.
Matrix3d frame_along(const Vector3d& axis, const Vector3d& own) {
  return Eigen::Quaterniond::FromTwoVectors(own, axis.normalized()).toRotationMatrix();
}

std::unique_ptr<btTypedConstraint> hinge_of(const JointChoice& choice, const JointEnd& a,
                                            const JointEnd& b, const btTransform& in_a,
                                            const btTransform& in_b, double torque_scale) {
  auto hinge = std::make_unique<btHingeConstraint>(a.body, b.body, in_a, in_b);
  if (choice.limits) {
    hinge->setLimit((*choice.limits)[0], (*choice.limits)[1], 1, 0.3, 0);
  } else {
    hinge->setLimit(1, -1);
  }
  if (choice.speed || choice.friction > 0) {
    const double torque = choice.speed ? choice.motor_max : choice.friction;
    hinge->enableAngularMotor(true, choice.speed.value_or(0), torque_scale * torque);
  }
  return hinge;
}

std::unique_ptr<btTypedConstraint> slider_of(const JointChoice& choice, const JointEnd& a,
                                             const JointEnd& b, const btTransform& in_a,
                                             const btTransform& in_b, double scale) {
  auto slider = std::make_unique<btSliderConstraint>(b.body, a.body, in_b, in_a, true);
  slider->setLowerLinLimit(choice.limits ? scale * (*choice.limits)[0] : 1);
  slider->setUpperLinLimit(choice.limits ? scale * (*choice.limits)[1] : -1);
  slider->setLowerAngLimit(0);
  slider->setUpperAngLimit(0);
  slider->setDampingDirLin(0);
  slider->setDampingLimLin(1);
  if (choice.speed || choice.friction > 0) {
    slider->setPoweredLinMotor(true);
    slider->setTargetLinMotorVelocity(scale * choice.speed.value_or(0));
    slider->setMaxLinMotorForce(scale * (choice.speed ? choice.motor_max : choice.friction));
  }
  return slider;
}

}  // namespace

std::unique_ptr<btTypedConstraint> joint_of(const JointChoice& choice, const JointEnd& a,
                                            const JointEnd& b, double scale, double step) {
  const Matrix3d R =
      choice.kind == JointKind::kHinge    ? frame_along(choice.axis_W, Vector3d::UnitZ())
      : choice.kind == JointKind::kSlider ? frame_along(choice.axis_W, Vector3d::UnitX())
                                          : Matrix3d(Matrix3d::Identity());
  const btTransform at_W = transform_of(R, scale * choice.p_W);
  const btTransform in_a = a.place.inverseTimes(at_W), in_b = b.place.inverseTimes(at_W);
  switch (choice.kind) {
    case JointKind::kHinge:
      // Bullet takes an impulse per step.
      return hinge_of(choice, a, b, in_a, in_b, scale * scale * step);
    case JointKind::kSlider:
      return slider_of(choice, a, b, in_a, in_b, scale);
    case JointKind::kBall:
      return std::make_unique<btPoint2PointConstraint>(a.body, b.body, in_a.getOrigin(),
                                                       in_b.getOrigin());
    case JointKind::kFixed:
      return std::make_unique<btFixedConstraint>(a.body, b.body, in_a, in_b);
    case JointKind::kSpring:
      break;
  }
  return nullptr;
}

}  // namespace thimble::render
