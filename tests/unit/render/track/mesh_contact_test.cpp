#include "track/mesh_contact.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "support/meshes/reference_geometry.h"
#include "support/meshes/shapes.h"
#include "support/seed.h"
#include "thimble/render/mesh/mesh_file.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

const ContactState& move(MeshContact& contact, const Vector3d& p_WT) {
  driver::DeviceState state;
  state.p_WT = p_WT;
  return contact.update(state);
}

TEST(MeshContact, CatchesAFastTipInAThinPlateAtEveryPhase) {
  // 2 m/s at 1 kHz: 2 mm per tick through 1 mm.
  MeshContact contact = MeshContact::build(support::plate(0.1, 0.001, 8)).value();
  for (int phase = 0; phase < 10000; ++phase) {
    move(contact, {std::numeric_limits<double>::quiet_NaN(), 0, 0});
    const double start = 0.01 + 0.002 * phase / 10000;
    bool touched = false;
    for (int tick = 0; tick < 12 && !touched; ++tick) {
      const double z = start - 0.002 * tick;
      touched = move(contact, {0.003, 0.002, z}).touching;
      ASSERT_EQ(touched, z < 0.0005) << "phase " << phase << " z " << z;
    }
    ASSERT_TRUE(touched);
    ASSERT_EQ(contact.state().n_W, Vector3d(0, 0, 1));
  }
}

TEST(MeshContact, StartInsideIsNotContact) {
  MeshContact contact = MeshContact::build(support::box({1, 1, 1})).value();
  EXPECT_FALSE(move(contact, {0, 0.1, 0.2}).touching);
  EXPECT_FALSE(move(contact, {0, 0.1, 0.9}).touching);
  EXPECT_FALSE(move(contact, {0, 0.1, 1.1}).touching);
  EXPECT_TRUE(move(contact, {0, 0.1, 0.9}).touching);
}

TEST(MeshContact, EntersFromWhereItWasPlaced) {
  MeshContact contact = MeshContact::build(support::box({1, 1, 1})).value();
  contact.set_free({0, 0.1, 1.1});
  EXPECT_EQ(contact.free_tip(), Vector3d(0, 0.1, 1.1));
  EXPECT_TRUE(move(contact, {0, 0.1, 0.9}).touching);
}

TEST(MeshContact, EndsContactForAPositionThatIsNaN) {
  MeshContact contact = MeshContact::build(support::box({1, 1, 1})).value();
  move(contact, {0.1, 0.2, 1.1});
  EXPECT_TRUE(move(contact, {0.1, 0.2, 0.9}).touching);
  EXPECT_FALSE(move(contact, {0.1, std::numeric_limits<double>::quiet_NaN(), 0.9}).touching);
  EXPECT_FALSE(move(contact, {0.1, 0.2, 0.9}).touching);
}

TEST(MeshContact, IsIndependentOfScaleAndOrigin) {
  const TriangleMesh base = support::bumpy_sphere(3, 0.05, 0.3, 6);
  MeshContact reference = MeshContact::build(base).value();
  struct Variant {
    double scale;
    double offset;
    double tolerance;  // of the depth; vertices at 1e4 are rounded to 1e-12
  };
  for (const Variant& v : {Variant{1e-6, 0, 1e-9}, Variant{1e3, 0, 1e-9}, Variant{1, 1e4, 1e-8}}) {
    const Vector3d shift(v.offset, -v.offset, v.offset);
    MeshContact variant =
        MeshContact::build(placed(base, v.scale, Eigen::Matrix3d::Identity(), shift)).value();
    std::mt19937_64 random(support::seed_of(9));
    std::normal_distribution<double> normal;
    Vector3d p(0.08, 0, 0);
    // A tip in contact at the end of the last run may still be in contact after a jump: both begin
    // again.
    move(reference, Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()));
    int touched = 0;
    for (int i = 0; i < 20000; ++i) {
      p = 0.99 * p + 0.003 * Vector3d(normal(random), normal(random), normal(random));
      const ContactState& wanted = move(reference, p);
      const ContactState& found = move(variant, v.scale * p + shift);
      ASSERT_EQ(found.touching, wanted.touching) << i;
      ASSERT_EQ(found.triangle, wanted.triangle) << i;
      ASSERT_NEAR(found.depth / v.scale, wanted.depth, v.tolerance * 0.001 + 1e-9 * wanted.depth);
      touched += found.touching;
    }
    EXPECT_GT(touched, 1000);
  }
}

}  // namespace
}  // namespace thimble::render
