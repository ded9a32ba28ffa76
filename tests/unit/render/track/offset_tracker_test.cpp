#include "track/offset_tracker.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>

#include "support/contact_walk.h"
#include "support/hard_case.h"
#include "support/heap_guard.h"
#include "support/long_form.h"
#include "support/meshes/reference_geometry.h"
#include "support/meshes/shapes.h"
#include "support/seed.h"
#include "thimble/render/mesh/check_mesh.h"
#include "thimble/render/mesh/mesh_file.h"
#include "track/blended.h"
#include "track/mesh_contact.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

ContactMesh prepared_mesh(const TriangleMesh& mesh) {
  return ContactMesh::build(mesh).value();
}

Vector3d sunk(const ContactMesh& mesh, const SmoothNormals& normals, std::int32_t t,
              const Vector3d& weights, double depth) {
  Vector3d p = Vector3d::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    p += weights[static_cast<Eigen::Index>(k)] *
         (mesh.position(t, k) - depth * normals.corners(t)[k]);
  }
  return p;
}

Vector3d any_weights(support::Random& random) {
  const Vector3d w{random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1)};
  return w / w.sum();
}

TEST(OffsetTrianglePlace, RecoversThePlaceAndDepthOfATip) {
  support::Random random(1);
  for (const TriangleMesh& shape :
       {support::icosphere(2, 0.05), support::torus(0.05, 0.02, 40, 20),
        support::bumpy_sphere(4, 0.05, 0.3, 6), support::box({0.05, 0.02, 0.03})}) {
    const ContactMesh mesh = prepared_mesh(shape);
    const SmoothNormals normals(mesh);
    for (int i = 0; i < 20000; ++i) {
      const auto t = static_cast<std::int32_t>(random.bits() %
                                               static_cast<std::uint64_t>(mesh.triangle_count()));
      const Vector3d weights = any_weights(random);
      const double depth = random.uniform(-0.001, 0.003);
      const double near = random.uniform(-0.001, 0.003);
      const OffsetTrianglePlace closest = find_offset_triangle_place(
          mesh, normals, t, sunk(mesh, normals, t, weights, depth), near);
      ASSERT_TRUE(closest.found);
      ASSERT_NEAR(closest.depth, depth, 1e-13);
      ASSERT_LT((closest.weights - weights).norm(), 1e-10);
    }
  }
}

TEST(OffsetTrianglePlace, AgreesOnBothSidesOfASmoothEdge) {
  support::Random random(2);
  const ContactMesh mesh = prepared_mesh(support::bumpy_sphere(4, 0.05, 0.3, 6));
  const SmoothNormals normals(mesh);
  for (std::int32_t t = 0; t < mesh.triangle_count(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (normals.crease(t, k)) continue;
      Vector3d weights = any_weights(random);
      weights[static_cast<Eigen::Index>((k + 2) % 3)] = 0;
      weights /= weights.sum();
      const double depth = random.uniform(0, 0.003);
      const Vector3d p = sunk(mesh, normals, t, weights, depth);
      const OffsetTrianglePlace there =
          find_offset_triangle_place(mesh, normals, mesh.cell(t).neighbours[k], p, 0.001);
      ASSERT_TRUE(there.found);
      ASSERT_NEAR(there.depth, depth, 1e-13);
      ASSERT_NEAR(there.weights.minCoeff(), 0, 1e-10);
    }
  }
}

TEST(OffsetTrianglePlace, ReportsAnInvertedOffsetTriangle) {
  const ContactMesh mesh = prepared_mesh(support::icosphere(2, 0.05));
  const SmoothNormals normals(mesh);
  EXPECT_TRUE(find_offset_triangle_place(mesh, normals, 0,
                                         sunk(mesh, normals, 0, {0.3, 0.3, 0.4}, 0.045), 0.044)
                  .found);
  EXPECT_FALSE(find_offset_triangle_place(mesh, normals, 0,
                                          sunk(mesh, normals, 0, {0.3, 0.3, 0.4}, 0.06), 0.06)
                   .found);
}

// Returns the maximum turn of the normal over a triangle, offset by `depth`, per metre of the tip's
// path. The normal is S / |S| with S = sum w_k n_k. Along a path dS = sum dw_k n_k with sum dw_k =
// 0, and w_k grows by at most 1 / h_k per metre across, with h_k the offset triangle's height; by 1
// / cos more if the path downwards is inclined to the offset plane. So |dS| <= 3/2 max|n_i - n_j| /
// (h cos).
double turn_per_metre(const ContactMesh& mesh, const SmoothNormals& normals, std::int32_t t,
                      double depth) {
  const auto& n = normals.corners(t);
  std::array<Vector3d, 3> y;
  for (std::size_t k = 0; k < 3; ++k) y[k] = mesh.position(t, k) - depth * n[k];
  const Vector3d area = (y[1] - y[0]).cross(y[2] - y[0]);
  double longest = 0;
  double spread = 0;
  double min_cosine = 1;
  for (std::size_t k = 0; k < 3; ++k) {
    longest = std::max(longest, (y[(k + 1) % 3] - y[k]).norm());
    spread = std::max(spread, (n[(k + 1) % 3] - n[k]).norm());
    min_cosine = std::min(min_cosine, n[k].dot(area.normalized()));
  }
  const double shortest_sum = std::sqrt(std::max(1 - spread * spread, 0.0));
  return 1.5 * spread / (area.norm() / longest * min_cosine * shortest_sum);
}

struct Smoothness {
  int checked = 0;
  int hops = 0;
  int lost = 0;
  double worst_of_bound = 0;  // largest turn as a fraction of the derived bound
  double worst_depth = 0;     // largest change of depth as a fraction of the path
  double worst_turn = 0;      // largest |dn| L / |dp|
};

// Walks and compares each tick with the derived bound of the triangles where it began and ended.
// Omits ticks that cross creases or more than two triangles.
Smoothness stroll_smoothly(const TriangleMesh& shape, double depth, double step, int ticks) {
  OffsetContact contact = OffsetContact::build(shape).value();
  const ContactMesh& mesh = contact.mesh();
  const SmoothNormals& normals = *contact.tracker().smooth_normals();
  const double edge_length = check_mesh(shape).edge_mean;
  support::Stroll stroll(contact, shape, depth, step, support::seed_of(5));
  Smoothness result;
  for (int i = 0; i < ticks; ++i) {
    if (!stroll.step()) {
      result.lost += contact.search().inside(stroll.to);
      if (!stroll.in_contact()) break;
      continue;
    }
    const ContactState& before = stroll.before;
    const ContactState& after = stroll.after;
    result.hops += after.hops;
    if (after.hops > 1) continue;
    bool smooth = true;
    for (const std::int32_t t : {before.triangle, after.triangle}) {
      for (std::size_t k = 0; k < 3; ++k) {
        // Also a crease at a corner that the path may cross.
        smooth = smooth && !normals.crease(t, k) &&
                 !normals.crease(mesh.cell(t).neighbours[k], 0) &&
                 !normals.crease(mesh.cell(t).neighbours[k], 1) &&
                 !normals.crease(mesh.cell(t).neighbours[k], 2);
      }
    }
    const double deepest = 1.2 * std::max(before.depth, after.depth);
    const double bound = std::max(turn_per_metre(mesh, normals, before.triangle, deepest),
                                  turn_per_metre(mesh, normals, after.triangle, deepest));
    if (!smooth || !(bound > 0)) continue;
    ++result.checked;
    const double turn = (after.n_W - before.n_W).norm();
    result.worst_of_bound = std::max(result.worst_of_bound, turn / (bound * stroll.moved));
    result.worst_turn = std::max(result.worst_turn, turn * edge_length / stroll.moved);
    result.worst_depth =
        std::max(result.worst_depth, std::abs(after.depth - before.depth) / stroll.moved);
  }
  return result;
}

void report(const char* name, double step, const Smoothness& s) {
  std::cout << name << ", steps of " << 1e6 * step << " um: |dn| L / |dp| <= " << s.worst_turn
            << ", " << s.worst_of_bound
            << " of the derived bound; |d depth| / |dp| <= " << s.worst_depth << "; " << s.hops
            << " hops\n";
}

TEST(OffsetTracker, PathBoundsTheNormalOnSmoothShapes) {
  const int ticks = support::long_form() ? 1000000 : 60000;
  struct Case {
    const char* name;
    TriangleMesh shape;
    double turn;  // C of |dn| <= C |dp| / L, measured with steps of 1 to 300 um, rounded up
  };
  for (const Case& now : {Case{"icosphere", support::icosphere(3, 0.05), 0.2},
                          Case{"torus", support::torus(0.05, 0.02, 60, 30), 0.35},
                          Case{"bumpy sphere", support::bumpy_sphere(4, 0.05, 0.3, 6), 1.5}}) {
    for (const double step : {3e-4, 3e-5, 3e-6}) {
      const Smoothness s = stroll_smoothly(now.shape, 0.001, step, ticks);
      EXPECT_EQ(s.lost, 0);
      EXPECT_GT(s.checked, ticks / 2);
      EXPECT_GT(s.hops, 10);
      EXPECT_LE(s.worst_of_bound, 1);
      EXPECT_LE(s.worst_turn, now.turn);
      EXPECT_LE(s.worst_depth, 1.01);
      report(now.name, step, s);
    }
  }
}

TEST(OffsetTracker, PathBoundsTheNormalOnTheElephant) {
  const auto file = std::filesystem::path(THIMBLE_MESHES) / "elephant.off";
  if (!std::filesystem::exists(file)) {
    GTEST_SKIP() << "Needs the scanned meshes: run app/fetch_meshes.sh (it downloads them)";
  }
  const TriangleMesh scan = load_mesh(file).value();
  const MeshFindings findings = check_mesh(scan);
  const double scale = 0.1 / (findings.box_max - findings.box_min).maxCoeff();
  const TriangleMesh shape = placed(scan, scale, Eigen::Matrix3d::Identity(), Vector3d::Zero());
  const int ticks = support::long_form() ? 1000000 : 100000;
  for (const double step : {3e-5, 3e-6}) {
    const Smoothness s = stroll_smoothly(shape, 0.0001, step, ticks);
    EXPECT_EQ(s.lost, 0);
    EXPECT_GT(s.checked, ticks / 4);
    EXPECT_LE(s.worst_of_bound, 1);
    report("elephant", step, s);
  }
}

TEST(OffsetTracker, IsContinuousThroughEveryVertexAtDepth) {
  support::Random random(6);
  const TriangleMesh shape = support::bumpy_sphere(3, 0.05, 0.3, 6);
  OffsetContact contact = OffsetContact::build(shape).value();
  const ContactMesh& mesh = contact.mesh();
  const SmoothNormals& normals = *contact.tracker().smooth_normals();
  for (std::int32_t t = 0; t < mesh.triangle_count(); ++t) {
    bool smooth = true;
    for (const std::int32_t around : mesh.fan(mesh.corners(t)[0])) {
      for (std::size_t k = 0; k < 3; ++k) smooth = smooth && !normals.crease(around, k);
    }
    if (!smooth) continue;
    const Vector3d& n = normals.corners(t)[0];
    const double depth = 0.001;
    const Vector3d below = mesh.position(t, 0) - depth * n;
    support::move_tip(contact, {std::nan(""), 0, 0});  // a new contact
    support::move_tip(contact, mesh.position(t, 0) + depth * n);
    for (int i = 0; i < 20; ++i) {
      const ContactState& state = support::move_tip(contact, below + 1e-9 * random.direction());
      ASSERT_TRUE(state.touching);
      // 1e-9 m over triangles whose normals differ by less than 1 over some mm.
      ASSERT_LT((state.n_W - n).norm(), 1e-6);
      ASSERT_NEAR(state.depth, depth, 1e-8);
    }
  }
}

TEST(HardCaseEdgeCrossing, OffsetTrackerDoesNotJump) {
  // The force changes per tick by at most 5 % and by the change of the path.
  int all_crossings = 0, all_lost = 0;
  const int wanted = support::long_form() ? 100000 : 10000;
  const double depth = 0.0008;
  const double step = 0.0002;
  for (const TriangleMesh& shape : {support::icosphere(4, 0.05), support::torus(0.05, 0.02, 60, 30),
                                    support::bumpy_sphere(4, 0.05, 0.3, 6)}) {
    Blended<OffsetContact, Phong, CurvedDepth> contact(OffsetContact::build(shape).value());
    support::Stroll stroll(contact, shape, depth, step, support::seed_of(9));
    int crossings = 0;
    int lost = 0;
    for (int i = 0; crossings < wanted && i < 200 * wanted; ++i) {
      const bool inside_step = stroll.step();
      if (!inside_step) {
        lost += contact.contact().search().inside(stroll.to);
        ASSERT_TRUE(stroll.in_contact());
        continue;
      }
      crossings += stroll.after.hops;
      const Vector3d force_before = stroll.before.depth * stroll.before.n_W;
      const Vector3d force_after = stroll.after.depth * stroll.after.n_W;
      // Depth may change with the path, twice as fast while the curvature correction begins.
      ASSERT_LE((force_after - force_before).norm(), 0.05 * depth + 2 * stroll.moved);
    }
    all_crossings += crossings;
    all_lost += lost;
    EXPECT_GE(crossings, wanted);
    EXPECT_EQ(lost, 0);
    EXPECT_EQ(contact.counters().found_far, 0u);
    EXPECT_EQ(contact.counters().long_walks, 0u);
  }
  const char* const kShapes = "ball, torus and bumps, 1e4 crossings each (long form: 1e5)";
  support::record_hard_case(22, kShapes, "== contacts lost", all_lost, 0, "1");
  EXPECT_GE(all_crossings, 3 * wanted);
}

TEST(HardCaseFastStroke, TrackersMatchBruteForce) {
  // 2 m/s at 1 kHz over triangles of 0.3 mm.
  std::uint16_t max_flat_hops = 0;
  const TriangleMesh shape = support::icosphere(5, 0.008);
  OffsetContact contact = OffsetContact::build(shape).value();
  MeshContact edge_planes = MeshContact::build(shape).value();
  const ContactMesh& mesh = contact.mesh();
  const SmoothNormals& normals = *contact.tracker().smooth_normals();
  support::Random random(10);
  Vector3d p(0.0075, 0.0001, 0.0002);
  support::move_tip(contact, 2 * p);
  support::move_tip(edge_planes, 2 * p);
  support::move_tip(contact, p);
  support::move_tip(edge_planes, p);
  Vector3d axis = random.direction();
  std::uint16_t hops_max = 0;
  const int ticks = support::long_form() ? 5000 : 300;
  for (int i = 0; i < ticks; ++i) {
    axis = (axis + 0.3 * random.direction()).normalized();
    axis = (axis - axis.dot(p.normalized()) * p.normalized()).normalized();
    p = Eigen::AngleAxisd(0.002 / 0.0075, axis) * p;
    const ContactState& state = support::move_tip(contact, p);
    const ContactState& flat = support::move_tip(edge_planes, p);
    ASSERT_TRUE(state.touching);
    ASSERT_TRUE(flat.touching);
    hops_max = std::max(hops_max, state.hops);
    int holding = 0;
    bool flat_holds = false;
    bool any_flat_holds = false;
    for (std::int32_t t = 0; t < mesh.triangle_count(); ++t) {
      // The far side of the sphere, where cells extend through the middle, is skipped.
      if (!(mesh.cell(t).face.n.dot(p) > 0.5 * p.norm())) continue;
      const OffsetTrianglePlace closest = find_offset_triangle_place(mesh, normals, t, p, 0);
      if (closest.found && closest.weights.minCoeff() > 1e-9) {
        ++holding;
        ASSERT_EQ(t, state.triangle);
      }
      bool holds = true;
      for (const Plane& plane : mesh.edge_planes(t)) {
        holds = holds && plane.distance(p - mesh.origin()) >= 0;
      }
      any_flat_holds = any_flat_holds || holds;
      flat_holds = flat_holds || (holds && t == flat.triangle);
    }
    ASSERT_LE(holding, 1);
    ASSERT_TRUE(holding == 1 || contact.tracker().weights(p).minCoeff() < 1e-8);
    ASSERT_TRUE(flat_holds || !any_flat_holds);
    max_flat_hops = std::max(max_flat_hops, flat.hops);
  }
  EXPECT_LT(hops_max, kHopsMax / 2);
  support::record_hard_case(26, "offset tracker, 300 ticks (long form: 5000): all as brute force",
                            "< most hops in a tick", hops_max, kHopsMax, "1");
  EXPECT_LT(max_flat_hops, kHopsMax);
  support::record_hard_case(26, "edge planes, the same", "< most hops in a tick", max_flat_hops,
                            kHopsMax, "1");
}

TEST(HardCaseEdgeCrossing, OffsetTrackerKeepsCreasesExact) {
  double worst = 0;
  OffsetContact contact = OffsetContact::build(support::box({0.05, 0.05, 0.05})).value();
  support::move_tip(contact, {0.01, 0.02, 0.06});
  for (int i = 0; i <= 1000; ++i) {
    // Around the upper edge 1 mm inside: from the upper face to the one at +x.
    const double along = 0.0975 * i / 1000;
    const double x = std::min(0.0, along - 0.0485) + 0.049;
    const double z = 0.049 - std::max(0.0, along - 0.0490);
    const ContactState& state = support::move_tip(contact, {x, 0.02, z});
    ASSERT_TRUE(state.touching);
    const bool upper = 0.05 - z < 0.05 - x;
    if (std::abs(x - z) < 1e-9) continue;
    const Vector3d wanted = upper ? Vector3d(0, 0, 1) : Vector3d(1, 0, 0);
    ASSERT_LT((state.n_W - wanted).norm(), 1e-15) << x << " " << z;
    ASSERT_NEAR(state.depth, upper ? 0.05 - z : 0.05 - x, 1e-15);
    worst = std::max(worst, (state.n_W - wanted).norm());
  }
  support::record_hard_case(22, "crease of 90 degrees", "<= error of direction on both sides",
                            worst, 1e-12, "rad");
  EXPECT_LT((contact.state().n_W - Vector3d(1, 0, 0)).norm(), 1e-15);
}

TEST(OffsetTracker, KeepsContactAtAnyDepth) {
  support::Random random(11);
  for (const TriangleMesh& shape :
       {support::icosphere(3, 0.05), support::torus(0.05, 0.02, 40, 20),
        support::bumpy_sphere(3, 0.05, 0.3, 6), support::needle(64, 0.05, 0.01),
        support::wedge(0.09, 0.05, 0.05)}) {
    OffsetContact contact = OffsetContact::build(shape).value();
    int touched = 0;
    double deepest = 0;
    const auto walk = [&] {
      Vector3d p(0.2, 0.2, 0.2);
      for (int i = 0; i < 20000; ++i) {
        // Moved half-way between the middle and a vertex.
        const Vector3d middle = (contact.mesh().box_min() + contact.mesh().box_max()) / 2;
        p += 0.002 * random.direction() + 0.02 * ((middle + contact.mesh().position(0, 0)) / 2 - p);
        const bool was_free = !contact.state().touching;
        const ContactState& state = support::move_tip(contact, p);
        if (!state.touching) {
          // A tip that entered a second time in the tick that ended a contact waits outside.
          if (!was_free) {
            ASSERT_FALSE(contact.search().inside(p));
          }
          continue;
        }
        ++touched;
        deepest = std::max(deepest, state.depth);
        ASSERT_GE(state.depth, 0);
        ASSERT_NEAR(state.n_W.norm(), 1, 1e-12);
        ASSERT_LT(state.hops, kHopsMax);  // that many end a walk that has not converged
      }
    };
    walk();
    EXPECT_GT(touched, 200);
    std::cout << contact.mesh().triangle_count() << " triangles: deepest press " << 1e3 * deepest
              << " mm, found again " << contact.counters().found_near << " near, "
              << contact.counters().found_far << " far, " << contact.counters().cycles
              << " cycles\n";
    EXPECT_EQ(support::heap_calls_of([&] { support::move_tip(contact, {1, 1, 1}); }), 0);
  }
}

TEST(OffsetTracker, ReturnsToTheNearSideAfterAJump) {
  // A tip that jumps from one side of a ball to the other within a tick is followed over the
  // surface, 64 triangles per tick, and does not stay on the far side's cells that extend through
  // the middle.
  const TriangleMesh shape = support::bumpy_sphere(6, 0.05, 0.1, 6);
  OffsetContact contact = OffsetContact::build(shape).value();
  const Vector3d p = 0.0485 * Vector3d(1, 0.1, 0.1).normalized();
  support::move_tip(contact, 2 * p);
  support::move_tip(contact, p);
  const double depth = contact.state().depth;
  support::Random random(13);
  for (int i = 0; i < 100; ++i) {
    support::move_tip(contact, 0.04 * random.direction());
    ASSERT_TRUE(contact.state().touching);
    for (int tick = 0; tick < 20; ++tick) support::move_tip(contact, p);
    ASSERT_NEAR(contact.state().depth, depth, 1e-12);
  }
}

TEST(OffsetTracker, BothFacesHoldTheTipBelowAConcaveCrease) {
  // A bar along y with an L-shaped section: the notch's faces meet in a line through the origin.
  TriangleMesh shape;
  const double outline[6][2] = {{-0.02, -0.02}, {0.03, -0.02}, {0.03, 0},
                                {0, 0},         {0, 0.03},     {-0.02, 0.03}};
  for (const double y : {-0.02, 0.02}) {
    for (const auto& corner : outline) shape.vertices.emplace_back(corner[0], y, corner[1]);
  }
  for (int i = 0; i < 6; ++i) {
    const int j = (i + 1) % 6;
    shape.triangles.push_back({i, j, j + 6});
    shape.triangles.push_back({i, j + 6, i + 6});
  }
  for (const auto& [a, b, c] : {std::array{3, 0, 1}, {3, 1, 2}, {3, 4, 5}, {3, 5, 0}}) {
    shape.triangles.push_back({c, b, a});
    shape.triangles.push_back({a + 6, b + 6, c + 6});
  }
  OffsetContact contact = OffsetContact::build(shape).value();
  support::move_tip(contact, {0.01, 0.001, 0.01});
  support::move_tip(contact, {0.01, 0.001, -0.002});
  int up = 0;
  int sideways = 0;
  int both = 0;
  double depth_before = contact.state().depth;
  // 2 mm below the notch, from below one of its faces to behind the other and on to the back.
  for (int i = 0; i <= 1000; ++i) {
    const double along = 0.02 * i / 1000;
    const Vector3d p = along < 0.012 ? Vector3d(0.01 - along, 0.001, -0.002)
                                     : Vector3d(-0.002, 0.001, along - 0.014);
    const ContactState& state = support::move_tip(contact, p);
    ASSERT_TRUE(state.touching);
    // Between their normals, the crease is the closest point of both faces.
    const Vector3d to(std::max(-p.x(), 0.0), 0, std::max(-p.z(), 0.0));
    ASSERT_NEAR(state.depth, to.norm(), 1e-15) << p.transpose();
    ASSERT_LT((state.depth * state.n_W - to).norm(), 1e-15) << p.transpose();
    up += p.x() >= 0;
    sideways += p.z() >= 0;
    both += p.x() < 0 && p.z() < 0;
    ASSERT_LE(std::abs(state.depth - depth_before), 2.1e-5);
    depth_before = state.depth;
  }
  EXPECT_GT(up, 300);
  EXPECT_GT(sideways, 200);
  EXPECT_GT(both, 100);
}

TEST(OffsetTracker, IsIndependentOfScaleAndOrigin) {
  const TriangleMesh base = support::bumpy_sphere(3, 0.05, 0.3, 6);
  struct Variant {
    double scale;
    double offset;
    double tolerance;  // of lengths of 1 mm; vertices at 1e4 are rounded to 1e-12
  };
  for (const Variant& v : {Variant{1e-6, 0, 1e-9}, Variant{1e3, 0, 1e-9}, Variant{1, 1e4, 1e-7}}) {
    OffsetContact reference = OffsetContact::build(base).value();
    const Vector3d shift(v.offset, -v.offset, v.offset);
    OffsetContact variant =
        OffsetContact::build(placed(base, v.scale, Eigen::Matrix3d::Identity(), shift)).value();
    support::Stroll stroll(reference, base, 0.001, 0.0003, support::seed_of(12));
    bool started = false;
    for (int i = 0; i < 5000; ++i) {
      if (!stroll.step()) break;
      if (!started) {
        // In at the position of the walk, straight from outside.
        const Vector3d out = stroll.to + 2 * stroll.after.depth * stroll.after.n_W;
        support::move_tip(variant, {std::nan(""), 0, 0});
        support::move_tip(variant, v.scale * out + shift);
        started = true;
      }
      const ContactState& found = support::move_tip(variant, v.scale * stroll.to + shift);
      ASSERT_TRUE(found.touching);
      ASSERT_NEAR(found.depth / v.scale, stroll.after.depth, v.tolerance * 0.001);
      ASSERT_LT((found.n_W - stroll.after.n_W).norm(), v.tolerance);
    }
    EXPECT_TRUE(started);
  }
}

}  // namespace
}  // namespace thimble::render
