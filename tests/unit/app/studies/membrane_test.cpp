#include "studies/integrators/membrane.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "body/spring/modal_motion.h"
#include "body/spring/spring_motion.h"
#include "support/hard_case.h"

namespace thimble::studies {
namespace {

using render::SpringScheme;

constexpr int kFrames = 70;
constexpr double kFrame = 1e-3;

// Returns the largest error over all nodes and frames, relative to the largest height. Undefined
// heights (after divergence) count as an infinite error.
double error_of(const Membrane& membrane, SpringScheme scheme, int substeps) {
  render::SpringMotionOptions options;
  options.scheme = scheme;
  options.step = kFrame;
  options.substeps = substeps;
  options.substeps_max = substeps;
  options.remainder = 1e-10;
  options.rounds_max = 100;
  options.beyond = render::SpringMotionOptions::Beyond::kAllow;
  auto motion = render::SpringMotion<1>::build(membrane_network(membrane), options).value();
  double error = 0;
  double size = 0;
  for (int frame = 0; frame < kFrames; ++frame) {
    if (frame * kFrame < membrane.poke - kFrame / 2) {
      motion.push(membrane.poked(), render::SpringMotion<1>::Vector(membrane.force));
    }
    motion.step();
    const std::vector<double> truth = membrane_truth(membrane, (frame + 1) * kFrame);
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const double off = std::abs(motion.u()[i][0] - truth[i]);
      if (!(off < 1e6)) return INFINITY;
      error = std::max(error, off);
      size = std::max(size, std::abs(truth[i]));
    }
  }
  return error / size;
}

TEST(Membrane, SinesAndNetworkModesAgree) {
  Membrane membrane;
  membrane.n = 12;
  auto modal = render::ModalMotion<1>::build(membrane_network(membrane), kFrame).value();
  double size = 0;
  double error = 0;
  for (int frame = 0; frame < kFrames; ++frame) {
    if (frame * kFrame < membrane.poke - kFrame / 2) {
      modal.push(membrane.poked(), render::ModalMotion<1>::Vector(membrane.force));
    }
    modal.step();
    const std::vector<double> truth = membrane_truth(membrane, (frame + 1) * kFrame);
    for (std::int32_t i = 0; i < membrane.n * membrane.n; ++i) {
      error = std::max(error, std::abs(modal.u(i)[0] - truth[static_cast<std::size_t>(i)]));
      size = std::max(size, std::abs(truth[static_cast<std::size_t>(i)]));
    }
  }
  EXPECT_GT(size, 1e-3);
  EXPECT_LT(error, 1e-12 * size);
}

TEST(Membrane, ShowsTheOrderOfEachIntegrator) {
  Membrane membrane;
  membrane.n = 6;
  struct Case {
    SpringScheme scheme;
    int substeps;
    double order;
  };
  for (const Case& one :
       {Case{SpringScheme::kExplicitEuler, 1000, 1}, Case{SpringScheme::kSymplecticEuler, 60, 1},
        Case{SpringScheme::kVerlet, 20, 2}, Case{SpringScheme::kImplicitEuler, 200, 1},
        Case{SpringScheme::kTrapezoid, 30, 2}}) {
    const double coarse = error_of(membrane, one.scheme, one.substeps);
    const double fine = error_of(membrane, one.scheme, 2 * one.substeps);
    EXPECT_NEAR(std::log2(coarse / fine), one.order, 0.2)
        << render::name_of(one.scheme) << " " << coarse << " " << fine;
  }
}

TEST(HardCaseMembrane, GuardExplicitEulerDivergesAtItsBound) {
  Membrane membrane;
  membrane.n = 12;
  // There are dampers at the nodes only: 2 zeta / w of the stiffest mode, here 8 us.
  const render::NetworkBounds bounds = membrane_network(membrane).bounds();
  const double limit = render::largest_step(SpringScheme::kExplicitEuler, bounds);
  const double rate = membrane.damping / membrane.mass;
  EXPECT_NEAR(limit, rate / (bounds.omega_max * bounds.omega_max), 1e-15);
  EXPECT_NEAR(limit, 8.4e-6, 0.2e-6);
  EXPECT_LT(error_of(membrane, SpringScheme::kExplicitEuler, 130), 0.2);
  const double error = error_of(membrane, SpringScheme::kExplicitEuler, 4);
  EXPECT_GT(error, 10);
  support::record_hard_case(31, "guard: explicit Euler at 30 times its bound, membrane, 70 ms",
                            "> error over the largest height", std::min(error, 1e12), 10, "1");
}

}  // namespace
}  // namespace thimble::studies
