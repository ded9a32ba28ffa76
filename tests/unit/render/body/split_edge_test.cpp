// A mesh whose edges are split, with all structures over it, equals a newly built one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "mesh/contact_mesh.h"
#include "mesh/smooth_normals.h"
#include "search/baseline/linear_search.h"
#include "search/tree_search.h"
#include "support/heap_guard.h"
#include "support/meshes/shapes.h"
#include "support/random.h"
#include "thimble/render/mesh/check_mesh.h"
#include "track/moving_mesh.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

void split_somewhere(MovingMesh& mesh, support::Random& random) {
  const auto t = static_cast<std::int32_t>(
      random.bits() % static_cast<std::uint64_t>(mesh.mesh().triangle_count()));
  const auto edge = random.bits() % 3;
  mesh.split_edge(t, edge, random.bits() % 2 == 0);
}

TEST(SplitEdge, EqualsANewlyBuiltMesh) {
  support::Random random(3);
  for (const TriangleMesh& start :
       {support::icosphere(0, 0.05), support::torus(0.035, 0.015, 12, 8),
        support::needle(5, 0.1, 0.01), support::box({0.03, 0.02, 0.01})}) {
    for (const auto weights : {NormalWeights::kAngle, NormalWeights::kFitted}) {
      const std::size_t room = start.triangles.size() + 600;
      MovingMesh grown(ContactMesh::build(start, {.triangles_max = room}).value(),
                       {.normals = weights});
      LinearSearch linear(grown.mesh());
      EXPECT_EQ(support::heap_calls_of([&] {
                  for (int i = 0; i < 400; ++i) split_somewhere(grown, random);
                }),
                0);
      const ContactMesh& mesh = grown.mesh();
      EXPECT_EQ(static_cast<std::size_t>(mesh.triangle_count()), room);
      TriangleMesh same;
      for (std::int32_t v = 0; v < mesh.vertex_count(); ++v) {
        same.vertices.push_back(mesh.position(v));
      }
      for (std::int32_t t = 0; t < mesh.triangle_count(); ++t) {
        same.triangles.push_back(mesh.corners(t));
      }
      EXPECT_TRUE(check_mesh(same).touchable());
      const ContactMesh fresh = ContactMesh::build(same).value();
      ASSERT_EQ(fresh.triangle_count(), mesh.triangle_count());
      const SmoothNormals normals(fresh, kCreaseAngle, weights);
      for (std::int32_t t = 0; t < mesh.triangle_count(); ++t) {
        ASSERT_EQ(mesh.corners(t), fresh.corners(t));
        ASSERT_EQ(mesh.cell(t).neighbours, fresh.cell(t).neighbours);
        ASSERT_EQ(mesh.cell(t).face.n, fresh.cell(t).face.n);
        ASSERT_EQ(grown.normals()->corners(t), normals.corners(t));
        for (std::size_t k = 0; k < 3; ++k) {
          ASSERT_EQ(mesh.edge_planes(t)[k].n, fresh.edge_planes(t)[k].n);
          ASSERT_EQ(grown.normals()->crease(t, k), normals.crease(t, k));
        }
      }
      for (std::int32_t v = 0; v < mesh.vertex_count(); ++v) {
        const auto fan = mesh.fan(v);
        const auto wanted = fresh.fan(v);
        ASSERT_TRUE(std::equal(fan.begin(), fan.end(), wanted.begin(), wanted.end())) << v;
      }
      std::vector<std::int32_t> all(same.triangles.size());
      for (std::size_t t = 0; t < all.size(); ++t) all[t] = static_cast<std::int32_t>(t);
      linear.refit(all);
      const TreeSearch<ContactMesh> tree(fresh);
      for (int i = 0; i < 300; ++i) {
        const Vector3d from = random.in_box(0.08), to = random.in_box(0.08);
        const Entry wanted = tree.first_entry(from, to);
        for (const ContactSearch* search :
             {&grown.search(), static_cast<const ContactSearch*>(&linear)}) {
          const Entry found = search->first_entry(from, to);
          ASSERT_EQ(found.triangle, wanted.triangle);
          ASSERT_EQ(found.parameter, wanted.parameter);
          ASSERT_EQ(search->inside(from), tree.inside(from));
          ASSERT_NEAR(search->closest(from, 1).distance, tree.closest(from, 1).distance, 1e-15);
        }
      }
    }
  }
}

TEST(SplitEdge, RejectsForbiddenAndDoublySharedEdges) {
  const TriangleMesh box = support::box({0.03, 0.02, 0.01});
  ContactMesh stiff = ContactMesh::build(box).value();
  EXPECT_LT(stiff.split_edge(0, 0, true).vertex, 0);
  EXPECT_EQ(stiff.triangle_count(), 12);
  ContactMesh full = ContactMesh::build(box, {.triangles_max = 13}).value();
  EXPECT_LT(full.split_edge(0, 0, true).vertex, 0);
  // No vertex gets more triangles than its normals have room for.
  ContactMesh grown = ContactMesh::build(box, {.triangles_max = 2000}).value();
  for (int i = 0; i < 200; ++i) {
    // The edge opposite vertex 0.
    const std::int32_t t = grown.fan(0)[0];
    const auto& corners = grown.corners(t);
    const std::size_t k = corners[0] == 0 ? 1 : corners[1] == 0 ? 2 : 0;
    grown.split_edge(t, k, i % 2 == 0);
  }
  EXPECT_EQ(grown.fan(0).size(), ContactMesh::kValenceMax);
}

}  // namespace
}  // namespace thimble::render
