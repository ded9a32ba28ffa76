#include <gtest/gtest.h>

#include <numbers>

#include "god_object_shapes.h"
#include "support/hard_case.h"
#include "track/surface_tracker.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;
using support::move;

constexpr double kDegree = std::numbers::pi / 180;

// A convex hollow in a block, with a point well inside it.
struct Hollow {
  const char* name;
  TriangleMesh mesh;
  Vector3d middle;
  int presses;
};

TriangleMesh sheared(TriangleMesh mesh, support::Random& random) {
  Eigen::Matrix3d m = Eigen::Matrix3d::Identity();
  for (int i = 0; i < 9; ++i) m(i / 3, i % 3) += random.uniform(-0.4, 0.4);
  for (Vector3d& p : mesh.vertices) p = m * p;
  if (m.determinant() < 0) {
    for (auto& triangle : mesh.triangles) std::swap(triangle[0], triangle[1]);
  }
  return mesh;
}

std::vector<Hollow> hollows() {
  std::vector<Hollow> all;
  const int presses = support::length_of_run(2000, 20000);
  all.push_back({"box", support::box({0.05, 0.04, 0.03}), {0, 0, 0}, presses});
  support::Random random(11);
  for (int i = 0; i < 5; ++i) {
    all.push_back(
        {"sheared box", sheared(support::box({0.05, 0.04, 0.03}), random), {0, 0, 0}, presses});
  }
  all.push_back(
      {"wedge of 5 degrees", support::wedge(5 * kDegree, 0.1, 0.04), {0.02, 0, 0}, presses});
  all.push_back({"wedge of 1 degree", support::wedge(kDegree, 0.1, 0.04), {0.02, 0, 0}, presses});
  all.push_back({"needle of valence 64",
                 support::needle(64, 0.1, 0.004),
                 {0, 0, 0.02},
                 support::length_of_run(60, 600)});
  all.push_back({"needle of valence 7", support::needle(7, 0.1, 0.02), {0, 0, 0.02}, presses});
  return all;
}

TEST(HardCaseSharpCorner, GodObjectMatchesTheQuadraticProgram) {
  double worst = 0, max_hops = 0, moved_later = 0;
  int presses = 0;
  for (const Hollow& hollow : hollows()) {
    const double size = 0.4;
    auto contact = GodObjectContact::build(support::block_around(hollow.mesh, size / 2)).value();
    const auto planes = support::planes_inside(hollow.mesh);
    support::Random random(5);
    int corners = 0;
    for (int i = 0; i < hollow.presses; ++i) {
      move(contact, Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()));
      ASSERT_FALSE(move(contact, hollow.middle).touching) << hollow.name;
      const Vector3d p_WT = hollow.middle + random.direction() * random.uniform(0, 0.12);
      const bool inside = contact.search().inside(p_WT);
      const ContactState once = move(contact, p_WT);
      ASSERT_EQ(once.touching, inside) << hollow.name << " press " << i;
      if (!once.touching) continue;
      const Vector3d wanted = support::project_by_trial(planes, p_WT, 1e-13 * size);
      ASSERT_LT((once.p_WP - wanted).norm(), 1e-9 * size) << hollow.name << " press " << i;
      ASSERT_NEAR(once.depth, (wanted - p_WT).norm(), 1e-9 * size);
      ASSERT_LT((once.p_WP - p_WT - once.depth * once.n_W).norm(), 1e-9 * size);
      ASSERT_FALSE(contact.search().inside(once.p_WP)) << hollow.name << " press " << i;
      int holding = 0;
      for (const auto& c : planes) holding += std::abs(c.n.dot(wanted) + c.d) < 1e-12;
      corners += holding >= 3;
      for (int tick = 0; tick < 10; ++tick) move(contact, p_WT);
      ASSERT_EQ(contact.state().p_WP, once.p_WP) << hollow.name << " press " << i;
      ++presses;
      worst = std::max(worst, (once.p_WP - wanted).norm() / size);
      max_hops = std::max<double>(max_hops, once.hops);
      moved_later = std::max(moved_later, (contact.state().p_WP - once.p_WP).norm());
    }
    EXPECT_GT(corners, 3) << hollow.name;
    EXPECT_EQ(contact.counters().held, 0U) << hollow.name;
    EXPECT_EQ(contact.counters().long_walks, 0U) << hollow.name;
  }
  EXPECT_GT(presses, 1000);
  const char* const kHollows = "god-object in boxes, wedges of 5 and 1 degree, needles";
  support::record_hard_case(25, kHollows, "<= proxy off the quadratic program, over the size",
                            worst, 1e-9, "1");
  support::record_hard_case(25, "the same", "== way of the proxy in ten more ticks", moved_later, 0,
                            "m");
  EXPECT_LT(max_hops, kHopsMax);  // that many end a search that has not converged
  support::record_hard_case(25, "the same", "< most hops in a tick", max_hops, kHopsMax, "1");
}

TEST(GodObjectCorners, EqualTheQuadraticProgramAlongAPath) {
  for (const Hollow& hollow : hollows()) {
    const double size = 0.4;
    auto contact = GodObjectContact::build(support::block_around(hollow.mesh, size / 2)).value();
    const auto planes = support::planes_inside(hollow.mesh);
    support::Random random(6);
    Vector3d p = hollow.middle;
    Vector3d goal = p;
    move(contact, p);
    for (int i = 0; i < 2 * hollow.presses; ++i) {
      if (i % 100 == 0) goal = hollow.middle + random.direction() * random.uniform(0, 0.12);
      p += 0.05 * (goal - p) + random.in_box(3e-4);
      const ContactState& state = move(contact, p);
      const Vector3d wanted = support::project_by_trial(planes, p, 1e-13 * size);
      ASSERT_EQ(state.touching, contact.search().inside(p)) << hollow.name << " tick " << i;
      if (!state.touching) continue;
      ASSERT_LT((state.p_WP - wanted).norm(), 1e-9 * size) << hollow.name << " tick " << i;
      ASSERT_FALSE(contact.search().inside(state.p_WP)) << hollow.name << " tick " << i;
    }
  }
}

TEST(GodObjectCorners, ProxyMotionOutsideAConvexIsBounded) {
  // Projection onto a convex set never increases the distance of two points: no jump, and no
  // amplified tremor.
  const double size = 0.4;
  auto contact =
      GodObjectContact::build(support::block_around(support::icosphere(3, 0.05), size / 2)).value();
  support::Random random(8);
  Vector3d p(0, 0, 0);
  Vector3d goal = p;
  Vector3d p_before = p;
  Vector3d p_WP_before = p;
  move(contact, p);
  int both = 0;
  double depth_before = 0;
  Vector3d n_before(0, 0, 0);
  const int ticks = support::length_of_run(50000, 1000000);
  for (int i = 0; i < ticks; ++i) {
    if (i % 300 == 0) goal = random.direction() * random.uniform(0.03, 0.15);
    p += 0.03 * (goal - p) + random.in_box(1e-4);
    const ContactState& state = move(contact, p);
    const Vector3d p_WP = state.touching ? state.p_WP : p;
    ASSERT_LE((p_WP - p_WP_before).norm(), (p - p_before).norm() + 1e-11 * size) << i;
    if (state.touching && depth_before > 0) {
      // Tip and proxy each move by at most a step, and so does the vector between them.
      const double turn = (state.n_W - n_before).norm() * std::min(state.depth, depth_before);
      ASSERT_LE(turn, 2 * (p - p_before).norm() + 1e-11 * size) << i;
      ++both;
    }
    depth_before = state.touching ? state.depth : 0;
    n_before = state.n_W;
    p_before = p;
    p_WP_before = p_WP;
  }
  EXPECT_GT(both, ticks / 10);
}

TEST(GodObjectCorners, ProxySlidesOverAConvexEdge) {
  // A ridge along y, 120 degrees: the tip passes below it from one flank to the other.
  const TriangleMesh ridge = support::wedge(120 * kDegree, 0.1, 0.1);
  auto contact = GodObjectContact::build(ridge).value();
  move(contact, {0.12, 0.001, 0.2});
  int flanks = 0;
  Vector3d n_before(0, 0, 0);
  for (int i = 0; i <= 400; ++i) {
    const double z = 0.02 - 1e-4 * i;
    const ContactState& state = move(contact, {0.08, 0.001, z});
    ASSERT_TRUE(state.touching) << z;
    const double flank = std::sin(60 * kDegree);
    ASSERT_NEAR(std::abs(state.n_W.z()), 0.5, 1e-9) << z;
    ASSERT_NEAR(state.n_W.x(), flank, 1e-9) << z;
    if (i > 0 && (state.n_W - n_before).norm() > 1e-9) ++flanks;
    n_before = state.n_W;
  }
  EXPECT_EQ(flanks, 1);
}

TEST(GodObjectCorners, AreReachedInOneTickFromAnotherWall) {
  auto contact =
      GodObjectContact::build(support::block_around(support::box({0.05, 0.05, 0.05}), 0.2)).value();
  move(contact, {0, 0, 0});
  ASSERT_TRUE(move(contact, {-0.06, 0.01, 0.02}).touching);
  const ContactState& state = move(contact, {0.07, 0.08, -0.09});
  ASSERT_TRUE(state.touching);
  EXPECT_LT((state.p_WP - Vector3d(0.05, 0.05, -0.05)).norm(), 1e-12);
}

TEST(GodObjectCorners, ProxyLeavingOneWallStopsAtTheOther) {
  auto contact =
      GodObjectContact::build(support::block_around(support::box({0.05, 0.05, 0.05}), 0.2)).value();
  move(contact, {0, 0, 0});
  ASSERT_TRUE(move(contact, {-0.06, 0.01, 0.02}).touching);
  const ContactState& state = move(contact, {0.07, 0.01, 0.02});
  ASSERT_TRUE(state.touching);
  EXPECT_LT((state.p_WP - Vector3d(0.05, 0.01, 0.02)).norm(), 1e-12);
  EXPECT_NEAR(state.depth, 0.02, 1e-12);
  EXPECT_EQ(contact.counters().stopped, 1U);
}

TEST(GodObjectCorners, HaveOneConstraintPerFaceOfTheCorner) {
  auto contact =
      GodObjectContact::build(support::block_around(support::box({0.05, 0.05, 0.05}), 0.2)).value();
  move(contact, {0, 0, 0});
  struct Case {
    Vector3d p_WT;
    Vector3d p_WP;
  };
  for (const Case& c :
       {Case{{0.06, 0.01, 0.02}, {0.05, 0.01, 0.02}}, Case{{0.06, 0.09, 0.02}, {0.05, 0.05, 0.02}},
        Case{{0.06, 0.09, 0.08}, {0.05, 0.05, 0.05}},
        Case{{-0.06, -0.09, 0.08}, {-0.05, -0.05, 0.05}}}) {
    const ContactState& state = move(contact, c.p_WT);
    ASSERT_TRUE(state.touching);
    EXPECT_LT((state.p_WP - c.p_WP).norm(), 1e-12);
    EXPECT_LT((state.n_W - (c.p_WP - c.p_WT).normalized()).norm(), 1e-12);
  }
}

}  // namespace
}  // namespace thimble::render
