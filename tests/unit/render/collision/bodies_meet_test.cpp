#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include "body/motion/move_object.h"
#include "collision/collider_of.h"
#include "collision/collision_world.h"
#include "support/meshes/shapes.h"

namespace thimble::render {
namespace {
using Eigen::Vector3d;

struct Maker {
  std::vector<CollisionWorld::Member> members;
  SolverPlan plan;
  std::vector<SpringJoint> springs;
  void body(TriangleMesh mesh, MotionChoice choice, CollisionChoice collision, const Primitive* shape = nullptr) {
    const auto floor = std::exchange(choice.floor, std::nullopt);
    auto motion = rigid_motion_of(mesh, choice);
    ASSERT_TRUE(motion) << motion.error().message;
    const auto& mass = motion->body().settings().mass;
    auto set = collider_of({&mesh, shape}, collision, PlaceOfBody{mass.q_WB.toRotationMatrix(), mass.p_WC});
    ASSERT_TRUE(set);
    plan.bodies.push_back({mass.mass, mass.inertia, choice.kind == MotionKind::kRigid, *set, floor});
    members.push_back({*motion, choice.kind == MotionKind::kRigid});
  }
  std::shared_ptr<CollisionWorld> build(double step) {
    plan.step = step;
    auto w = CollisionWorld::build(members, plan, springs, 1);
    EXPECT_TRUE(w);
    return *w;
  }
};
TriangleMesh moved(TriangleMesh m, Vector3d p) { for (auto& v : m.vertices) v += p; return m; }

TEST(Explore, Elastic) {
  for (double e : {1.0, 0.5, 0.0}) for (double h : {4e-3, 1e-3, 2.5e-4}) {
    Maker m; Sphere s1{{0,0,0},0.02}, s2{{0.1,0,0},0.02};
    Primitive p1 = s1, p2 = s2;
    m.body(support::icosphere(3, 0.02), {.kind=MotionKind::kRigid,.mass=0.1,.v_W={0.8,0,0}}, {.restitution=e}, &p1);
    m.body(moved(support::icosphere(3, 0.02),{0.1,0,0}), {.kind=MotionKind::kRigid,.mass=0.2}, {.restitution=e}, &p2);
    auto w = m.build(h);
    for (double t = 0; t < 0.3; t += h) w->step(h);
    std::printf("e %g h %g v %.6f %.6f expect %.6f %.6f  gap %.3g x1 %.6f\n", e, h, w->motion(0).body().v_WC().x(), w->motion(1).body().v_WC().x(),
      0.8*(0.1-e*0.2)/0.3, 0.1*(1+e)*0.8/0.3, (w->motion(1).body().p_WC()-w->motion(0).body().p_WC()).norm()-0.04, w->motion(0).body().p_WC().x());
  }
}
TEST(Explore, Slide) {
  for (double h : {4e-3, 1e-3, 2.5e-4}) {
    Maker m; 
    m.body(support::box({0.03,0.02,0.01}), {.kind=MotionKind::kRigid,.mass=0.1,.gravity_W={0,0,-9.81},.floor=Floor{{0,0,1},-0.01,0.3},.v_W={0.5,0,0}}, {});
    auto w = m.build(h);
    for (double t = 0; t < 0.5; t += h) { Vector3d v0 = w->motion(0).body().v_WC(); w->step(h); if (t<0.006) std::printf("   dv %.4g %.4g w %.4g contacts %lu\n", (w->motion(0).body().v_WC()-v0).x()/h/9.81/0.3, (w->motion(0).body().v_WC()).z(), w->motion(0).body().omega_W().norm(), w->solver().counters().contacts); }
    std::printf("slide h %g x %.6f expect %.6f z %.3g v %.3g\n", h, w->motion(0).body().p_WC().x(), 0.5*0.5/2/0.3/9.81, w->motion(0).body().p_WC().z(), w->motion(0).body().v_WC().norm());
  }
}
TEST(Explore, Stack) {
  for (auto shape : {CollisionShape::kHull, CollisionShape::kBox}) {
    Maker m; 
    for (int i = 0; i < 10; ++i)
      m.body(moved(support::box({0.01,0.01,0.01}),{0,0,0.02*i+0.01}), {.kind=MotionKind::kRigid,.mass=0.01,.gravity_W={0,0,-9.81},.floor=Floor{{0,0,1},0,0.5}}, {.shape=shape});
    auto w = m.build(1e-3);
    auto t0 = std::chrono::steady_clock::now();
    for (int t = 0; t < 20000; ++t) { w->step(1e-3);
      if (t % 4000 == 100) { double worst = 0, vz=0; for (int i = 0; i < 10; ++i) { worst = std::max(worst, (w->motion(i).body().p_WC()-Vector3d(0,0,0.02*i+0.01)).norm()); vz=std::max(vz,w->motion(i).body().v_WC().norm());} std::printf("stack t %d off %.3g mm v %.3g\n", t, 1e3*worst, vz); } }
    std::printf("us per step %.1f contacts %g\n", std::chrono::duration<double>(std::chrono::steady_clock::now()-t0).count()/20000*1e6, double(w->solver().counters().contacts)/20000);
  }
}
TEST(Explore, Pendulum) {
  for (double h : {4e-3, 1e-3, 2.5e-4}) {
    Maker m; 
    m.body(moved(support::box({0.005,0.005,0.05}),{0,0,-0.05}), {.kind=MotionKind::kRigid,.mass=0.1,.gravity_W={0,0,-9.81},.omega_W={0,0.5,0}}, {.shape=CollisionShape::kNone});
    JointChoice j; j.kind = JointKind::kHinge; j.axis_W = {0,1,0}; j.p_W = {0,0,0};
    m.plan.joints.push_back({j, 0, -1});
    m.members[0].motion.body().set_momentum(0.1*Vector3d(-0.025,0,0), m.members[0].motion.body().angular_momentum_W());
    auto w = m.build(h);
    double last = -1; int crossings = 0; double first=0, tl=0; double e0 = w->energy_for(0); double far=0;
    for (double t = 0; t < 5; t += h) { double x0 = w->motion(0).body().p_WC().x(); w->step(h); double x1 = w->motion(0).body().p_WC().x();
      if (x0 < 0 && x1 >= 0) { double tc = t + h*(-x0)/(x1-x0); if (crossings++ == 0) first = tc; tl = tc; }
      far = std::max(far, std::abs((w->motion(0).p_WB()).norm())); }
    double I = 0.1*(0.01*0.01*1+0.1*0.1)/12 + 0.1*0.05*0.05; double T = 2*M_PI*std::sqrt(I/(0.1*9.81*0.05)); double amp = 0.5*std::sqrt(I/(0.1*9.81*0.05));
    std::printf("pendulum h %g T %.6f expect %.6f (amp %.2f) energy %.3g of %.3g anchor off %.3g\n", h, (tl-first)/(crossings-1), T*(1+amp*amp/16), amp, w->energy_for(0)-e0, I*0.25/2, far);
  }
}
}
}
