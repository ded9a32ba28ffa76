#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "body/motion/move_object.h"
#include "collision/collider_of.h"
#include "collision/collision_world.h"
#include "support/meshes/shapes.h"

namespace thimble::support {

/// Collects bodies and what they meet, without a surface to touch. W, SI units.
class MeetingBodies {
 public:
  /// Returns the settings of a rigid body.
  static render::MotionChoice rigid(double mass) {
    render::MotionChoice choice;
    choice.kind = render::MotionKind::kRigid;
    choice.mass = mass;
    return choice;
  }
  static constexpr double kGravity = 9.81;
  /// Returns the settings of a rigid body under gravity.
  static render::MotionChoice heavy(double mass) {
    render::MotionChoice choice = rigid(mass);
    choice.gravity_W = {0, 0, -kGravity};
    return choice;
  }

  /// Adds a mesh that moves, touched as `shape`, if given; returns its number.
  int add(const render::TriangleMesh& mesh_W, render::MotionChoice choice,
          const render::CollisionChoice& collision = {},
          const std::optional<render::Primitive>& shape = {}) {
    const auto floor = std::exchange(choice.floor, std::nullopt);
    const render::SolidToCollide solid{&mesh_W, shape ? &*shape : nullptr};
    const auto axes_W = render::axes_of(solid);
    const auto motion = render::rigid_motion_of(mesh_W, choice, axes_W ? &*axes_W : nullptr);
    EXPECT_TRUE(motion) << (motion ? "" : motion.error().message);
    const render::MassProperties& mass = motion->body().settings().mass;
    const bool turns = choice.kind == render::MotionKind::kRigid;
    const auto set = render::collider_of(
        solid, collision, render::PlaceOfBody{mass.q_WB.toRotationMatrix(), mass.p_WC});
    EXPECT_TRUE(set) << (set ? "" : set.error().message);
    plan_.bodies.push_back({.mass = mass.mass,
                            .inertia = mass.inertia,
                            .turns = turns,
                            .shape_B = *set,
                            .floor = floor});
    members_.push_back({*motion, turns});
    return static_cast<int>(members_.size()) - 1;
  }
  int add_sphere(const Eigen::Vector3d& p_W, double radius, const render::MotionChoice& choice,
                 const render::CollisionChoice& collision = {}) {
    render::TriangleMesh mesh = icosphere(3, radius);
    for (auto& p : mesh.vertices) p += p_W;
    return add(mesh, choice, collision, render::Primitive(render::Sphere{p_W, radius}));
  }
  int add_box(const Eigen::Vector3d& p_W, const Eigen::Vector3d& half,
              const render::MotionChoice& choice, const render::CollisionChoice& collision = {},
              const Eigen::Matrix3d& R_WO = Eigen::Matrix3d::Identity()) {
    render::TriangleMesh mesh = box(half);
    for (auto& p : mesh.vertices) p = p_W + R_WO * p;
    render::WedgeBox shape;
    shape.R_WO = R_WO;
    shape.p_WO = p_W;
    shape.half_sides = half;
    return add(mesh, choice, collision, render::Primitive(shape));
  }
  void add_fixed(const render::SolidToCollide& solid,
                 const render::CollisionChoice& collision = {}) {
    const auto set = render::collider_of(solid, collision, {});
    ASSERT_TRUE(set) << set.error().message;
    plan_.fixed_W.push_back(*set);
  }
  void add_joint(const render::JointChoice& choice, int a, int b = -1) {
    if (choice.kind != render::JointKind::kSpring) {
      plan_.joints.push_back({choice, a, b});
      return;
    }
    springs_.push_back({.a = a,
                        .b = b,
                        .p_A = choice.p_W,
                        .p_B = choice.p_end_W,
                        .stiffness = choice.stiffness,
                        .damping = choice.damping,
                        .length = choice.length.value_or((choice.p_end_W - choice.p_W).norm())});
  }
  render::RigidMotion& motion(int body) { return members_[static_cast<std::size_t>(body)].motion; }
  render::CollisionQuality& quality() { return plan_.quality; }

  std::shared_ptr<render::CollisionWorld> build(double step, std::size_t hands = 1) {
    plan_.step = step;
    auto world = render::CollisionWorld::build(members_, plan_, springs_, hands);
    EXPECT_TRUE(world) << (world ? "" : world.error().message);
    return *world;
  }

 private:
  std::vector<render::CollisionWorld::Member> members_;
  render::SolverPlan plan_;
  std::vector<render::SpringJoint> springs_;
};

}  // namespace thimble::support
