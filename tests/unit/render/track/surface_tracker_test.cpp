#include "track/surface_tracker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "mesh/closest_point.h"
#include "search/make_search.h"
#include "support/hard_case.h"
#include "support/meshes/reference_geometry.h"
#include "support/meshes/shapes.h"
#include "support/random.h"
#include "support/seed.h"
#include "track/mesh_contact.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

const ContactState& slide(MeshContact& contact, const Vector3d& p_WT) {
  driver::DeviceState state;
  state.p_WT = p_WT;
  return contact.update(state);
}

// Walks below a surface along a wandering path and counts lost contacts while the tip is inside.
struct Walk {
  int crossings = 0;
  int lost = 0;
  int inside = 0;
  std::uint16_t hops_max = 0;
  TrackerCounters counters;
};

Walk wander(const TriangleMesh& mesh, double depth, double step, int crossings_wanted) {
  MeshContact contact = MeshContact::build(mesh).value();
  std::mt19937_64 random(support::seed_of(11));
  std::normal_distribution<double> normal;
  const auto any = [&] { return Vector3d(normal(random), normal(random), normal(random)); };
  Walk walk;
  Vector3d heading = any();
  Vector3d p = support::corner(mesh, 0, 0) * 1.5;
  slide(contact, p);
  p = (support::corner(mesh, 0, 0) + support::corner(mesh, 0, 1) + support::corner(mesh, 0, 2)) /
          3 -
      depth * support::outward_normal(mesh, 0);
  slide(contact, p);
  for (int i = 0; walk.crossings < crossings_wanted && i < 20 * crossings_wanted; ++i) {
    const ContactState& state = contact.state();
    if (!state.touching) {
      // Only a tip outside may be free; the walk continues from the first triangle.
      ++walk.lost;
      p = support::corner(mesh, 0, 0) * 1.5;
      slide(contact, p);
      p = support::corner(mesh, 0, 0) * (1 - 1e-3);
      slide(contact, p);
      continue;
    }
    heading = (heading + 0.2 * any()).normalized();
    heading -= heading.dot(state.n_W) * state.n_W;
    // Back to the desired depth along the normal, and on along the surface.
    const Vector3d next = p + step * heading.normalized() + (state.depth - depth) * state.n_W * 0.5;
    const std::int32_t before = state.triangle;
    slide(contact, next);
    if (!contact.state().touching) {
      if (support::is_inside(mesh, next)) {
        ++walk.lost;
      } else {
        // The walk left over an edge: the desired path goes around it, slightly deeper.
        slide(contact, p);
        if (!contact.state().touching) ++walk.lost;
        heading = any();
        continue;
      }
    }
    walk.crossings += contact.state().triangle != before;
    walk.hops_max = std::max(walk.hops_max, contact.state().hops);
    p = next;
  }
  walk.counters = contact.counters();
  return walk;
}

TEST(HardCaseEdgeCrossing, ConvexMeshKeepsContact) {
  const Walk walk = wander(support::icosphere(4, 0.05), 0.0008, 0.001, 100000);
  EXPECT_GE(walk.crossings, 100000);
  EXPECT_EQ(walk.lost, 0);
  EXPECT_EQ(walk.counters.found_far, 0u);
  support::record_hard_case(22, "edge planes, ball, 1e5 crossings", "== contacts lost", walk.lost,
                            0, "1");
}

TEST(HardCaseEdgeCrossing, TorusKeepsContact) {
  const Walk walk = wander(support::torus(0.05, 0.02, 60, 30), 0.0008, 0.001, 100000);
  EXPECT_GE(walk.crossings, 100000);
  EXPECT_EQ(walk.lost, 0);
  EXPECT_EQ(walk.counters.found_far, 0u);
  support::record_hard_case(22, "edge planes, torus, 1e5 crossings", "== contacts lost", walk.lost,
                            0, "1");
}

TEST(HardCaseEdgeCrossing, BumpyMeshKeepsContact) {
  const Walk walk = wander(support::bumpy_sphere(4, 0.05, 0.3, 6), 0.0008, 0.001, 100000);
  EXPECT_GE(walk.crossings, 100000);
  EXPECT_EQ(walk.lost, 0);
  EXPECT_EQ(walk.counters.found_far, 0u);
  support::record_hard_case(22, "edge planes, bumps and dents, 1e5 crossings", "== contacts lost",
                            walk.lost, 0, "1");
}

TEST(SurfaceTracker, KeepsDepthWhenCrossingAnEdge) {
  const TriangleMesh mesh = support::bumpy_sphere(3, 0.05, 0.3, 6);
  const ContactMesh contact = ContactMesh::build(mesh).value();
  std::mt19937_64 random(support::seed_of(3));
  std::uniform_real_distribution<double> uniform(0, 1);
  for (std::int32_t t = 0; t < contact.triangle_count(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t other = contact.cell(t).neighbours[k];
      // Anywhere below the edge, then onto the plane where the tracker changes over.
      const double along = uniform(random);
      Vector3d p = (1 - along) * contact.position(t, k) + along * contact.position(t, (k + 1) % 3) -
                   0.004 * uniform(random) * contact.cell(t).face.n;
      const Plane& crossed = contact.edge_planes(t)[k];
      p -= crossed.distance(p - contact.origin()) * crossed.n;
      EXPECT_NEAR(contact.depth(t, p), contact.depth(other, p), 1e-16);
    }
  }
}

TEST(SurfaceTracker, DepthFollowsTheTipOverAnEdge) {
  MeshContact contact = MeshContact::build(support::icosphere(3, 0.05)).value();
  std::mt19937_64 random(support::seed_of(4));
  std::normal_distribution<double> normal;
  Vector3d p(0.049, 0.001, 0.002);
  slide(contact, {0.06, 0.001, 0.002});
  slide(contact, p);
  int single_hops = 0;
  for (int i = 0; i < 100000; ++i) {
    const double depth = contact.state().depth;
    const Vector3d next =
        0.0485 *
        (p + 0.0003 * Vector3d(normal(random), normal(random), normal(random))).normalized();
    const ContactState& state = slide(contact, next);
    ASSERT_TRUE(state.touching);
    if (state.hops <= 1) {
      ASSERT_LE(std::abs(state.depth - depth), (next - p).norm() + 1e-16);
      single_hops += state.hops;
    }
    p = next;
  }
  EXPECT_GT(single_hops, 1000);
}

TEST(SurfaceTracker, SettlesAtANeedleAndInAnAcuteWedge) {
  struct Case {
    TriangleMesh mesh;
    Vector3d entry, middle;
    double size;
  };
  std::mt19937_64 random(support::seed_of(6));
  std::normal_distribution<double> normal;
  for (const Case& now :
       {Case{support::needle(64, 0.05, 0.01), {0.0004, 0.0003, 0.045}, {0, 0, 0.047}, 0.002},
        Case{support::wedge(5 * std::numbers::pi / 180, 0.05, 0.05),
             {0.04, 0.001, 0.0001},
             {0.048, 0, 0},
             0.001}}) {
    MeshContact contact = MeshContact::build(now.mesh).value();
    int touched = 0;
    for (int i = 0; i < 20000; ++i) {
      if (!contact.state().touching) {
        slide(contact, now.entry + Vector3d(0.02, 0.01, 0.02));
        slide(contact, now.entry);
      }
      const Vector3d p =
          now.middle + now.size * Vector3d(normal(random), normal(random), normal(random));
      const ContactState& state = slide(contact, p);
      ASSERT_LT(state.hops, kHopsMax);  // that many end a walk that has not converged
      if (support::is_inside(now.mesh, p)) {
        ASSERT_TRUE(state.touching);
      }
      touched += state.touching;
    }
    EXPECT_GT(touched, 1000);
    EXPECT_EQ(contact.counters().long_walks, 0u);
  }
}

// Two shapes next to each other, `apart` m along x.
TriangleMesh pair_of(const TriangleMesh& shape, double apart) {
  TriangleMesh pair = shape;
  const auto shift = static_cast<std::int32_t>(shape.vertices.size());
  for (const Vector3d& p : shape.vertices) pair.vertices.push_back(p + apart * Vector3d::UnitX());
  for (const auto& [a, b, c] : shape.triangles) {
    pair.triangles.push_back({a + shift, b + shift, c + shift});
  }
  return pair;
}

// A tip that jumps far away inside, where neither a walk nor the patch around can follow: the
// nearest surface is touched, and the tip is below the reported triangle.
TEST(SurfaceTracker, FindsTheNearestSurfaceAfterAJump) {
  for (const TriangleMesh& shape : {pair_of(support::torus(0.035, 0.015, 60, 30), 0.12),
                                    pair_of(support::bumpy_sphere(4, 0.05, 0.3, 6), 0.15)}) {
    const ContactMesh mesh = ContactMesh::build(shape).value();
    const auto search = make_search(mesh);
    SurfaceTracker tracker(mesh, *search);
    support::Random random(9);
    std::uint64_t far = 0;
    for (int i = 0; i < 20000 && far < 300; ++i) {
      const Vector3d p = mesh.origin() + 2 * random.in_box(0.06);
      if (!search->inside(p)) continue;
      tracker.start(static_cast<std::int32_t>(random.bits() %
                                              static_cast<std::uint64_t>(mesh.triangle_count())));
      const TrackerStep step = tracker.follow(p);
      ASSERT_TRUE(step.touching);
      if (tracker.counters().found_far == far) continue;
      ++far;
      double nearest = INFINITY;
      const auto distance_to = [&](std::int32_t t) {
        return (closest_point(p, mesh.position(t, 0), mesh.position(t, 1), mesh.position(t, 2)) - p)
            .norm();
      };
      for (std::int32_t t = 0; t < mesh.triangle_count(); ++t) {
        if (mesh.depth(t, p) >= 0) nearest = std::min(nearest, distance_to(t));
      }
      ASSERT_NEAR(distance_to(tracker.active()), nearest, 1e-6 * nearest);
      ASSERT_GE(mesh.depth(tracker.active(), p), -mesh.depth_rounding());
    }
    EXPECT_GE(far, 20u);
  }
}

TEST(SurfaceTracker, NeverPopsThroughAThinPlate) {
  for (const double side : {1.0, -1.0}) {
    MeshContact contact = MeshContact::build(support::plate(0.1, 0.0002, 8)).value();
    std::mt19937_64 random(support::seed_of(8));
    std::normal_distribution<double> tremor(0, 0.0001);
    slide(contact, {0.003, 0.002, side * 0.01});
    for (int i = 0; i < 2000; ++i) {
      // Down to 8.5 mm, as for 8.5 N at 1 N/mm, and back to the surface.
      const double press = 0.0085 * std::sin(std::numbers::pi * (i + 0.5) / 2000);
      const Vector3d p(0.003 + tremor(random), 0.002 + tremor(random), side * (0.0001 - press));
      const ContactState& state = slide(contact, p);
      ASSERT_TRUE(state.touching) << i;
      ASSERT_NEAR(state.depth, press, 1e-15);
      ASSERT_EQ(state.n_W, Vector3d(0, 0, side));
    }
    EXPECT_FALSE(slide(contact, {0.003, 0.002, side * 0.0002}).touching);
  }
}

TEST(SurfaceTracker, IsBitIdenticalWithoutStoredPlanes) {
  for (const TriangleMesh& mesh :
       {support::bumpy_sphere(4, 0.05, 0.3, 9), support::torus(0.04, 0.015, 30, 12)}) {
    const ContactMesh kept = ContactMesh::build(mesh).value();
    const ContactMesh made = ContactMesh::build(mesh, {.keep_planes = false}).value();
    const auto search = make_search(kept);
    SurfaceTracker one(kept, *search), other(made, *search);
    support::Random random(8);
    one.start(0);
    other.start(0);
    Vector3d p = kept.position(0, 0) - 1e-3 * kept.cell(0).face.n;
    int hops = 0, held = 0;
    for (int i = 0; i < 20000; ++i) {
      const TrackerStep a = one.follow(p), b = other.follow(p);
      ASSERT_EQ(a.touching, b.touching);
      ASSERT_EQ(a.depth, b.depth);
      ASSERT_EQ(a.hops, b.hops);
      ASSERT_EQ(one.active(), other.active());
      ASSERT_EQ(one.normal(), other.normal());
      ASSERT_EQ(one.held().triangle, other.held().triangle);
      hops += a.hops;
      held += one.held().triangle >= 0 ? 1 : 0;
      // Back to 1 mm below the surface, and on; again from the start if contact was lost.
      if (a.touching) {
        p += (a.depth - 1e-3) * one.normal() + 2e-3 * random.direction();
      } else {
        const auto t = static_cast<std::int32_t>(random.bits() % mesh.triangles.size());
        one.start(t);
        other.start(t);
        p = kept.position(t, 1) - 1e-3 * kept.cell(t).face.n;
      }
    }
    EXPECT_GT(hops, 2000);
    EXPECT_GT(held, 0);
  }
}

}  // namespace
}  // namespace thimble::render
