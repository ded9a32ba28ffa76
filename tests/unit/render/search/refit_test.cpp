#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "search/baseline/linear_search.h"
#include "search/grid_search.h"
#include "search/tree_search.h"
#include "support/contact_walk.h"
#include "support/heap_guard.h"
#include "support/long_form.h"
#include "support/meshes/dents.h"
#include "support/meshes/shapes.h"
#include "support/random.h"
#include "support/seed.h"
#include "track/moving_mesh.h"

// A mesh that has moved, with all structures built over it, equals a newly built one.

namespace thimble::render {
namespace {

using Eigen::Vector3d;

constexpr double kSize = 0.05;  // m

int rounds() {
  return support::long_form() ? 1000 : 120;
}

TriangleMesh slivers() {
  TriangleMesh mesh = support::plate(0.1, 0.01, 12);
  for (Vector3d& v : mesh.vertices) v.x() *= 1e-4;
  return mesh;
}

std::vector<TriangleMesh> shapes() {
  return {support::icosphere(3, kSize), support::torus(0.035, 0.015, 40, 20), slivers()};
}

// A dent inwards, one outwards, or all back to the start, in turns.
std::vector<VertexMove> next_moves(const ContactMesh& mesh, const TriangleMesh& start, int round,
                                   support::Random& random) {
  if (round % 3 == 2) {
    std::vector<VertexMove> back;
    for (std::int32_t v = 0; v < mesh.vertex_count(); ++v) {
      back.push_back({v, start.vertices[static_cast<std::size_t>(v)]});
    }
    return back;
  }
  const auto centre =
      static_cast<std::int32_t>(random.bits() % static_cast<std::uint64_t>(mesh.vertex_count()));
  const double way = round % 3 == 0 ? -1 : 0.3;
  const double depth = random.uniform(0.0002, 0.004);
  const double radius = random.uniform(0.005, 0.02);
  return support::dent(mesh, centre, way * support::outwards_at(mesh, centre), depth, radius,
                       random);
}

void expect_same_answers(const ContactSearch& moved, const ContactSearch& fresh,
                         const ContactMesh& mesh, const std::vector<VertexMove>& moves,
                         support::Random& random, int& entries) {
  for (int i = 0; i < 40; ++i) {
    const std::int32_t v = moves[random.bits() % moves.size()].vertex;
    const double reach = i % 3 == 0 ? kSize : i % 3 == 1 ? 0.004 : 0.0003;
    const Vector3d from = mesh.position(v) + random.in_box(reach);
    const Vector3d to = from + random.in_box(reach);
    const Entry wanted = fresh.first_entry(from, to);
    const Entry found = moved.first_entry(from, to);
    ASSERT_EQ(found.triangle, wanted.triangle);
    ASSERT_EQ(found.parameter, wanted.parameter);  // bit-identical
    entries += wanted.triangle >= 0;
    ASSERT_EQ(moved.inside(from), fresh.inside(from));
    const SurfacePoint near = fresh.closest(from, 0.01);
    const SurfacePoint nearest = moved.closest(from, 0.01);
    ASSERT_EQ(nearest.triangle >= 0, near.triangle >= 0);
    // Among triangles that share the closest point, the order of the queries decides, and the last
    // digit.
    if (near.triangle >= 0) {
      ASSERT_NEAR(nearest.distance, near.distance, 1e-15);
    }
    ASSERT_LE(moved.clearance(from), nearest.triangle >= 0 ? nearest.distance : 1);
  }
}

TEST(MovingMesh, IsSearchedLikeANewMesh) {
  for (const auto choice : {SearchChoice::kLinear, SearchChoice::kTree}) {
    std::uint64_t seed = 10;
    for (const TriangleMesh& shape : shapes()) {
      MovingMesh surface(ContactMesh::build(shape, {.room = 0.2}).value(), {.search = choice});
      support::Random random(support::seed_of(++seed));
      int entries = 0;
      for (int round = 0; round < rounds(); ++round) {
        const auto moves = next_moves(surface.mesh(), shape, round, random);
        const SurfaceMoved moved = surface.move_vertices(moves, Vector3d::Zero());
        ASSERT_EQ(moved.refused, 0);
        const auto fresh = make_search(surface.mesh(), choice);
        expect_same_answers(surface.search(), *fresh, surface.mesh(), moves, random, entries);
        if (HasFatalFailure()) return;
      }
      EXPECT_GT(entries, rounds());
    }
  }
}

TEST(MovingMesh, HasThePlanesAndNormalsOfANewMesh) {
  for (const auto weights :
       {NormalWeights::kAngle, NormalWeights::kRound, NormalWeights::kFitted}) {
    std::uint64_t seed = 20;
    for (const TriangleMesh& shape : shapes()) {
      // Creases appear and disappear: dents are steeper than this.
      constexpr double kCrease = 0.25;
      MovingMesh surface(ContactMesh::build(shape, {.room = 0.2}).value(),
                         {.normals = weights, .crease_angle = kCrease});
      support::Random random(support::seed_of(++seed));
      int changed = 0;
      for (int round = 0; round < rounds() / 4; ++round) {
        const SmoothNormals before = *surface.normals();
        surface.move_vertices(next_moves(surface.mesh(), shape, round, random), Vector3d::Zero());
        const SmoothNormals fresh(surface.mesh(), kCrease, weights);
        ContactMesh planes = surface.mesh();
        for (std::int32_t v = 0; v < planes.vertex_count(); ++v) {
          planes.move_vertex(v, planes.position(v));
        }
        for (std::int32_t t = 0; t < surface.mesh().triangle_count(); ++t) {
          ASSERT_EQ(surface.mesh().cell(t).face.n, planes.cell(t).face.n);
          for (std::size_t k = 0; k < 3; ++k) {
            ASSERT_EQ(surface.mesh().edge_planes(t)[k].n, planes.edge_planes(t)[k].n);
            ASSERT_EQ(surface.mesh().edge_planes(t)[k].d, planes.edge_planes(t)[k].d);
            ASSERT_EQ(surface.normals()->corners(t)[k], fresh.corners(t)[k]) << t;  // bit-identical
            ASSERT_EQ(surface.normals()->crease(t, k), fresh.crease(t, k)) << t;
            changed += before.crease(t, k) != fresh.crease(t, k);
          }
        }
      }
      EXPECT_GT(changed, 0);
    }
  }
}

TEST(MovingMesh, MovesWithoutAllocation) {
  const TriangleMesh shape = support::needle(64, 0.08, 0.01);
  for (const auto weights : {NormalWeights::kAngle, NormalWeights::kFitted}) {
    for (const auto choice : {SearchChoice::kLinear, SearchChoice::kTree}) {
      MovingMesh surface(ContactMesh::build(shape, {.room = 0.2}).value(),
                         {.search = choice, .normals = weights});
      std::vector<VertexMove> moves;
      support::Random random(30);
      for (std::int32_t v = 0; v < surface.mesh().vertex_count(); ++v) {
        moves.push_back({v, surface.mesh().position(v) + random.in_box(0.0001)});
      }
      const int calls =
          support::heap_calls_of([&] { surface.move_vertices(moves, surface.mesh().origin()); });
      EXPECT_EQ(calls, 0);
    }
  }
}

TEST(MovingMesh, IgnoresMovesOutOfTheBoxOrToNaN) {
  MovingMesh surface(ContactMesh::build(support::icosphere(2, kSize), {.room = 0.1}).value(), {});
  const Vector3d before = surface.mesh().position(7);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::array<VertexMove, 3> bad{VertexMove{7, {nan, 0, 0}},
                                      VertexMove{7, {1.3 * kSize, 0, 0}},
                                      VertexMove{7, {0, 0, -HUGE_VAL}}};
  EXPECT_EQ(surface.move_vertices(bad, Vector3d::Zero()).refused, 3);
  EXPECT_EQ(surface.mesh().position(7), before);
  const std::array<VertexMove, 1> good{VertexMove{7, 1.1 * before}};
  EXPECT_EQ(surface.move_vertices(good, Vector3d::Zero()).refused, 0);
  EXPECT_EQ(surface.mesh().position(7), 1.1 * before);
  EXPECT_TRUE(surface.search().inside(1.099 * before));
}

TEST(MovingMesh, HasNoGrid) {
  const ContactMesh mesh = ContactMesh::build(support::icosphere(2, kSize)).value();
  GridSearch<ContactMesh> grid(mesh);
  const std::array<std::int32_t, 1> first{0};
  EXPECT_FALSE(grid.refit(first));
  TreeSearch<ContactMesh> tree(mesh);
  EXPECT_FALSE(tree.refit(first));
  const std::size_t bytes = tree.bytes();
  tree.keep_places();
  EXPECT_TRUE(tree.refit(first));
  EXPECT_LE(tree.bytes(), bytes + 90 * static_cast<std::size_t>(mesh.triangle_count()));
  for (const auto choice : {SearchChoice::kGrid, SearchChoice::kTree, SearchChoice::kLinear}) {
    EXPECT_TRUE(make_moving_search(mesh, choice)->refit(first));
  }
}

}  // namespace
}  // namespace thimble::render
