#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <vector>

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
  int add(const render::TriangleMesh& mesh_W, const render::MotionChoice& choice,
          const render::CollisionChoice& collision = {},
          const std::optional<render::Primitive>& shape = {}) {
    const render::SolidToCollide solid{&mesh_W, shape ? &*shape : nullptr};
    const auto added = render::add_body(solid, collision, choice, plan_, members_);
    EXPECT_TRUE(added) << (added ? "" : added.error().message);
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
    springs_.push_back(render::spring_of(choice, a, b));
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
