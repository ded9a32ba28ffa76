#include "body/spring/spring_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

#include "body/spring/mesh_springs.h"
#include "body/spring/modal_motion.h"
#include "support/contact_walk.h"
#include "support/hard_case.h"
#include "support/heap_guard.h"
#include "support/long_form.h"
#include "support/meshes/body_meshes.h"
#include "support/meshes/shapes.h"
#include "support/seed.h"

namespace thimble::render {
namespace {

using Beyond = SpringMotionOptions::Beyond;

SpringMotionOptions with(SpringScheme scheme, double step, Beyond beyond = Beyond::kAllow) {
  SpringMotionOptions options;
  options.scheme = scheme;
  options.step = step;
  options.beyond = beyond;
  return options;
}

// Returns a sheet with a fixed frame: a membrane. Dampers are proportional to the springs.
SpringNetwork<1> sheet(std::int32_t n, double relaxation) {
  const double k = 1000;
  const MeshSpringSettings settings{1e-3, k, relaxation * k, k, relaxation * k};
  return support::join_heights(support::triangle_sheet(n, 5e-3), settings);
}

double growth(const SpringNetwork<1>& network, SpringScheme scheme, double step, int steps) {
  auto motion = SpringMotion<1>::build(network, with(scheme, step)).value();
  support::throw_nodes(motion, 1e-3, 0, 4);
  const double before = motion.energy();
  double most = 0;
  for (int i = 0; i < steps; ++i) {
    motion.step();
    const double now = motion.energy();
    if (!(now < 1e30 * before)) return std::numeric_limits<double>::infinity();
    most = std::max(most, now / before);
  }
  return most;
}

TEST(HardCaseStepLimit, ExplicitMotionIsBoundedBelowIt) {
  double most = 0, least = std::numeric_limits<double>::infinity();
  const auto below = [&most](double found) {
    most = std::max(most, found);
    return found;
  };
  const auto above = [&least](double found) {
    least = std::min(least, found);
    return found;
  };
  const SpringNetwork<1> free = sheet(8, 0);
  const SpringNetwork<1> damped = sheet(8, 2e-4);
  for (const SpringScheme scheme : {SpringScheme::kSymplecticEuler, SpringScheme::kVerlet}) {
    const double limit = largest_step(scheme, free.bounds());
    // Near the limit these conserve an energy that the true one may exceed by 1 / (1 - 0.98).
    EXPECT_LT(below(growth(free, scheme, 0.98 * limit, 3000)), 60) << name_of(scheme);
    EXPECT_GT(above(growth(free, scheme, 1.02 * limit, 3000)), 1e6) << name_of(scheme);
  }
  for (const SpringScheme scheme : {SpringScheme::kExplicitEuler, SpringScheme::kSymplecticEuler}) {
    const double limit = largest_step(scheme, damped.bounds());
    EXPECT_LT(below(growth(damped, scheme, 0.98 * limit, 3000)), 60) << name_of(scheme);
    EXPECT_GT(above(growth(damped, scheme, 1.02 * limit, 3000)), 1e6) << name_of(scheme);
  }
  EXPECT_LT(growth(damped, SpringScheme::kVerlet,
                   0.98 * largest_step(SpringScheme::kVerlet, damped.bounds()), 3000),
            60);
  EXPECT_EQ(largest_step(SpringScheme::kExplicitEuler, free.bounds()), 0);
  const double undamped = growth(free, SpringScheme::kExplicitEuler, 1e-5, 20000);
  EXPECT_GT(undamped, 10);
  support::record_hard_case(30, "sheet of 64 nodes, three explicit schemes, 0.98 h_max, 3000 steps",
                            "<= largest energy over the first", most, 60, "1");
  support::record_hard_case(30, "the same at 1.02 h_max", "> least of them, energy over the first",
                            std::min(least, 1e12), 1e6, "1");
  support::record_hard_case(30, "guard: explicit Euler without damping, 10 us",
                            "> energy over the first", std::min(undamped, 1e12), 10, "1");
}

TEST(HardCaseStepLimit, ImplicitMotionIsBoundedAt100Times) {
  double most = 0;
  for (const double relaxation : {0.0, 2e-5}) {
    const SpringNetwork<1> network = sheet(8, relaxation);
    const double limit = largest_step(SpringScheme::kVerlet, network.bounds());
    for (const SpringScheme scheme : {SpringScheme::kImplicitEuler, SpringScheme::kTrapezoid}) {
      const double found = growth(network, scheme, 100 * limit, 3000);
      EXPECT_LE(found, 1 + 1e-9) << name_of(scheme);
      most = std::max(most, found);
    }
  }
  support::record_hard_case(30, "implicit Euler and trapezoid at 100 h_max",
                            "<= growth of the energy", most - 1, 1e-9, "1");
}

template <int kDof>
void expect_passive(SpringScheme scheme, double stiffness, double step, int rounds, bool pushed,
                    std::uint64_t seed) {
  SpringMotionOptions options = with(scheme, step);
  options.rounds_max = rounds;
  auto motion = SpringMotion<kDof>::build(
                    support::wild_network<kDof>(30, stiffness, seed % 3 == 0, seed), options)
                    .value();
  support::throw_nodes(motion, 1e-3, 1, seed);
  support::Random random(seed);
  double before = motion.energy();
  const double start = before;
  double given = 0;
  for (int i = 0; i < 100; ++i) {
    using Vector = typename SpringMotion<kDof>::Vector;
    const auto node = static_cast<std::int32_t>(random.bits() % 30);
    const Vector f =
        pushed ? Vector::Constant(random.uniform(-5, 5)).eval() : Vector::Zero().eval();
    const Vector from = motion.u()[static_cast<std::size_t>(node)];
    motion.push(node, f);
    motion.step();
    const double work = f.dot(motion.u()[static_cast<std::size_t>(node)] - from);
    given += std::abs(work);
    const double now = motion.energy();
    ASSERT_LE(now, before + work + 1e-10 * (start + given))
        << name_of(scheme) << " k " << stiffness << " h " << step << " rounds " << rounds;
    before = now;
  }
}

// Checks the proof in the header for any number of rounds, so that the bound on work does not
// reduce stability.
TEST(SpringMotion, NeverGainsMoreThanTheWorkDone) {
  std::uint64_t seed = 0;
  for (const SpringScheme scheme : {SpringScheme::kImplicitEuler, SpringScheme::kTrapezoid}) {
    for (const double stiffness : {1.0, 1e4, 1e8, 1e12}) {
      for (const double step : {1e-6, 1e-3, 30e-3, 10.0}) {
        for (const int rounds : {1, 2, 5, 25}) {
          expect_passive<1>(scheme, stiffness, step, rounds, seed % 2 == 0, support::seed_of(seed));
          expect_passive<3>(scheme, stiffness, step, rounds, seed % 2 == 1, support::seed_of(seed));
          ++seed;
        }
      }
    }
  }
}

TEST(HardCaseMembrane, SymplecticStepsKeepTheEnergy) {
  const int steps = support::long_form() ? 1000000 : 30000;
  const SpringNetwork<1> network = sheet(8, 0);
  const double step = 0.1 / network.bounds().omega_max;
  for (const SpringScheme scheme : {SpringScheme::kSymplecticEuler, SpringScheme::kVerlet}) {
    auto motion = SpringMotion<1>::build(network, with(scheme, step)).value();
    support::throw_nodes(motion, 1e-3, 0, 4);
    // Averages over windows, because these schemes oscillate about the energy that they conserve.
    const auto average = [&] {
      double sum = 0;
      for (int i = 0; i < 1000; ++i) {
        motion.step();
        sum += motion.energy() / 1000;
      }
      return sum;
    };
    const double first = average();
    for (int i = 0; i < steps; ++i) motion.step();
    const double drift = std::abs(average() / first - 1);
    EXPECT_LE(drift, 0.01) << name_of(scheme);
    support::record_hard_case(31, std::string(name_of(scheme)) + ", 3e4 steps (long form: 1e6)",
                              "<= drift of the energy", drift, 0.01, "1");
  }
}

TEST(HardCaseMembrane, ImplicitEulerFadesByItsLaw) {
  double worst = 0;
  // A single mode decays by 1 / sqrt(1 + w^2 h^2) per step.
  const std::vector<BodyNode> nodes{{1e-3, 0, 0}, {1e-3, 0, 0}};
  const std::vector<BodySpring<1>> springs{{0, 1, 500, 0}};
  const double omega = std::sqrt(2 * 500 / 1e-3);
  const auto network = SpringNetwork<1>::build(nodes, springs).value();
  EXPECT_NEAR(network.bounds().omega_max, omega, 1e-6 * omega);
  for (const double phase : {0.01, 0.1, 1.0, 5.0}) {
    SpringMotionOptions options = with(SpringScheme::kImplicitEuler, phase / omega);
    options.remainder = 1e-12;
    auto motion = SpringMotion<1>::build(network, options).value();
    motion.place(0, SpringMotion<1>::Vector(1e-3), SpringMotion<1>::Vector(0));
    motion.place(1, SpringMotion<1>::Vector(-1e-3), SpringMotion<1>::Vector(0));
    const double before = motion.energy();
    const int steps = 100;
    for (int i = 0; i < steps; ++i) motion.step();
    const double per_step = std::pow(motion.energy() / before, 0.5 / steps);
    EXPECT_NEAR(per_step, 1 / std::sqrt(1 + phase * phase), 1e-6) << phase;
    worst = std::max(worst, std::abs(per_step * std::sqrt(1 + phase * phase) - 1));
  }
  support::record_hard_case(31, "implicit Euler, w h = 0.01 to 5",
                            "<= error of the fading per step", worst, 0.01, "1");
}

TEST(SpringMotion, FreeBodyKeepsItsMomentum) {
  const MeshSpringSettings settings{1e-3, 0, 0, 300, 0.01, true};
  const auto network = join_vertices(support::icosphere(1, 0.03), settings).value();
  for (const SpringScheme scheme :
       {SpringScheme::kExplicitEuler, SpringScheme::kSymplecticEuler, SpringScheme::kVerlet,
        SpringScheme::kImplicitEuler, SpringScheme::kTrapezoid}) {
    SpringMotionOptions options = with(scheme, 1e-4);
    options.remainder = 1e-14;
    options.rounds_max = 100;
    auto motion = SpringMotion<3>::build(network, options).value();
    support::throw_nodes(motion, 1e-4, 0.1, 9);
    const auto momentum = [&] {
      Eigen::Vector3d sum(0, 0, 0);
      for (const Eigen::Vector3d& v : motion.v()) sum += 1e-3 * v;
      return sum;
    };
    const Eigen::Vector3d before = momentum();
    double speed = 0;
    for (const Eigen::Vector3d& v : motion.v()) speed += 1e-3 * v.norm();
    for (int i = 0; i < 200; ++i) motion.step();
    EXPECT_LT((momentum() - before).norm(), 1e-11 * speed) << name_of(scheme);
  }
}

TEST(SpringMotion, UsesSubstepsOrRefusesWithTheLimit) {
  const SpringNetwork<1> network = sheet(8, 0);
  const auto refused =
      SpringMotion<1>::build(network, with(SpringScheme::kVerlet, 5e-3, Beyond::kRefuse));
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("is stable for steps up to 0."), std::string::npos)
      << refused.error().message;
  auto motion =
      SpringMotion<1>::build(network, with(SpringScheme::kVerlet, 5e-3, Beyond::kSubstep)).value();
  EXPECT_GT(motion.substeps(), 1);
  EXPECT_LT(5e-3 / motion.substeps(), largest_step(SpringScheme::kVerlet, network.bounds()));
  EXPECT_NE(motion.describe().find("verlet is stable for steps up to 0."), std::string::npos);
  support::throw_nodes(motion, 1e-3, 0, 4);
  const double before = motion.energy();
  for (int i = 0; i < 1000; ++i) motion.step();
  EXPECT_LT(motion.energy(), 60 * before);
  EXPECT_FALSE(SpringMotion<1>::build(network, with(SpringScheme::kVerlet, 1, Beyond::kSubstep)));
  EXPECT_FALSE(
      SpringMotion<1>::build(network, with(SpringScheme::kExplicitEuler, 1e-3, Beyond::kSubstep)));
  EXPECT_FALSE(SpringMotion<1>::build(network, with(SpringScheme::kExponential, 1e-3)));
  EXPECT_FALSE(SpringMotion<1>::build(network, with(SpringScheme::kModal, 1e-3)));
  for (const double bad : {0.0, -1e-3, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_FALSE(SpringMotion<1>::build(network, with(SpringScheme::kImplicitEuler, bad)));
  }
  const auto by_default = SpringMotion<1>::build(network, {});
  ASSERT_TRUE(by_default);
  EXPECT_EQ(by_default->substeps(), 1);
}

TEST(SpringMotion, InvalidForceIsTakenAsZero) {
  auto motion = SpringMotion<1>::build(sheet(4, 0), {}).value();
  motion.push(3, SpringMotion<1>::Vector(std::numeric_limits<double>::quiet_NaN()));
  motion.push(4, SpringMotion<1>::Vector(std::numeric_limits<double>::infinity()));
  motion.push(5, SpringMotion<1>::Vector(1e30));
  motion.step();
  EXPECT_EQ(motion.energy(), 0);
}

TEST(SpringMotion, IsExactWhereNothingJoinsTheNodes) {
  const std::vector<BodyNode> nodes{{1e-6, 1e5, 0.01}, {1e-2, 10, 0}, {1e-3, 0, 0.3}};
  const auto network = SpringNetwork<3>::build(nodes, {}).value();
  auto motion = SpringMotion<3>::build(network, with(SpringScheme::kExponential, 1e-3)).value();
  auto modal = ModalMotion<3>::build(network, 1e-3).value();
  const Eigen::Vector3d f(1, -2, 0.5);
  for (std::int32_t i = 0; i < 3; ++i) {
    motion.push(i, f);
    modal.push(i, f);
  }
  motion.step();
  modal.step();
  for (std::int32_t i = 0; i < 3; ++i) {
    const BodyNode& node = nodes[static_cast<std::size_t>(i)];
    Eigen::Vector3d u(0, 0, 0);
    Eigen::Vector3d v(0, 0, 0);
    OscillatorStep::of(node.mass, node.base_stiffness, node.base_damping, 1e-3).apply(u, v, f);
    EXPECT_LT((motion.u()[static_cast<std::size_t>(i)] - u).norm(), 1e-15 * u.norm());
    EXPECT_LT((modal.u(i) - u).norm(), 1e-11 * u.norm());
    EXPECT_LT((modal.v(i) - v).norm(), 1e-10 * v.norm());
  }
}

TEST(ModalMotion, IsTheLimitOfFineSteps) {
  const MeshSpringSettings settings{1e-3, 40, 0.002, 300, 0.015, true};  // dampers are 5e-5 of k
  const auto network = join_vertices(support::icosphere(1, 0.03), settings).value();
  auto modal = ModalMotion<3>::build(network, 5e-3).value();
  SpringMotionOptions fine = with(SpringScheme::kVerlet, 5e-3);
  fine.substeps = 3000;
  fine.substeps_max = 3000;
  auto motion = SpringMotion<3>::build(network, fine).value();
  for (int i = 0; i < 4; ++i) {
    motion.push(7, {1, 2, 3});
    modal.push(7, {1, 2, 3});
    motion.step();
    modal.step();
  }
  for (const std::int32_t node : {0, 7, 20}) {
    const Eigen::Vector3d u = motion.u()[static_cast<std::size_t>(node)];
    EXPECT_LT((modal.u(node) - u).norm(), 1e-6 * motion.u()[7].norm()) << node;
  }
  EXPECT_NEAR(modal.energy(), motion.energy(), 1e-5 * motion.energy());
}

TEST(ModalMotion, RefusesInexactCases) {
  std::vector<BodyNode> nodes{{1e-3, 10, 0.1}, {1e-3, 10, 0}, {1e-3, 10, 0}};
  const std::vector<BodySpring<1>> springs{{0, 1, 50, 0}, {1, 2, 80, 0}};
  EXPECT_FALSE(ModalMotion<1>::build(SpringNetwork<1>::build(nodes, springs).value(), 1e-3));
  nodes[0].base_damping = 0;
  EXPECT_TRUE(ModalMotion<1>::build(SpringNetwork<1>::build(nodes, springs).value(), 1e-3));
  EXPECT_FALSE(ModalMotion<1>::build(SpringNetwork<1>::build(nodes, springs).value(), 0));
  EXPECT_FALSE(ModalMotion<1>::build(sheet(41, 0), 1e-3));
}

TEST(SpringMotion, DoesNotAllocate) {
  const auto network =
      join_vertices(support::icosphere(2, 0.03), {1e-3, 40, 0.002, 300, 0.015, true}).value();
  for (const SpringScheme scheme :
       {SpringScheme::kExplicitEuler, SpringScheme::kSymplecticEuler, SpringScheme::kVerlet,
        SpringScheme::kImplicitEuler, SpringScheme::kTrapezoid}) {
    auto motion = SpringMotion<3>::build(network, with(scheme, 1e-4)).value();
    const int calls = support::heap_calls_of([&] {
      for (int i = 0; i < 20; ++i) {
        motion.push(50, {0, 0, 1});
        motion.step();
      }
    });
    EXPECT_EQ(calls, 0) << name_of(scheme);
  }
  auto modal = ModalMotion<3>::build(network, 1e-3).value();
  EXPECT_EQ(support::heap_calls_of([&] {
              modal.push(3, {0, 0, 1});
              modal.step();
              modal.add(4, modal.u(3), modal.v(3));
            }),
            0);
  // A compiler may remove an unused vector, but not such a call.
  EXPECT_GT(support::heap_calls_of([] { ::operator delete(::operator new(10)); }), 0);
}

}  // namespace
}  // namespace thimble::render
