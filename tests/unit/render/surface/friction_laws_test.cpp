// Properties of single friction laws: the naive one's closed forms, exact updates, stiction.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "support/hard_case.h"
#include "support/identify/rubbing.h"
#include "support/random.h"
#include "surface/friction/bristle.h"
#include "surface/friction/dahl.h"
#include "surface/friction/lugre.h"
#include "surface/friction/stiction_point.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;
using support::make_friction;
using support::record_hard_case;
using support::Rubbing;

constexpr double kStep = 3e-5;  // m

double counted(double x) {
  return kStep * std::round(x / kStep);
}

// A complete law, and laws that each lack one member that FrictionStage uses.
struct WholeLaw : BristleLaw {
  using BristleLaw::BristleLaw;
};
struct NoCoefficients : WholeLaw {
  using WholeLaw::WholeLaw;
  void coulomb() = delete;
};
struct CoefficientsByValue : WholeLaw {
  using WholeLaw::WholeLaw;
  CoulombSettings coulomb() noexcept { return {}; }
};
struct NoName : WholeLaw {
  using WholeLaw::WholeLaw;
  static constexpr int kName = 0;
};
struct NotMadeOfSettings : WholeLaw {
  explicit NotMadeOfSettings(int) : WholeLaw(Settings{}) {}
};
struct UnreadSettings : WholeLaw {
  struct Settings : BristleLaw::Settings {
    void read() {}
  };
  using WholeLaw::WholeLaw;
};
static_assert(FrictionLaw<WholeLaw>);
static_assert(!FrictionLaw<NoCoefficients>);
static_assert(!FrictionLaw<CoefficientsByValue>);
static_assert(!FrictionLaw<NoName>);
static_assert(!FrictionLaw<NotMadeOfSettings>);
static_assert(!FrictionLaw<UnreadSettings>);

template <class Law>
AnyStageOf<FrictionStage<Law>> stage(const typename Law::Settings& settings) {
  return AnyStageOf<FrictionStage<Law>>({settings, support::phantom_context()});
}

// [PHYSICS 2.1]: p = v T / step.
TEST(HardCaseNaiveFriction, IsADamperBelowOneCountPerTick) {
  double worst = 0;
  for (const double speed : {0.005, 0.02}) {
    const auto friction = make_friction("naive", MapSettings({{"coefficient", 0.5}}));
    Rubbing rubbing{*friction};
    const int ticks = 60'000;  // whole numbers of counts
    double sum = 0, squares = 0;
    rubbing.at_x(0);
    for (int k = 1; k <= ticks; ++k) {
      const double f = rubbing.at_x(counted(speed * 1e-3 * k));
      sum += f;
      squares += f * f;
    }
    const double p = speed * 1e-3 / kStep;
    const double mean = sum / ticks;
    EXPECT_NEAR(-mean, p * 0.5, 0.01 * p * 0.5) << speed;
    const double ripple = std::sqrt(squares / ticks - mean * mean);
    const double law = 0.5 * std::sqrt(p * (1 - p));
    EXPECT_NEAR(ripple, law, 0.01 * law) << speed;
    worst = std::max({worst, std::abs(-mean / (p * 0.5) - 1), std::abs(ripple / law - 1)});
  }
  record_hard_case(13, "the law alone", "<= error of mean and ripple", worst, 0.01, "1");
}

TEST(HardCaseLugre, NeverGrows) {
  double max_over = -1, max_ringing = 0;
  for (const double stiffness : {1e3, 1e5, 1e6}) {
    for (double speed = 1e-6; speed <= 2.01; speed *= 2) {
      auto lugre = stage<LugreLaw>({.coulomb = {.sliding = 0.5, .holding = 0.54},
                                    .viscous = {.viscous = 0.4, .fade_depth = 0},
                                    .stiffness = stiffness,
                                    .damping = 1});
      Rubbing rubbing{lugre};
      double most = 0, before = 0;
      for (int k = 0; k < 2000; ++k) {
        const double f = -rubbing.at_x(speed * 1e-3 * k);
        ASSERT_TRUE(std::isfinite(f));
        most = std::max(most, std::abs(f));
        if (k >= 1990) {
          EXPECT_NEAR(f, before, 1e-3 * std::abs(f)) << "no ringing";
          max_ringing = std::max(max_ringing, std::abs(f / before - 1));
        }
        before = f;
      }
      EXPECT_LE(most, 0.54 + 0.4 * speed + 1e-9) << stiffness << " " << speed;
      max_over = std::max(max_over, most - (0.54 + 0.4 * speed));
    }
  }
  const char* const kSweep = "1 um/s to 2 m/s, 1e3 to 1e6 N/m, 2 s each";
  record_hard_case(17, kSweep, "<= force beyond F_s + s2 v", max_over, 1e-9, "N");
  record_hard_case(17, kSweep, "<= change per tick of the force at last", max_ringing, 1e-3, "1");
}

TEST(HardCaseLugre, GuardEulerStepDiverges) {
  // Negative control of the test above: z <- z + T v - T sigma0 |v| z / g with T sigma0 |v| / g >
  // 2.
  const double stiffness = 1e5, level = 0.5;
  const auto force_after = [&](double share) {
    const double speed = share * level / (1e-3 * stiffness);
    double z = 0;
    for (int k = 0; k < 2000; ++k) z += 1e-3 * (speed - stiffness * speed / level * z);
    return std::abs(stiffness * z);
  };
  EXPECT_GT(force_after(2.2), 1e6);
  EXPECT_LE(force_after(1.8), 2 * level);
  record_hard_case(17, "guard: Euler's step at 1.1 of 2 g / (s0 T)", "> force after 2 s",
                   std::min(force_after(2.2), 1e12), 1e6, "N");
}

TEST(DahlFriction, LongStepEqualsManyShortOnes) {
  for (const double way : {1e-6, 5e-5, 3e-4, 1e-2}) {
    auto one = stage<DahlLaw>({.coulomb = {.sliding = 0.5, .holding = 0.5}, .stiffness = 2500});
    auto many = stage<DahlLaw>({.coulomb = {.sliding = 0.5, .holding = 0.5}, .stiffness = 2500});
    Rubbing coarse{one}, fine{many};
    coarse.at_x(0);
    const double f = coarse.at_x(way);
    double g = 0;
    for (int k = 0; k <= 1000; ++k) g = fine.at_x(way * k / 1000);
    EXPECT_NEAR(f, -0.5 * -std::expm1(-2500 * way / 0.5), 1e-14);
    EXPECT_NEAR(f, g, 1e-11);
  }
}

TEST(BristleFriction, HoldsWithStaticAndSlidesWithSlidingFriction) {
  auto bristle =
      stage<BristleLaw>({.coulomb = {.sliding = 0.4, .holding = 0.6}, .stiffness = 2000});
  Rubbing rubbing{bristle};
  double most = 0;
  for (int k = 0; k < 1000; ++k) most = std::max(most, -rubbing.at_x(1e-6 * k));
  EXPECT_NEAR(most, 0.6, 2.1e-3);  // one step of 1 um earlier
  EXPECT_NEAR(-rubbing.at_x(0.001), 0.4, 1e-12);
  // It stays at the sliding level at rest, and under a tremor of a few counts.
  for (int k = 0; k < 100; ++k) EXPECT_LE(-rubbing.at_x(0.001 - 3e-5 * (k % 2)), 0.4 + 1e-12);
  // After a deflection back by more than half, it holds again with static friction.
  rubbing.at_x(0.0008);
  most = 0;
  for (int k = 0; k < 500; ++k) most = std::max(most, -rubbing.at_x(0.0008 + 1e-6 * k));
  EXPECT_NEAR(most, 0.6, 2.1e-3);
}

TEST(StictionPointFriction, GripsAndSlipsBetweenBothFrictions) {
  auto point =
      stage<StictionPointLaw>({.coulomb = {.sliding = 0.4, .holding = 0.6}, .stiffness = 2000});
  Rubbing rubbing{point};
  double least = 1, most = 0;
  int slips = 0;
  double before = 0;
  for (int k = 0; k < 20'000; ++k) {
    const double f = -rubbing.at_x(1e-6 * k);
    if (k > 1000) least = std::min(least, f);
    most = std::max(most, f);
    if (f < before - 0.1) ++slips;
    before = f;
  }
  EXPECT_NEAR(most, 0.6, 2.1e-3);
  EXPECT_NEAR(least, 0.4, 2.1e-3);
  EXPECT_NEAR(slips, (20'000 - 300) / 100, 2);  // one per 0.2 N / 2000 N/m
}

// 1 Hz, +-10 mm, from an encoder with steps.
double loop_area(AnyStage& friction) {
  Rubbing rubbing{friction};
  double work = 0, x_before = 0, f_before = 0;
  for (int k = 0; k <= 3000; ++k) {
    const double x = 0.01 * std::sin(2 * std::numbers::pi * k / 1000);
    const double f = rubbing.at_x(counted(x));
    if (k > 1000 && k <= 2000) work -= (f + f_before) / 2 * (x - x_before);
    x_before = x;
    f_before = f;
  }
  return work;
}

TEST(HardCaseHysteresis, LoopAreaMatches) {
  const double full = 4 * 0.01 * 0.5;
  for (const char* name : {"bristle", "dahl", "implicit_coulomb", "lugre"}) {
    const auto friction = make_friction(name, MapSettings({{"coefficient", 0.5}}));
    const double area = loop_area(*friction);
    EXPECT_NEAR(area, full, 0.03 * full) << name;
    record_hard_case(19, name, "<= error of the loop's area", std::abs(area / full - 1), 0.03, "1");
  }
}

TEST(BristleFriction, CurveDoesNotStretchTheBristle) {
  // Around a cylinder about y of 5 mm: first deflected along y at rest, then turned twice. The
  // deflection along the axis stays; the deflection that turns with the surface keeps its size.
  auto bristle = stage<BristleLaw>({.coulomb = {.sliding = 5, .holding = 5}, .stiffness = 2000});
  Rubbing rubbing{bristle};
  const auto point = [&](double angle, double y) {
    rubbing.n_W = {std::sin(angle), 0, std::cos(angle)};
    return rubbing.at(0.005 * rubbing.n_W + Vector3d(0, y, 0));
  };
  point(0, 0);
  EXPECT_NEAR(point(0, 1e-4).y(), -0.2, 1e-12);
  double along_y = 0, way = 0;
  Vector3d before = 0.005 * rubbing.n_W;
  for (int k = 1; k <= 100; ++k) {
    const double angle = 0.002 * k;
    along_y = point(angle, 1e-4).y();
    way += (0.005 * rubbing.n_W - before).norm();
    before = 0.005 * rubbing.n_W;
  }
  EXPECT_NEAR(along_y, -0.2, 1e-12);
  const Vector3d f_W = rubbing.response.f_T_W - rubbing.n_W;
  const Vector3d around_W(rubbing.n_W.z(), 0, -rubbing.n_W.x());
  EXPECT_NEAR(f_W.dot(around_W), -2000 * way, 2000 * way * 1e-5);
}

TEST(ViscousFriction, FadesTowardsTheSurface) {
  const auto friction = make_friction(
      "paper", MapSettings({{"coefficient", 0}, {"viscous", 5}, {"fade_depth", 0.001}}));
  Rubbing rubbing{*friction};
  double x = 0;
  for (int k = 0; k < 300; ++k) rubbing.at_x(x += 1e-4);
  EXPECT_NEAR(rubbing.at_x(x += 1e-4), -0.5, 1e-6);  // 5 N s/m at 0.1 m/s
  rubbing.depth = 0.00025;
  EXPECT_NEAR(rubbing.at_x(x += 1e-4), -0.125, 1e-6);
  rubbing.depth = 0;
  EXPECT_EQ(rubbing.at_x(x += 1e-4), 0);
}

}  // namespace
}  // namespace thimble::render
