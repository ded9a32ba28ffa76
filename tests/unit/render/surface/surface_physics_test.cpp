// Surfaces, frictions, textures and fields compared with closed forms, for
// tests/acceptance/PHYSICS.md.
#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "field/gravity.h"
#include "field/magnetic_snap.h"
#include "field/point_charges.h"
#include "field/primitive_contact.h"
#include "field/viscous.h"
#include "support/identify/rubbing.h"
#include "support/physics.h"
#include "surface/texture/sines.h"
#include "thimble/render/field/half_space.h"
#include "thimble/render/object_touch.h"
#include "thimble/render/surface/spring_damper.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;
using support::expect_physics;

driver::DeviceState tip_at(const Vector3d& p_WT, const Vector3d& v_WT = {0, 0, 0}) {
  driver::DeviceState state;
  state.p_WT = p_WT;
  state.v_WT = v_WT;
  return state;
}

TEST(PhysicsOfSurfaces, ASpringAndDamperPushBackByTheirLaw) {
  ContactForceLaw touch{PrimitiveContact(HalfSpace()), SpringDamper{800, 2}};
  touch(tip_at({0, 0, 1e-3}));
  expect_physics({"surface", "force 2 mm deep, 800 N/m, 2 N s/m, entering at 0.1 m/s", "k x + b v",
                  "N", 800 * 0.002 + 2 * 0.1, 1e-12},
                 touch(tip_at({0, 0, -2e-3}, {0, 0, -0.1})).f_T_W.z());
}

TEST(PhysicsOfSurfaces, ATextureHasItsAmplitudeAndWavelength) {
  Sines::Settings settings;
  settings.form = TextureForm::kDepthOnly;
  settings.waves = {{.amplitude = 0.0001, .wavelength = 0.002, .direction = {1, 0, 0}, .phase = 0}};
  EffectContext known;
  known.force_max = 5;
  known.surface_stiffness = 800;
  ContactForceLaw touch{PrimitiveContact(HalfSpace()), Sines(settings, known),
                        SpringDamper{800, 0}};
  touch(tip_at({0, 0, 1e-3}));
  double low = HUGE_VAL, high = 0, first = -1, last = -1;
  int crossings = 0;
  const double mean = 800 * (0.001 - 0.0001);  // peaks are in the surface
  double before = touch(tip_at({0, 0, -1e-3})).f_T_W.z() - mean;
  for (int i = 1; i <= 20000; ++i) {
    const double force = touch(tip_at({1e-6 * i, 0, -1e-3})).f_T_W.z();
    low = std::min(low, force);
    high = std::max(high, force);
    const double off = force - mean;
    if (before < 0 && off >= 0) {
      last = i - off / (off - before);
      if (crossings++ == 0) first = last;
    }
    before = off;
  }
  expect_physics({"texture", "largest minus smallest force, waves of 0.1 mm, 800 N/m", "2 k a", "N",
                  2 * 800 * 0.0001, 1e-5},
                 high - low);
  expect_physics({"texture", "distance of two peaks", "wavelength", "m", 0.002, 1e-6},
                 (last - first) * 1e-6 / (crossings - 1));
}

// Friction force of a surface pressed with 1 N.
double slide(const std::string& name, const std::string& key, double value) {
  const auto friction =
      support::make_friction(name, MapSettings({{"coefficient", 0.4}, {key, value}}));
  support::Rubbing rubbing{*friction};
  double felt = 0;
  for (int i = 0; i <= 4000; ++i) felt = -rubbing.at_x(4e-5 * i);  // 40 mm/s
  return felt;
}

TEST(PhysicsOfFriction, SlidingForceFollowsTheCoefficient) {
  for (const char* name : {"bristle", "dahl", "karnopp", "implicit_coulomb"}) {
    expect_physics({"friction", std::string(name) + ", sliding at 40 mm/s under 1 N, mu = 0.4",
                    "mu N", "N", 0.4, 1e-3},
                   slide(name, "stiffness", 1000));
  }
}

TEST(PhysicsOfFriction, BristleSlipsAtStaticFriction) {
  for (const char* name : {"bristle", "stiction_point"}) {
    const auto friction = support::make_friction(
        name,
        MapSettings({{"coefficient", 0.4}, {"static_coefficient", 0.6}, {"stiffness", 1000.0}}));
    support::Rubbing rubbing{*friction};
    double largest = 0, stuck = 0;
    for (int i = 0; i <= 2000; ++i) {
      const double felt = -rubbing.at_x(1e-6 * i);
      largest = std::max(largest, felt);
      if (i == 300) stuck = felt;
    }
    expect_physics(
        {"friction", std::string(name) + ", force at which it lets go, static coefficient 0.6",
         "mu_s N", "N", 0.6, 5e-3},
        largest);
    expect_physics({"friction", std::string(name) + ", force when held 0.3 mm away, 1000 N/m",
                    "k x", "N", 0.3, 5e-3},
                   stuck);
  }
}

TEST(PhysicsOfFields, FieldsPullByTheirLaws) {
  PointCharges::Settings charges;
  charges.charges = {{.p_O = {0, 0, 0}, .force = 2, .radius = 0.01}};
  const PointCharges field(charges, {});
  double largest = 0, where = 0;
  for (int i = 0; i < 30000; ++i) {
    const double force = field.force(tip_at({1e-6 * i, 0, 0})).x();
    if (force > largest) where = 1e-6 * i;
    largest = std::max(largest, force);
  }
  expect_physics({"field: charges", "largest force of a charge named 2 N", "2 q / (3 sqrt(3) a^2)",
                  "N", 2, 1e-6},
                 largest);
  expect_physics({"field: charges", "distance of the largest force, a = 10 mm", "a / sqrt(2)", "m",
                  0.01 / std::sqrt(2), 1e-3},
                 where);
  // Far away Coulomb's law holds: four times the distance, a sixteenth of the force.
  expect_physics({"field: charges", "force at 1 m over that at 4 m", "16 (1 / r^2)", "1", 16, 1e-3},
                 field.force(tip_at({1, 0, 0})).x() / field.force(tip_at({4, 0, 0})).x());
  MagneticSnap::Settings snap;
  snap.targets = {{.from_O = {0, 0, 0}, .to_O = {0, 0, 0}, .force = 1.5, .radius = 0.01}};
  const MagneticSnap magnet(snap, {});
  double pull = 0, at = 0;
  for (int i = 0; i < 12000; ++i) {
    const double force = -magnet.force(tip_at({1e-6 * i, 0, 0})).x();
    if (force > pull) at = 1e-6 * i;
    pull = std::max(pull, force);
  }
  expect_physics(
      {"field: magnetic_snap", "largest pull of a target named 1.5 N", "force", "N", 1.5, 1e-6},
      pull);
  expect_physics({"field: magnetic_snap", "distance of the largest pull, R = 10 mm", "R / sqrt(3)",
                  "m", 0.01 / std::sqrt(3), 1e-3},
                 at);
  EXPECT_EQ(magnet.force(tip_at({0.01, 0, 0})).norm(), 0);
  const Gravity weight({.mass = 0.2}, {});
  expect_physics({"field: gravity", "force of 0.2 kg", "m g", "N", -0.2 * 9.80665, 1e-12},
                 weight.force(tip_at({0, 0, 0})).z());
  const Viscous liquid({.damping = 3}, {});
  expect_physics({"field: viscous", "force at 0.1 m/s, 3 N s/m", "-b v", "N", -0.3, 1e-12},
                 liquid.force(tip_at({0, 0, 0}, {0.1, 0, 0})).x());
}

}  // namespace
}  // namespace thimble::render
