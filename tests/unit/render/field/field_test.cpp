#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <string>

#include "field/gravity.h"
#include "field/magnetic_snap.h"
#include "field/point_charges.h"
#include "field/viscous.h"
#include "support/heap_guard.h"
#include "support/random.h"
#include "support/variant_settings.h"
#include "thimble/render/field/field_table.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;
using support::VariantSettings;

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

driver::DeviceState at(const Vector3d& p_WT, const Vector3d& v_WT = Vector3d::Zero()) {
  driver::DeviceState state;
  state.p_WT = p_WT;
  state.v_WT = v_WT;
  return state;
}

EffectContext turned() {
  EffectContext known;
  known.R_WO = Eigen::AngleAxisd(1.1, Vector3d(3, -1, 2).normalized()).toRotationMatrix();
  known.p_WO = {0.004, -0.003, 0.002};
  return known;
}

PointCharges three_charges() {
  PointCharges::Settings settings;
  settings.charges = {
      {{0.02, 0, 0}, 1.5, 0.008}, {{-0.02, 0, 0}, -1, 0.012}, {{0, 0.01, 0}, 2, 0.005}};
  return {settings, turned()};
}

MagneticSnap point_and_line() {
  MagneticSnap::Settings settings;
  settings.targets = {
      {.from_O = {0.01, 0, 0}, .to_O = {0.01, 0, 0}, .force = 2, .radius = 0.015},
      {.from_O = {-0.01, -0.02, 0}, .to_O = {0, 0.02, 0.01}, .force = 1, .radius = 0.02}};
  return {settings, turned()};
}

// Work around closed paths through the field; as in texture_test, in even steps of a smooth path.
// If the force has a kink (the rim of a snap), the sum converges with the square of the step.
template <class F>
void expect_no_work(const F& field, int steps, const char* what) {
  support::Random random(7);
  for (int loop = 0; loop < 5; ++loop) {
    const Vector3d a = random.in_box(0.02), b = random.in_box(0.02), c = random.in_box(0.01);
    const Vector3d middle = random.in_box(0.005);
    double work = 0, gross = 0;
    for (int i = 0; i < steps; ++i) {
      const double s = kTurn * i / steps;
      const Vector3d p = middle + a * std::cos(s) + b * std::sin(s) + c * std::sin(2 * s);
      const Vector3d way = -a * std::sin(s) + b * std::cos(s) + 2 * c * std::cos(2 * s);
      const double power = field.force(at(p)).dot(way);
      work += power;
      gross += std::abs(power);
    }
    EXPECT_GT(gross, 0);
    EXPECT_LT(std::abs(work), 1e-9 * gross) << what << ", loop " << loop;
  }
}

TEST(Fields, ConservativeFieldsDoNoWorkOnAClosedPath) {
  expect_no_work(three_charges(), 4000, "charges");
  expect_no_work(point_and_line(), 400000, "magnetic snap");
  expect_no_work(Gravity({.mass = 0.1}, {}), 1000, "gravity");
}

TEST(Fields, GiveNoForceForNaNOrInfinity) {
  const PointCharges charges = three_charges();
  const MagneticSnap snap = point_and_line();
  const Viscous honey({.damping = 5}, {});
  for (const double bad :
       {kNan, std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()}) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      Vector3d wrong(0.001, 0.002, 0.003);
      wrong[axis] = bad;
      EXPECT_EQ(charges.force(at(wrong)), Vector3d::Zero());
      EXPECT_EQ(snap.force(at(wrong)), Vector3d::Zero());
      EXPECT_EQ(honey.force(at(Vector3d::Zero(), wrong)), Vector3d::Zero());
    }
  }
}

TEST(PointCharges, LargestForceIsAtRadiusOverRootTwo) {
  for (const double force : {2.5, -1.25}) {
    const PointCharges charge({.charges = {{Vector3d::Zero(), force, 0.01}}}, {});
    const double peak = 0.01 / std::numbers::sqrt2;
    EXPECT_NEAR(charge.force(at({peak, 0, 0})).x(), force, 1e-12);
    support::Random random(8);
    for (int i = 0; i < 10000; ++i) {
      const Vector3d p = random.direction() * std::pow(10, random.uniform(-6, 0));
      const Vector3d f = charge.force(at(p));
      EXPECT_LE(f.norm(), std::abs(force) * (1 + 1e-12));
      EXPECT_LT(f.cross(p).norm(), 1e-12 * f.norm() * p.norm() + 1e-300);
      EXPECT_GE(f.dot(p) * force, 0);
    }
    EXPECT_EQ(charge.force(at({0, 0, 0})), Vector3d::Zero());
    // Far away Coulomb's law holds: a quarter of the force at twice the distance.
    EXPECT_NEAR(charge.force(at({2, 0, 0})).x() / charge.force(at({1, 0, 0})).x(), 0.25, 1e-4);
  }
}

TEST(MagneticSnap, PullsWithoutAStepAtTheCaptureRadius) {
  MagneticSnap::Settings settings;
  settings.targets = {{.from_O = {0, 0, 0}, .to_O = {0, 0, 0}, .force = 2, .radius = 0.01}};
  const MagneticSnap point(settings, {});
  EXPECT_EQ(point.force(at({0.01, 0, 0})), Vector3d::Zero());
  EXPECT_EQ(point.force(at({0.02, 0, 0})), Vector3d::Zero());
  EXPECT_LT(point.force(at({0.00999999, 0, 0})).norm(), 1e-4);
  EXPECT_NEAR(point.force(at({0.01 / std::numbers::sqrt3, 0, 0})).x(), -2, 1e-12);
  EXPECT_EQ(point.force(at({0, 0, 0})), Vector3d::Zero());
  for (double r = 0; r < 0.02; r += 1e-5) {
    EXPECT_LE(point.force(at({0, r, 0})).norm(), 2 + 1e-12);
    EXPECT_LE(point.force(at({0, r, 0})).y(), 0);
  }
}

TEST(MagneticSnap, TipSlidesFreelyAlongALine) {
  MagneticSnap::Settings settings;
  settings.targets = {{.from_O = {-0.05, 0, 0}, .to_O = {0.05, 0, 0}, .force = 2, .radius = 0.01}};
  const MagneticSnap line(settings, {});
  for (double x = -0.05; x <= 0.05; x += 0.001) {
    const Vector3d f = line.force(at({x, 0.003, -0.001}));
    EXPECT_NEAR(f.x(), 0, 1e-13);
    EXPECT_LT(f.y(), 0);
    EXPECT_GT(f.z(), 0);
  }
  EXPECT_GT(line.force(at({-0.055, 0, 0})).x(), 0);  // beyond its ends, back to them
}

TEST(Gravity, IsTheWeightEverywhere) {
  const Gravity weight({.mass = 0.2}, {});
  EXPECT_LT((weight.force(at({0.1, 0.2, 0.3})) - Vector3d(0, 0, -0.2 * 9.80665)).norm(), 1e-15);
}

TEST(Viscous, TakesEnergyOutOfEveryMotion) {
  support::Random random(9);
  const Viscous honey({.damping = 5}, {});
  for (int i = 0; i < 1000; ++i) {
    const Vector3d v = random.in_box(1);
    EXPECT_LT((honey.force(at(Vector3d::Zero(), v)) + 5 * v).norm(), 1e-15);
  }
}

// A free mass in the liquid, with velocity by differences and a late force: ratio of its final to
// its initial speed.
double speed_left(double damping, double mass, int late) {
  const double tick = 0.001;
  double x = 0, v = 0.1, before = 0;
  double forces[8] = {};
  for (int k = 0; k < 3000; ++k) {
    forces[k % 8] = -damping * (x - before) / tick;
    before = x;
    const double force = forces[(k + 8 - late) % 8];
    x += v * tick + force * tick * tick / (2 * mass);
    v += force * tick / mass;
  }
  return std::abs(v) / 0.1;
}

TEST(Viscous, RefusesDampingAboveTheLoopsLimit) {
  for (const int late : {0, 1, 3}) {
    EffectContext known;
    known.tip_mass = 0.075;
    known.delay = 0.001 * late;
    const double most = std::numbers::pi / 2 * 0.075 / (0.001 * (1 + late));
    const auto mistakes = [&](double damping) {
      VariantSettings reader({{"damping", damping}});
      Viscous::Settings settings;
      settings.read(reader, known);
      return reader.mistakes;
    };
    EXPECT_EQ(mistakes(0.99 * most), "");
    EXPECT_NE(mistakes(1.01 * most).find("ms, an arm of 0.075 kg oscillates"), std::string::npos);
    // An accepted damping is stable, and one slightly above the limit is not.
    EXPECT_LT(speed_left(0.99 * most, 0.075, late), 1e-3) << late;
    EXPECT_GT(speed_left(1.35 * most, 0.075, late), 1e3) << late;
    EXPECT_NE(mistakes(-1).find("damping"), std::string::npos);
    EXPECT_NE(mistakes(kNan).find("damping"), std::string::npos);
  }
}

TEST(FieldTable, NoFieldAllocates) {
  std::set<std::string_view> names;
  for (const FieldKind& kind : field_table()) {
    EXPECT_TRUE(names.insert(kind.name).second);
    VariantSettings reader(
        {{"mass", 0.1}, {"damping", 2.0}},
        {{"charges", {{{"position", Vector3d(0, 0, 0.01)}, {"force", 1.0}, {"radius", 0.01}}}},
         {"targets",
          {{{"point", Vector3d(0, 0, 0.01)}, {"force", 1.0}, {"capture_radius", 0.02}}}}});
    const FieldBuilder build = kind.read(reader, {});
    EXPECT_EQ(reader.mistakes, "") << kind.name;
    const auto touch = build();
    driver::ForceCommand command;
    EXPECT_EQ(support::heap_calls_of([&] {
                command = touch->update(at({0.001, 0.002, 0.003}, {0.1, 0, 0}));
              }),
              0);
    EXPECT_GT(command.f_T_W.norm(), 0.01) << kind.name;
    EXPECT_FALSE(command.touch.in_contact);
    EXPECT_FALSE(touch->inside({0, 0, 0}));
  }
}

TEST(FieldTable, RefusesBadSettingsWithTheReason) {
  const auto mistakes = [](std::string_view name, const VariantSettings::Values& values,
                           const VariantSettings::Lists& lists) {
    VariantSettings reader(values, lists);
    for (const FieldKind& kind : field_table()) {
      if (kind.name == name) kind.read(reader, {});
    }
    return reader.mistakes;
  };
  EXPECT_NE(mistakes("charges", {}, {}).find("charges"), std::string::npos);
  EXPECT_NE(mistakes("charges", {}, {{"charges", {{{"force", 1.0}}}}}).find("position"),
            std::string::npos);
  EXPECT_NE(
      mistakes("charges", {}, {{"charges", {{{"position", Vector3d(0, kNan, 0)}, {"force", 1.0}}}}})
          .find("position"),
      std::string::npos);
  EXPECT_NE(mistakes("magnetic_snap", {}, {{"targets", {{{"force", 1.0}}}}}).find("either point"),
            std::string::npos);
  EXPECT_NE(mistakes("gravity", {{"mass", kNan}}, {}).find("mass"), std::string::npos);
}

/// Returns the largest difference of a field's force and its potential's gradient at random places,
/// N.
template <class F>
double worst_slope(const F& field) {
  support::Random random(11);
  double worst = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vector3d p = random.in_box(0.03);
    Vector3d slope;
    for (Eigen::Index k = 0; k < 3; ++k) {
      constexpr double kStep = 1e-6;
      const Vector3d step = kStep * Vector3d::Unit(k);
      slope[k] = (field.potential(at(p + step)) - field.potential(at(p - step))) / (2 * kStep);
    }
    worst = std::max(worst, (slope + field.force(at(p))).norm());
  }
  return worst;
}

TEST(Field, ForceIsTheGradientOfThePotential) {
  Gravity::Settings weight;
  weight.mass = 0.2;
  EXPECT_LT(worst_slope(Gravity(weight, turned())), 1e-7);
  PointCharges::Settings charges;
  charges.charges = {{.p_O = {0.01, 0, 0}, .force = 2, .radius = 0.008},
                     {.p_O = {-0.01, 0.01, 0}, .force = -1.5, .radius = 0.01}};
  EXPECT_LT(worst_slope(PointCharges(charges, turned())), 1e-5);
  MagneticSnap::Settings snap;
  snap.targets = {
      {.from_O = {0, 0, 0}, .to_O = {0.02, 0, 0}, .force = 2, .radius = 0.02},
      {.from_O = {-0.01, 0.01, 0.01}, .to_O = {-0.01, 0.01, 0.01}, .force = 1, .radius = 0.03}};
  EXPECT_LT(worst_slope(MagneticSnap(snap, turned())), 1e-5);
}

TEST(Field, ReturnsItsEnergyWithItsForce) {
  Gravity::Settings weight;
  weight.mass = 0.2;
  const Gravity field(weight, EffectContext{});
  FieldTouch<Gravity> touch(field);
  const driver::ForceCommand command = touch.update(at({0, 0, 0.01}));
  EXPECT_EQ(command.stored, field.potential(at({0, 0, 0.01})));
  EXPECT_TRUE(command.f_program_W.isZero(0));
}

TEST(Field, OfAFunctionIsTheProgramsForce) {
  const auto touch =
      field_of([](const driver::DeviceState&) noexcept { return Vector3d(0, 0, 1); });
  EXPECT_EQ(touch->update(at({0, 0, 0})).f_program_W, Vector3d(0, 0, 1));
}

}  // namespace
}  // namespace thimble::render
