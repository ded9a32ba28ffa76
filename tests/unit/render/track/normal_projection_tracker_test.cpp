#include "track/baseline/normal_projection_tracker.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "search/baseline/linear_search.h"
#include "support/contact_walk.h"
#include "support/meshes/reference_geometry.h"
#include "support/meshes/shapes.h"
#include "support/seed.h"
#include "track/mesh_contact.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;
using NormalProjectionContact = TrackedContact<NormalProjectionTracker>;

// Puts the tip below a point near the middle of every convex edge and moves it out of the active
// triangle's cell. Returns the largest depth jump and the largest error of the predicted jump.
template <class Tracker>
struct EdgeJumps {
  double jump = 0;
  double law_error = 0;
  int edges = 0;

  explicit EdgeJumps(const ContactMesh& mesh, double depth) {
    const LinearSearch search(mesh);
    for (std::int32_t t = 0; t < mesh.triangle_count(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        const Vector3d& n = mesh.cell(t).face.n;
        const Vector3d& n_next = mesh.cell(mesh.cell(t).neighbours[k]).face.n;
        const Vector3d middle = (mesh.position(t, k) + mesh.position(t, (k + 1) % 3)) / 2;
        const Vector3d out =
            (mesh.position(t, (k + 1) % 3) - mesh.position(t, k)).cross(n).normalized();
        if (!(out.dot(n_next) > 0)) continue;  // concave
        // The end of the cell: perpendicular below the edge for 4a, on the edge plane for 4b.
        const Plane& plane = mesh.edge_planes(t)[k];
        const Vector3d below = middle - depth * n;
        const double to_plane = plane.distance(below - mesh.origin()) / -plane.n.dot(out);
        const bool projects = std::is_same_v<Tracker, NormalProjectionTracker>;
        const Vector3d border = projects ? below : Vector3d(below + to_plane * out);
        Tracker tracker(mesh, search);
        tracker.start(t);
        const double before = tracker.follow(border - 1e-9 * out).depth;
        const TrackerStep after = tracker.follow(border + 1e-9 * out);
        if (after.hops != 1) continue;
        const double change = std::abs(after.depth - before);
        jump = std::max(jump, change);
        law_error = std::max(law_error, std::abs(change - depth * (1 - n.dot(n_next))));
        ++edges;
      }
    }
  }
};

TEST(NormalProjectionTracker, JumpsInDepthByItsLaw) {
  const double depth = 0.001;
  const ContactMesh mesh = ContactMesh::build(support::icosphere(2, 0.03)).value();
  const EdgeJumps<NormalProjectionTracker> projected(mesh, depth);
  const EdgeJumps<SurfaceTracker> edge_planes(mesh, depth);
  EXPECT_GT(projected.edges, 900);
  EXPECT_GT(edge_planes.edges, 900);
  EXPECT_LT(projected.law_error, 1e-9);  // twice the step over the border, times the slope
  EXPECT_GT(projected.jump, 0.015 * depth);
  // The step over the border itself is 2e-9 long.
  EXPECT_LT(edge_planes.jump, 2e-9);
  std::cout << "Depth jump over an edge at 1 mm, 4a: " << 1e6 * projected.jump
            << " um; 4b: below the step of " << 2e-3 << " um\n";
}

TEST(NormalProjectionTracker, TipOnTheSurfaceIsInContact) {
  const ContactMesh mesh = ContactMesh::build(support::box({1, 1, 1})).value();
  const LinearSearch search(mesh);
  for (std::int32_t t = 0; t < mesh.triangle_count(); ++t) {
    const Vector3d middle =
        0.5 * mesh.position(t, 0) + 0.25 * mesh.position(t, 1) + 0.25 * mesh.position(t, 2);
    NormalProjectionTracker tracker(mesh, search);
    tracker.start(t);
    const TrackerStep on = tracker.follow(middle);
    EXPECT_TRUE(on.touching) << t;
    EXPECT_EQ(on.depth, 0);
    EXPECT_FALSE(tracker.follow(middle + 1e-12 * mesh.cell(t).face.n).touching) << t;
  }
}

TEST(NormalProjectionTracker, LeavesGapsBelowConcaveEdges) {
  const TriangleMesh shape = support::bumpy_sphere(3, 0.05, 0.3, 6);
  const auto gaps_and_losses = [&shape](auto contact) {
    support::Stroll stroll(contact, shape, 0.002, 0.0005, support::seed_of(7));
    std::uint64_t lost = 0;
    for (int i = 0; i < 20000 && stroll.in_contact(); ++i) {
      if (!stroll.step()) lost += contact.search().inside(stroll.to);
    }
    return std::pair{contact.counters().cycles, lost};
  };
  const auto projected = gaps_and_losses(NormalProjectionContact::build(shape).value());
  const auto edge_planes = gaps_and_losses(MeshContact::build(shape).value());
  const auto offset = gaps_and_losses(OffsetContact::build(shape).value());
  EXPECT_GT(projected.first, 100u);
  EXPECT_LT(edge_planes.first, projected.first / 10);
  EXPECT_EQ(offset.first, 0u);
  EXPECT_EQ(edge_planes.second, 0u);
  EXPECT_EQ(offset.second, 0u);
  std::cout << "Ticks in a gap of 20000, 4a: " << projected.first << ", 4b: " << edge_planes.first
            << ", offset: " << offset.first << "; contact lost inside, 4a: " << projected.second
            << "\n";
}

TEST(NormalProjectionTracker, AgreesWithEdgePlanesOnFlatGround) {
  auto projected = NormalProjectionContact::build(support::plate(0.1, 0.02, 8)).value();
  auto edge_planes = MeshContact::build(support::plate(0.1, 0.02, 8)).value();
  support::Random random(8);
  support::move_tip(projected, {0.003, 0.002, 0.02});
  support::move_tip(edge_planes, {0.003, 0.002, 0.02});
  for (int i = 0; i < 5000; ++i) {
    const Vector3d p{random.uniform(-0.035, 0.035), random.uniform(-0.035, 0.035),
                     random.uniform(0.005, 0.0099)};
    const ContactState& a = support::move_tip(projected, p);
    const ContactState& b = support::move_tip(edge_planes, p);
    ASSERT_TRUE(a.touching && b.touching);
    ASSERT_NEAR(a.depth, b.depth, 1e-16);
    ASSERT_EQ(a.n_W, b.n_W);
  }
}

}  // namespace
}  // namespace thimble::render
