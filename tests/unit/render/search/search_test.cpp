#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "search/baseline/linear_search.h"
#include "search/free_space.h"
#include "search/grid_search.h"
#include "search/make_search.h"
#include "search/tree_search.h"
#include "support/contact_walk.h"
#include "support/heap_guard.h"
#include "support/long_form.h"
#include "support/meshes/reference_geometry.h"
#include "support/meshes/shapes.h"
#include "support/random.h"
#include "support/seed.h"
#include "thimble/render/mesh/mesh_file.h"
#include "track/god_object.h"
#include "track/mesh_contact.h"

// Every search over the same surface gives the same answers.

namespace thimble::render {
namespace {

using Eigen::Vector3d;

int scaled_count(int full, int brief) {
  return support::long_form() ? full : brief;
}

// One surface with all its searches; the linear one is the reference.
template <class Surface>
struct Searches {
  explicit Searches(const Surface& surface) : linear(surface), grid(surface), tree(surface) {}

  void expect_same_entry(const Vector3d& from, const Vector3d& to) {
    const Entry wanted = linear.first_entry(from, to);
    for (const ContactSearch* search : others()) {
      const Entry found = search->first_entry(from, to);
      ASSERT_EQ(found.triangle, wanted.triangle) << from.transpose() << " to " << to.transpose();
      // Bit-identical: the same numbers in the same order.
      ASSERT_EQ(found.parameter, wanted.parameter);
    }
    entries += wanted.triangle >= 0;
  }

  void expect_same_side(const Vector3d& p) {
    const bool wanted = linear.inside(p);
    for (const ContactSearch* search : others()) ASSERT_EQ(search->inside(p), wanted);
    insides += wanted;
  }

  void expect_same_closest(const Vector3d& p, double radius) {
    const SurfacePoint wanted = linear.closest(p, radius);
    for (const ContactSearch* search : others()) {
      const SurfacePoint found = search->closest(p, radius);
      ASSERT_EQ(found.triangle >= 0, wanted.triangle >= 0) << p.transpose();
      if (wanted.triangle < 0) continue;
      ASSERT_NEAR(found.distance, wanted.distance, 1e-12 * (1 + p.norm()));
      ASSERT_NEAR((found.p_W - p).norm(), wanted.distance, 1e-12 * (1 + p.norm()));
    }
  }

  std::vector<const ContactSearch*> others() const { return {&grid, &tree}; }

  LinearSearchOver<Surface> linear;
  GridSearch<Surface> grid;
  TreeSearch<Surface> tree;
  int entries = 0, insides = 0;
};

// Segments of a tick, of a hand's breadth and across everything, around a mesh of size 2 * half.
template <class Surface>
void expect_same_on_random_segments(const Surface& surface, const Vector3d& middle, double half,
                                    int count, std::uint64_t seed) {
  Searches<Surface> searches(surface);
  support::Random random(support::seed_of(seed));
  for (int i = 0; i < count; ++i) {
    const double reach = i % 3 == 0 ? 1.5 * half : i % 3 == 1 ? 0.1 * half : 0.003 * half;
    Vector3d from = middle + random.in_box(1.2 * half);
    if (i % 2 == 0) {
      // Near the surface, where ticks happen.
      const auto t = static_cast<std::int32_t>(
          random.bits() % static_cast<std::uint64_t>(surface.triangle_count()));
      from = surface.position(t, random.bits() % 3) + random.in_box(reach);
    }
    const Vector3d to = from + random.in_box(reach);
    searches.expect_same_entry(from, to);
    if (i % 16 == 0) searches.expect_same_side(from);
    if (i % 8 == 0) searches.expect_same_closest(from, i % 16 == 0 ? 0.02 * half : 10 * half);
    if (::testing::Test::HasFatalFailure()) return;
  }
  EXPECT_GT(searches.entries, count / 200);
}

std::vector<TriangleMesh> shapes() {
  return {support::bumpy_sphere(3, 0.05, 0.3, 6), support::torus(0.035, 0.015, 40, 20),
          support::plate(0.1, 0.001, 6), support::needle(64, 0.08, 0.01),
          support::wedge(0.09, 0.1, 0.05)};
}

// A plate of slivers: cells much longer than wide (case 27).
TriangleMesh slivers() {
  TriangleMesh mesh = support::plate(0.1, 0.01, 12);
  for (Vector3d& v : mesh.vertices) v.x() *= 1e-4;
  return mesh;
}

TEST(EverySearch, GivesTheSameAnswersOnRandomSegments) {
  std::uint64_t seed = 20;
  for (const TriangleMesh& shape : shapes()) {
    const ContactMesh mesh = ContactMesh::build(shape).value();
    expect_same_on_random_segments(mesh, mesh.origin(), 0.05, scaled_count(100000, 6000), ++seed);
    const PackedSurface surface = PackedSurface::build(shape).value();
    expect_same_on_random_segments(surface, mesh.origin(), 0.05, scaled_count(100000, 6000),
                                   ++seed);
  }
}

TEST(EverySearch, GivesTheSameAnswersOnSlivers) {
  const ContactMesh mesh = ContactMesh::build(slivers()).value();
  expect_same_on_random_segments(mesh, mesh.origin(), 0.05, scaled_count(100000, 6000), 30);
  const PackedSurface surface = PackedSurface::build(slivers()).value();
  expect_same_on_random_segments(surface, mesh.origin(), 0.05, scaled_count(100000, 6000), 31);
}

TEST(EverySearch, GivesTheSameAnswersOnScans) {
  for (const char* name : {"elephant.off", "pinion_small.off", "blobby-shuffled.off"}) {
    const std::filesystem::path file = std::filesystem::path(THIMBLE_MESHES) / name;
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "NO SCANNED MESHES: run app/setup.sh";
    const auto loaded = load_mesh(file);
    ASSERT_TRUE(loaded) << name;
    const auto mesh = ContactMesh::build(*loaded);
    if (!mesh) continue;
    const double half = (mesh->box_max() - mesh->origin()).maxCoeff();
    expect_same_on_random_segments(*mesh, mesh->origin(), half, scaled_count(100000, 2000), 40);
  }
}

TEST(EverySearch, IsIndependentOfScaleAndOrigin) {
  for (const double scale : {1e-6, 1.0, 1e3}) {
    for (const double offset : {0.0, 1e4 * 0.05 * scale}) {
      const Vector3d middle(offset, -offset, offset);
      const TriangleMesh shape = placed(support::bumpy_sphere(2, 0.05, 0.3, 6), scale,
                                        Eigen::Matrix3d::Identity(), middle);
      const ContactMesh mesh = ContactMesh::build(shape).value();
      expect_same_on_random_segments(mesh, middle, 0.05 * scale, scaled_count(20000, 2000), 50);
      const PackedSurface surface = PackedSurface::build(shape).value();
      expect_same_on_random_segments(surface, middle, 0.05 * scale, scaled_count(20000, 2000), 51);
    }
  }
}

// Points on a coarse lattice: nearly all are on planes, edges or corners, many segments are within
// faces or along edges, some have no length.
TEST(EverySearch, GivesTheSameAnswersWhereEverythingIsDegenerate) {
  for (const bool compact : {false, true}) {
    const TriangleMesh shape = support::plate(1, 0.5, 4);
    const ContactMesh mesh = ContactMesh::build(shape).value();
    const PackedSurface surface = PackedSurface::build(shape).value();
    Searches<ContactMesh> doubles(mesh);
    Searches<PackedSurface> triangles(surface);
    support::Random random(60);
    const auto any = [&random] { return static_cast<double>(random.bits() % 11) / 8 - 0.625; };
    Vector3d before(any(), any(), any());
    for (int i = 0; i < scaled_count(50000, 3000); ++i) {
      const Vector3d now = i % 7 == 0 ? before : Vector3d(any(), any(), any());
      if (compact) {
        triangles.expect_same_entry(before, now);
        triangles.expect_same_side(now);
        triangles.expect_same_closest(now, 1);
      } else {
        doubles.expect_same_entry(before, now);
        doubles.expect_same_side(now);
        doubles.expect_same_closest(now, 1);
      }
      if (HasFatalFailure()) return;
      before = now;
    }
    EXPECT_GT(doubles.entries + triangles.entries, 100);
    EXPECT_GT(doubles.insides + triangles.insides, 100);
  }
}

TEST(EverySearch, FindsNothingForNaNAndEndsForHugeSegments) {
  const ContactMesh mesh = ContactMesh::build(support::icosphere(2, 1)).value();
  Searches<ContactMesh> searches(mesh);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, infinity, -infinity, 1e300}) {
    for (const ContactSearch* search : searches.others()) {
      EXPECT_EQ(search->first_entry({bad, 0, 0}, {0, 0, 0}).triangle, -1);
      EXPECT_EQ(search->first_entry({2, 0, 0}, {0, bad, 0}).triangle, -1);
      EXPECT_FALSE(search->inside({0, 0, bad}));
      EXPECT_EQ(search->closest({0, 0, bad}, 1).triangle, -1);
      EXPECT_EQ(search->clearance({0, 0, bad}), 0);
    }
  }
  for (const ContactSearch* search : searches.others()) {
    EXPECT_EQ(search->closest({0, 0, 0}, nan).triangle, -1);
    EXPECT_EQ(search->closest({0, 0, 0}, -1).triangle, -1);
    EXPECT_GE(search->closest({0, 0, 0}, infinity).triangle, 0);
    EXPECT_GE(search->closest({1e8, 3, 1e7}, infinity).triangle, 0);
  }
  support::Random random(61);
  for (int i = 0; i < 200; ++i) {
    const double far = std::pow(10.0, random.uniform(0, 14.9));
    const Vector3d near_from = far * random.direction();
    searches.expect_same_entry(near_from, 0.1 * random.direction());
    const Vector3d far_from = far * random.direction();
    searches.expect_same_entry(far_from, far * random.direction());
  }
  EXPECT_GE(searches.entries, 200);
}

TEST(EverySearch, FindsTheTriangleOfAPointWithRadiusZero) {
  const ContactMesh box = ContactMesh::build(support::box({1, 1, 1})).value();
  const Searches<ContactMesh> searches(box);
  for (const Vector3d& on : {Vector3d(1, 1, 1), Vector3d(0.25, 0.5, 1), Vector3d(-1, 0, 0.5)}) {
    EXPECT_GE(searches.linear.closest(on, 0).triangle, 0);
    for (const ContactSearch* search : searches.others()) {
      const SurfacePoint found = search->closest(on, 0);
      EXPECT_GE(found.triangle, 0) << on.transpose();
      EXPECT_EQ(found.distance, 0);
      EXPECT_LT(search->closest(on, -1e-9).triangle, 0);
    }
  }
}

TEST(EverySearch, ReturnsAClearanceWithoutTriangles) {
  for (const TriangleMesh& shape : shapes()) {
    const ContactMesh mesh = ContactMesh::build(shape).value();
    Searches<ContactMesh> searches(mesh);
    support::Random random(70);
    int clear = 0;
    for (int i = 0; i < 500; ++i) {
      const Vector3d p = mesh.origin() + random.in_box(i % 2 == 0 ? 0.06 : 0.3);
      const double distance = searches.linear.closest(p, 10).distance;
      for (const ContactSearch* search : searches.others()) {
        ASSERT_LE(search->clearance(p), distance);
        clear += search->clearance(p) > 0.1 * distance;
      }
    }
    EXPECT_GT(clear, 400);
  }
}

// Walks with ticks of every length near and far from the surface: the remembered ball changes no
// answer, and saves most queries.
TEST(FreeSpace, MissesNothingOnAWalk) {
  const ContactMesh mesh = ContactMesh::build(support::bumpy_sphere(3, 0.05, 0.3, 6)).value();
  for (const auto choice : {SearchChoice::kLinear, SearchChoice::kGrid, SearchChoice::kTree}) {
    const auto search = make_search(mesh, choice);
    for (const double step : {0.03e-3, 0.3e-3, 3e-3}) {
      FreeSpace space;
      support::Random random(71);
      Vector3d p(0.08, 0, 0), heading(-1, 0, 0);
      int entries = 0;
      for (int i = 0; i < scaled_count(100000, 5000); ++i) {
        heading = (heading + 0.05 * random.direction() - 0.5 * p).normalized();
        const Vector3d next = p + step * heading;
        const Entry wanted = search->first_entry(p, next);
        const Entry found = space.first_entry(*search, p, next);
        ASSERT_EQ(found.triangle, wanted.triangle);
        ASSERT_EQ(found.parameter, wanted.parameter);
        entries += wanted.triangle >= 0;
        p = next;
      }
      EXPECT_GT(entries, 0) << step;
    }
  }
}

TEST(FreeSpace, ContainsADistantTip) {
  const ContactMesh mesh = ContactMesh::build(support::icosphere(3, 0.05)).value();
  for (const auto choice : {SearchChoice::kGrid, SearchChoice::kTree}) {
    const auto search = make_search(mesh, choice);
    FreeSpace space;
    space.first_entry(*search, {0.08, 0, 0}, {0.08, 0.0003, 0});
    EXPECT_TRUE(space.holds({0.08, 0.0003, 0.001}));
    EXPECT_FALSE(space.holds({0.049, 0, 0}));
    EXPECT_FALSE(space.holds({std::numeric_limits<double>::quiet_NaN(), 0, 0}));
  }
}

// Case 28: 2 m/s at 1 kHz is 2 mm per tick, through a plate of 1 mm, starting at every phase.
template <class Build>
void expect_no_tunnelling(Build build) {
  const TriangleMesh shape = support::plate(0.1, 0.001, 8);
  for (const auto choice : {SearchChoice::kLinear, SearchChoice::kGrid, SearchChoice::kTree}) {
    auto contact = build(shape, choice);
    support::Random random(80);
    const int phases = scaled_count(10000, 1000);
    for (int i = 0; i < phases; ++i) {
      const double phase = 2e-3 * i / phases;
      const Vector3d beside{random.uniform(-0.04, 0.04), random.uniform(-0.04, 0.04), 0};
      driver::DeviceState state;
      bool touched = false;
      for (int tick = 0; tick < 6; ++tick) {
        state.p_WT = beside + Vector3d(0, 0, 5e-3 + phase - 2e-3 * tick);
        touched = contact.update(state).touching || touched;
      }
      ASSERT_TRUE(touched) << "phase " << i;
      state.p_WT.setConstant(std::numeric_limits<double>::quiet_NaN());
      contact.update(state);
    }
  }
}

TEST(EverySearch, LetsNoTrackerTunnelThroughAPlate) {
  expect_no_tunnelling([](const TriangleMesh& mesh, SearchChoice choice) {
    return MeshContact::build(mesh, {}, choice).value();
  });
  expect_no_tunnelling([](const TriangleMesh& mesh, SearchChoice choice) {
    return GodObjectContact::build(mesh, {}, choice).value();
  });
}

TEST(EverySearch, AnswersWithoutAllocation) {
  const ContactMesh mesh = ContactMesh::build(support::torus(0.035, 0.015, 40, 20)).value();
  Searches<ContactMesh> searches(mesh);
  support::Random random(81);
  double sum = 0;
  const int calls = support::heap_calls_of([&] {
    for (int i = 0; i < 200; ++i) {
      const Vector3d p = random.in_box(0.06);
      for (const ContactSearch* search : {static_cast<const ContactSearch*>(&searches.linear),
                                          static_cast<const ContactSearch*>(&searches.grid),
                                          static_cast<const ContactSearch*>(&searches.tree)}) {
        sum += search->first_entry(p, -p).parameter + search->closest(p, 1).distance +
               search->clearance(p) + search->inside(p);
      }
    }
  });
  EXPECT_EQ(calls, 0);
  EXPECT_GT(sum, 0);
}

TEST(MakeSearch, UsesTheTreeFromEightThousandTriangles) {
  const ContactMesh fewer = ContactMesh::build(support::icosphere(4, 0.05)).value();  // 5,120
  EXPECT_NE(dynamic_cast<const GridSearch<ContactMesh>*>(make_search(fewer).get()), nullptr);
  const ContactMesh more = ContactMesh::build(support::icosphere(5, 0.05)).value();  // 20,480
  EXPECT_NE(dynamic_cast<const TreeSearch<ContactMesh>*>(make_search(more).get()), nullptr);
}

TEST(MakeSearch, UsesTheTreeForUnevenTriangles) {
  const TriangleMesh even = support::icosphere(3, 0.05);
  const ContactMesh mesh = ContactMesh::build(even).value();
  EXPECT_NE(dynamic_cast<const GridSearch<ContactMesh>*>(make_search(mesh).get()), nullptr);
  // The same ball next to one a thousand times larger.
  TriangleMesh uneven = even;
  const TriangleMesh large =
      placed(support::icosphere(0, 0.05), 1000, Eigen::Matrix3d::Identity(), Vector3d(100, 0, 0));
  const auto shift = static_cast<std::int32_t>(uneven.vertices.size());
  uneven.vertices.insert(uneven.vertices.end(), large.vertices.begin(), large.vertices.end());
  for (const auto& [a, b, c] : large.triangles) {
    uneven.triangles.push_back({a + shift, b + shift, c + shift});
  }
  const ContactMesh two = ContactMesh::build(uneven).value();
  EXPECT_NE(dynamic_cast<const TreeSearch<ContactMesh>*>(make_search(two).get()), nullptr);
  expect_same_on_random_segments(two, Vector3d::Zero(), 0.05, scaled_count(20000, 1000), 82);
}

}  // namespace
}  // namespace thimble::render
