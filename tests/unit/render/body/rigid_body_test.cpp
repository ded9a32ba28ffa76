#include "body/motion/rigid_body.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "body/motion/free_turn.h"
#include "body/motion/mass_properties.h"
#include "body/motion/translating_body.h"
#include "support/hard_case.h"
#include "support/heap_guard.h"
#include "support/meshes/shapes.h"
#include "support/random.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;
using support::record_hard_case;

constexpr double kTick = 1e-3;

// Returns a closed block of 60 x 40 x 20 mm, moved and turned on request.
TriangleMesh block(const Vector3d& at = {0, 0, 0},
                   const Eigen::Quaterniond& turned = Eigen::Quaterniond::Identity()) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    const Vector3d corner((i & 1) != 0 ? 0.03 : -0.03, (i & 2) != 0 ? 0.02 : -0.02,
                          (i & 4) != 0 ? 0.01 : -0.01);
    mesh.vertices.push_back(at + turned * corner);
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

RigidBody body_of(const TriangleMesh& mesh, double mass) {
  RigidBodySettings settings;
  settings.mass = mass_properties(mesh, mass).value();
  return RigidBody::build(settings).value();
}

TEST(MassProperties, AreThoseOfABlockInAnyPose) {
  support::Random random(1);
  for (int i = 0; i < 50; ++i) {
    const Vector3d at = random.in_box(i < 25 ? 0.1 : 1e4);
    const Eigen::Quaterniond turned(Eigen::AngleAxisd{random.uniform(-3, 3), random.direction()});
    const auto found = mass_properties(block(at, turned), 0.3);
    ASSERT_TRUE(found);
    const double digits = i < 25 ? 1e-12 : 1e-7;
    EXPECT_NEAR(found->volume, 0.06 * 0.04 * 0.02, digits * 4.8e-5 * 100);
    EXPECT_LT((found->p_WC - at).norm(), digits);
    const Vector3d truth =
        0.3 / 12 *
        Vector3d(0.04 * 0.04 + 0.02 * 0.02, 0.06 * 0.06 + 0.02 * 0.02, 0.06 * 0.06 + 0.04 * 0.04);
    EXPECT_LT((found->inertia - truth).norm(), digits * 100 * truth.norm());
    // The axis of the smallest inertia is the longest side.
    const Vector3d long_axis = found->q_WB * Vector3d::UnitX();
    EXPECT_NEAR(std::abs(long_axis.dot(turned * Vector3d::UnitX())), 1, digits * 1e3);
  }
}

TEST(MassProperties, ApproachASphereAndRefuseZeroVolume) {
  const auto ball = mass_properties(support::icosphere(4, 0.05), 2);
  ASSERT_TRUE(ball);
  EXPECT_NEAR(ball->inertia[0], 0.4 * 2 * 0.05 * 0.05, 0.01 * 2e-3);
  EXPECT_NEAR(ball->inertia[0], ball->inertia[2], 1e-12);
  TriangleMesh turned = block();
  for (auto& triangle : turned.triangles) std::swap(triangle[0], triangle[1]);
  EXPECT_FALSE(mass_properties(turned, 1));
  TriangleMesh flat = block();
  for (Vector3d& p : flat.vertices) p.z() = 0;
  EXPECT_FALSE(mass_properties(flat, 1));
  EXPECT_FALSE(mass_properties(TriangleMesh(), 1));
  for (const double bad : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_FALSE(mass_properties(block(), bad));
  }
}

struct Elliptic {
  double sn, cn, dn;
};

// Returns Jacobi's functions for modulus k, by the arithmetic-geometric mean.
Elliptic jacobi(double u, double k) {
  double a[32], c[32];
  a[0] = 1;
  c[0] = k;
  double b = std::sqrt((1 - k) * (1 + k));
  int n = 0;
  while (std::abs(c[n]) > 1e-17 && n < 30) {
    a[n + 1] = (a[n] + b) / 2;
    c[n + 1] = (a[n] - b) / 2;
    b = std::sqrt(a[n] * b);
    ++n;
  }
  double phi = std::ldexp(a[n] * u, n);
  for (; n > 0; --n)
    phi = (phi + std::asin(std::clamp(c[n] * std::sin(phi) / a[n], -1.0, 1.0))) / 2;
  const double sn = std::sin(phi);
  return {sn, std::cos(phi), std::sqrt(1 - k * k * sn * sn)};
}

// Closed form of the free top in B, for I1 < I2 < I3 and L^2 > 2 E I2; w2 = 0 at t = 0.
struct FreeTop {
  double w1, w2, w3, rate, k;

  FreeTop(const Vector3d& inertia, double energy, double momentum) {
    const double i1 = inertia[0], i2 = inertia[1], i3 = inertia[2];
    const double l2 = momentum * momentum, e2 = 2 * energy;
    w1 = std::sqrt((e2 * i3 - l2) / (i1 * (i3 - i1)));
    w2 = std::sqrt((e2 * i3 - l2) / (i2 * (i3 - i2)));
    w3 = std::sqrt((l2 - e2 * i1) / (i3 * (i3 - i1)));
    rate = std::sqrt((i3 - i2) * (l2 - e2 * i1) / (i1 * i2 * i3));
    k = std::sqrt((i2 - i1) * (e2 * i3 - l2) / ((i3 - i2) * (l2 - e2 * i1)));
  }
  double period() const { return 4 * std::comp_ellint_1(k) / rate; }
};

// Spin about the middle axis, compared with the closed form.
TEST(HardCaseRigidBody, TumblesWithTheClosedFormPeriod) {
  double worst_period = 0, worst_energy = 0, worst_momentum = 0;
  for (const double tilt : {0.003, 0.03, 0.3}) {
    for (const double spin : {2.0, 20.0, 60.0}) {
      RigidBody body = body_of(block(), 0.3);
      const Vector3d inertia = body.settings().mass.inertia;
      // About the middle axis, slightly towards the third; w1 = 0 corresponds to sn at its end.
      const Vector3d omega(0, spin * std::cos(tilt), spin * std::sin(tilt));
      const Vector3d angular_B = inertia.cwiseProduct(omega);
      body.set_momentum({0, 0, 0}, body.q_WB() * angular_B);
      const double energy = body.kinetic_energy();
      const FreeTop top(inertia, energy, angular_B.norm());
      ASSERT_LT(top.k, 1);
      // The zeros of w2, a quarter and three quarters of the period in, determine the period.
      std::vector<double> zeros;
      double before = spin;
      double worst = 0;
      const Vector3d momentum = body.angular_momentum_W();
      for (int tick = 1; zeros.size() < 7 && tick < 400000; ++tick) {
        body.step(kTick);
        const double now = (body.q_WB().conjugate() * body.omega_W())[1];
        if (now * before < 0) zeros.push_back(kTick * (tick - now / (now - before)));
        before = now;
        worst = std::max(worst, std::abs(body.kinetic_energy() / energy - 1));
      }
      ASSERT_EQ(zeros.size(), 7u);
      const double period = (zeros[6] - zeros[0]) / 3;
      EXPECT_NEAR(period / top.period(), 1, 1e-3) << tilt << " " << spin;
      EXPECT_NEAR(zeros[0] / (top.period() / 4), 1, 1e-3) << tilt << " " << spin;
      EXPECT_LT((body.angular_momentum_W() - momentum).norm(), 1e-12 * momentum.norm());
      EXPECT_LT(worst, spin > 50 ? 1e-5 : 1e-6) << tilt << " " << spin;
      worst_period = std::max(worst_period, std::abs(period / top.period() - 1));
      worst_energy = std::max(worst_energy, worst);
      worst_momentum =
          std::max(worst_momentum, (body.angular_momentum_W() - momentum).norm() / momentum.norm());
    }
  }
  const char* const kSpins = "spin about the middle axis, 2 to 60 rad/s, 3 tilts";
  record_hard_case(36, kSpins, "<= error of the period", worst_period, 1e-3, "1");
  record_hard_case(36, kSpins, "<= drift of the angular momentum", worst_momentum, 1e-6, "1");
  record_hard_case(36, kSpins, "<= drift of the energy", worst_energy, 1e-5, "1");
}

TEST(HardCaseRigidBody, FollowsTheClosedForm) {
  double worst = 0;
  RigidBody body = body_of(block(), 0.3);
  const Vector3d inertia = body.settings().mass.inertia;
  const Vector3d start(5, 0, 12);  // w2 = 0: start of sn
  body.set_momentum({0, 0, 0}, body.q_WB() * inertia.cwiseProduct(start));
  const FreeTop top(inertia, body.kinetic_energy(), body.angular_momentum_W().norm());
  EXPECT_NEAR(top.w1, 5, 1e-9);
  EXPECT_NEAR(top.w3, 12, 1e-9);
  for (int tick = 1; tick <= 3000; ++tick) {
    body.step(kTick);
    const Elliptic at = jacobi(top.rate * kTick * tick, top.k);
    const Vector3d truth(top.w1 * at.cn, -top.w2 * at.sn, top.w3 * at.dn);
    const Vector3d omega = body.q_WB().conjugate() * body.omega_W();
    const Vector3d mirrored(truth[0], -truth[1], truth[2]);
    const double error = std::min((omega - truth).norm(), (omega - mirrored).norm()) / start.norm();
    ASSERT_LT(error, 1e-4) << tick;
    worst = std::max(worst, error);
  }
  record_hard_case(36, "3 s of tumbling", "<= spin off Jacobi's elliptic functions", worst, 1e-3,
                   "1");
}

TEST(RigidBody, TurnsWithOrderFour) {
  const auto error = [](double step) {
    RigidBody body = body_of(block(), 0.3);
    const Vector3d inertia = body.settings().mass.inertia;
    body.set_momentum({0, 0, 0}, body.q_WB() * inertia.cwiseProduct(Vector3d(5, 3, 12)));
    const auto turned = [&](double h) {
      RigidBody copy = body;
      for (int i = 0; i < static_cast<int>(std::lround(1 / h)); ++i) copy.step(h);
      return copy.q_WB();
    };
    return turned(step).angularDistance(turned(1e-4));
  };
  EXPECT_NEAR(std::log2(error(4e-3) / error(2e-3)), 4, 0.2);
}

// At any spin and any step.
TEST(HardCaseRigidBody, NeverSpinsItselfUp) {
  support::Random random(36);
  for (int i = 0; i < 100; ++i) {
    RigidBody body = body_of(block(), 0.3);
    const double size = std::pow(10, random.uniform(-6, 3));
    const Vector3d angular = size * random.direction();
    body.set_momentum({0, 0, 0}, angular);
    const double most = angular.squaredNorm() / (2 * body.settings().mass.inertia[0]);
    for (int tick = 0; tick < 500; ++tick) {
      body.step(30e-3);
      ASSERT_LE(body.kinetic_energy(), most * (1 + 1e-9));
      ASSERT_LT((body.angular_momentum_W() - angular).norm(), 1e-12 * size);
      ASSERT_NEAR(body.q_WB().norm(), 1, 1e-12);
    }
  }
}

TEST(RigidBody, FallsAndRestsOnItsFloor) {
  for (const double friction : {0.0, 0.4}) {
    RigidBodySettings settings;
    const TriangleMesh mesh = block(
        {0, 0, 0.08}, Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Vector3d(1, 2, 0.3).normalized())));
    settings.mass = mass_properties(mesh, 0.2).value();
    settings.gravity_W = {0, 0, -9.81};
    settings.floor = Floor{.friction = friction};
    for (const Vector3d& p : mesh.vertices) {
      settings.support_B.push_back(settings.mass.q_WB.conjugate() * (p - settings.mass.p_WC));
    }
    RigidBody body = RigidBody::build(settings).value();
    body.set_momentum({0.05, 0, 0}, {0, 0, 0});
    const double energy = body.kinetic_energy() + body.potential_energy();
    double most = energy;
    for (int tick = 0; tick < 6000; ++tick) {
      body.step(kTick);
      most = std::max(most, body.kinetic_energy() + body.potential_energy());
    }
    EXPECT_LE(most, energy * 1.001);
    // Flat on one of its sides. The largest side is the most likely, and an edge is impossible.
    const double height = body.p_WC().z();
    EXPECT_LT(std::min({std::abs(height - 0.01), std::abs(height - 0.02), std::abs(height - 0.03)}),
              1e-4);
    EXPECT_LT(body.omega_W().norm(), 1e-3);
    EXPECT_LT(std::abs(body.v_WC().z()), 1e-6);
    if (friction > 0) {
      EXPECT_LT(body.v_WC().norm(), 1e-6);
      const Vector3d before = body.p_WC();
      for (int tick = 0; tick < 1000; ++tick) body.step(kTick);
      EXPECT_LT((body.p_WC() - before).norm(), 1e-5);
    }
  }
}

TEST(RigidBody, FallsAndFadesByTheLaws) {
  RigidBodySettings settings;
  settings.mass = mass_properties(block(), 0.3).value();
  settings.gravity_W = {0, 0, -9.81};
  RigidBody falling = RigidBody::build(settings).value();
  for (int i = 0; i < 500; ++i) falling.step(kTick);
  EXPECT_NEAR(falling.p_WC().z(), -9.81 / 2 * 0.25, 1e-12);
  settings.gravity_W.setZero();
  settings.damping = 0.6;
  settings.angular_damping = 1e-4;
  RigidBody fading = RigidBody::build(settings).value();
  fading.set_momentum({0.3, 0, 0}, {0, 0, 1e-3});
  for (int i = 0; i < 1000; ++i) fading.step(kTick);
  EXPECT_NEAR(fading.momentum_W().x(), 0.3 * std::exp(-2.0), 1e-12);
  EXPECT_NEAR(fading.angular_momentum_W().z(), 1e-3 * std::exp(-1e-4 / settings.mass.inertia[2]),
              1e-12);
  settings.damping = 1e12;
  settings.angular_damping = 1e12;
  RigidBody stuck = RigidBody::build(settings).value();
  stuck.set_momentum({1, 0, 0}, {1, 0, 0});
  stuck.step(kTick);
  EXPECT_EQ(stuck.kinetic_energy(), 0);
}

// The torque is -c omega about every axis; compared with Euler's equations in small RK4 steps.
TEST(RigidBody, TumblesToRestByItsDampingTorque) {
  RigidBodySettings settings;
  settings.mass = mass_properties(block(), 0.3).value();
  settings.angular_damping = 5e-5;
  RigidBody body = RigidBody::build(settings).value();
  const Vector3d inertia = settings.mass.inertia;
  Vector3d omega(6, 9, -7);
  body.set_momentum({0, 0, 0}, body.q_WB() * inertia.cwiseProduct(omega));
  const auto rate = [&](const Vector3d& w) -> Vector3d {
    const Vector3d torque = -settings.angular_damping * w - w.cross(inertia.cwiseProduct(w));
    return torque.cwiseQuotient(inertia);
  };
  constexpr double kFine = 1e-5;  // s
  double energy = body.kinetic_energy();
  for (int tick = 0; tick < 1300; ++tick) {
    for (int i = 0; i < 100; ++i) {
      const Vector3d k1 = rate(omega), k2 = rate(omega + kFine / 2 * k1);
      const Vector3d k3 = rate(omega + kFine / 2 * k2), k4 = rate(omega + kFine * k3);
      omega += kFine / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    }
    body.step(kTick);
    const Vector3d found = body.q_WB().conjugate() * body.omega_W();
    ASSERT_LT((found - omega).norm(), 1e-5 * 13) << tick;
    ASSERT_LE(body.kinetic_energy(), energy);
    energy = body.kinetic_energy();
  }
}

// Two equal inertias leave one part of the splitting, and the step has no error.
TEST(FreeTurn, IsExactForABodyWithAnAxisOfSymmetry) {
  for (const Vector3d& inertia : {Vector3d(1e-4, 2e-4, 2e-4), Vector3d(2e-4, 2e-4, 3e-4)}) {
    const int odd = inertia[0] < inertia[1] ? 0 : 2;
    Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
    const Vector3d angular(2e-3, -1e-3, 1.5e-3);
    const double step = 7e-3;
    for (int i = 0; i < 200; ++i) FreeTurn(inertia).turn(step, angular, q);
    const double time = 200 * step;
    const double own = (1 / inertia[odd] - 1 / inertia[1]) * angular[odd] * time;
    const Eigen::Quaterniond truth =
        Eigen::AngleAxisd(angular.norm() / inertia[1] * time, angular.normalized()) *
        Eigen::AngleAxisd(own, Vector3d::Unit(odd));
    EXPECT_LT(q.angularDistance(truth), 1e-12) << inertia.transpose();
  }
}

// [BP 4.3]: with less time per tick the same force moves the body as if its mass were 1 / s^2.
TEST(TimeScale, MakesABodyHeavierByItsSquare) {
  for (const double s : {0.1, 0.5, 1.0, 2.0}) {
    RigidBodySettings settings;
    settings.mass = mass_properties(block(), 0.3).value();
    settings.time_scale = s;
    RigidBody body = RigidBody::build(settings).value();
    TranslatingBody mover(0.3, 0, s, kTick);
    const Vector3d f(0.2, -0.1, 0.05);
    for (int i = 0; i < 300; ++i) {
      body.push(f, body.p_WC());
      mover.push(f);
      body.step(kTick);
      mover.step();
    }
    const Vector3d truth = f / (0.3 / (s * s)) * 0.3 * 0.3 / 2;
    EXPECT_LT((body.p_WC() - truth).norm(), 1e-9 * truth.norm());
    EXPECT_LT((mover.p_W() - truth).norm(), 1e-9 * truth.norm());
    EXPECT_LT((body.velocity_at(body.p_WC()) - truth * 2 / 0.3).norm(), 1e-9);
  }
}

TEST(TranslatingBody, BalancesItsMomentumAndNeverDiverges) {
  support::Random random(20);
  for (const double mass : {1e-6, 1e-3, 1.0}) {
    TranslatingBody body(mass, 0, 1, kTick);
    Vector3d given(0, 0, 0);
    double size = 0;
    for (int i = 0; i < 1000; ++i) {
      const Vector3d f = random.in_box(3);
      body.push(f);
      body.step();
      given += kTick * f;
      size += kTick * f.norm();
    }
    EXPECT_LT((body.momentum_W() - given).norm(), 1e-9 * size);
  }
  // Viscous liquid: the speed is bounded by force over damping at any step.
  for (const double step : {1e-4, 1e-2, 10.0}) {
    TranslatingBody body(1e-6, 50, 1, step);
    for (int i = 0; i < 100; ++i) {
      body.push({1, 0, 0});
      body.step();
      ASSERT_LE(body.v_W().x(), 1 / 50.0 * (1 + 1e-12));
    }
  }
  const double nan = std::numeric_limits<double>::quiet_NaN();
  TranslatingBody still(nan, 0, 1, kTick);
  still.push({1, 0, 0});
  still.step();
  EXPECT_EQ(still.p_W().norm(), 0);
  TranslatingBody body(1, 0, 1, kTick);
  body.push({nan, 0, 0});
  body.step();
  EXPECT_EQ(body.p_W().norm(), 0);
}

TEST(RigidBody, RefusesOrSurvivesInvalidInput) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  RigidBodySettings good;
  good.mass = mass_properties(block(), 0.3).value();
  EXPECT_TRUE(RigidBody::build(good));
  for (const double bad : {nan, 0.0, -1.0}) {
    RigidBodySettings settings = good;
    settings.mass.mass = bad;
    EXPECT_FALSE(RigidBody::build(settings));
    settings = good;
    settings.mass.inertia[1] = bad;
    EXPECT_FALSE(RigidBody::build(settings));
    settings = good;
    settings.time_scale = bad;
    EXPECT_FALSE(RigidBody::build(settings));
    settings = good;
    settings.floor = Floor{.n_W = {0, 0, 2 * bad}};
    EXPECT_FALSE(RigidBody::build(settings)) << bad;
    if (bad == 0) continue;
    settings = good;
    settings.damping = bad;
    EXPECT_FALSE(RigidBody::build(settings));
    settings = good;
    settings.angular_damping = bad;
    EXPECT_FALSE(RigidBody::build(settings));
  }
  RigidBodySettings crowded = good;
  crowded.support_B.assign(RigidBody::kSupportMax + 1, Vector3d::Zero());
  EXPECT_FALSE(RigidBody::build(crowded));
  RigidBody body = RigidBody::build(good).value();
  body.push({nan, 0, 0}, {0, 0, 0});
  body.push({1, 0, 0}, {0, nan, 0});
  body.step(kTick);
  body.step(nan);
  body.step(-1);
  EXPECT_EQ(body.p_WC(), good.mass.p_WC);
  EXPECT_EQ(body.kinetic_energy(), 0);
}

TEST(RigidBody, DoesNotAllocate) {
  RigidBodySettings settings;
  settings.mass = mass_properties(block(), 0.3).value();
  settings.floor = Floor{};
  settings.support_B = block().vertices;
  RigidBody body = RigidBody::build(settings).value();
  EXPECT_EQ(support::heap_calls_of([&] {
              for (int i = 0; i < 10; ++i) {
                body.push({0, 0, 0.1}, {0, 0, 0});
                body.step(kTick);
              }
            }),
            0);
}

}  // namespace
}  // namespace thimble::render
