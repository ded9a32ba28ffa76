#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <atomic>
#include <numbers>
#include <set>
#include <span>
#include <tuple>
#include <vector>

#include "compact_mesh/block_order.h"
#include "compact_mesh/packed_surface.h"
#include "math/elementary.h"
#include "mesh/parallel_split.h"
#include "mesh/smooth_normals.h"
#include "support/meshes/shapes.h"
#include "support/random.h"

// Large meshes are built on two threads. The results are those of plain code on one.

namespace thimble::render {
namespace {

using Eigen::Vector3d;

TEST(ParallelSplit, ProcessesEachItemOnce) {
  for (const std::size_t count : {0u, 1u, 19999u, 20000u, 20001u, 50001u}) {
    std::vector<std::atomic<int>> done(count);
    parallel_split(count, [&done](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) ++done[i];
    });
    EXPECT_TRUE(std::all_of(done.begin(), done.end(), [](const auto& n) { return n == 1; }))
        << count;
  }
}

// Sorts the elements of each cut.
void order_plainly(std::span<PlacedIndex> items) {
  if (items.size() <= 8) return;
  std::size_t unit = 8;
  while (8 * unit < items.size()) unit *= 8;
  const std::size_t first = ((items.size() + unit - 1) / unit + 1) / 2 * unit;
  std::array<float, 3> sides{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto [low, high] = std::minmax_element(
        items.begin(), items.end(),
        [axis](const auto& a, const auto& b) { return a.at[axis] < b.at[axis]; });
    sides[axis] = high->at[axis] - low->at[axis];
  }
  const auto axis =
      static_cast<std::size_t>(std::max_element(sides.begin(), sides.end()) - sides.begin());
  std::sort(items.begin(), items.end(), [axis](const PlacedIndex& a, const PlacedIndex& b) {
    return std::tie(a.at[axis], a.index) < std::tie(b.at[axis], b.index);
  });
  order_plainly(items.first(first));
  order_plainly(items.subspan(first));
}

TEST(BlockOrder, HasTheSameBlocksAsPlainSorting) {
  support::Random random(3);
  // Above the size from which parts are ordered in parallel, and with equal places.
  for (const std::size_t count : {9u, 700u, 60001u}) {
    std::vector<PlacedIndex> items(count);
    for (std::size_t i = 0; i < count; ++i) {
      const Vector3d p = random.in_box(100);
      items[i] = {{static_cast<float>(p.x()), std::round(static_cast<float>(p.y())),
                   static_cast<float>(p.z() / 3)},
                  static_cast<std::int32_t>(i)};
    }
    std::vector<PlacedIndex> plainly = items;
    order_in_blocks(items);
    order_plainly(plainly);
    for (std::size_t begin = 0; begin < count; begin += 8) {
      std::set<std::int32_t> block, expected;
      for (std::size_t i = begin; i < std::min(begin + 8, count); ++i) {
        block.insert(items[i].index);
        expected.insert(plainly[i].index);
      }
      ASSERT_EQ(block, expected) << begin << " of " << count;
    }
  }
}

// Corner normals of a surface without creases: sums of normals weighted by angles in single
// precision, in the order of the packed triangles.
TEST(PackedSurface, TwoThreadsBuildTheNormalsOfPlainSums) {
  const TriangleMesh mesh = support::bumpy_sphere(6, 0.05, 0.1, 5);  // 81,920 triangles
  const auto surface = PackedSurface::build(mesh);
  ASSERT_TRUE(surface) << surface.error().message;
  std::vector<Vector3d> sums(mesh.vertices.size(), Vector3d::Zero());
  const auto corners_of = [&](std::int32_t t) {
    return mesh.triangles[static_cast<std::size_t>(surface->source(t))];
  };
  for (std::int32_t t = 0; t < surface->triangle_count(); ++t) {
    const auto corners = corners_of(t);
    const auto at = [&](std::size_t k) {
      return mesh.vertices[static_cast<std::size_t>(corners[k])];
    };
    const Vector3d ab = at(1) - at(0), ac = at(2) - at(0);
    const Vector3d area = ab.cross(ac);
    const double size = area.stableNorm();
    const double at_a = math::atan2(size, ab.dot(ac)), at_b = math::atan2(size, -ab.dot(ac - ab));
    const std::array<double, 3> angles{at_a, at_b, std::numbers::pi - at_a - at_b};
    for (std::size_t k = 0; k < 3; ++k) {
      sums[static_cast<std::size_t>(corners[k])] +=
          static_cast<double>(static_cast<float>(angles[k])) * (area / size);
    }
  }
  for (std::int32_t t = 0; t < surface->triangle_count(); ++t) {
    ASSERT_EQ(surface->triangle(t).flags & 7u, 0u) << "no creases";
    for (std::size_t k = 0; k < 3; ++k) {
      const auto corners = corners_of(t);
      ASSERT_EQ(surface->triangle(t).normals[k],
                pack_normal(sums[static_cast<std::size_t>(corners[k])]))
          << t;
      const auto behind = corners_of(surface->triangle(t).neighbours[k]);
      for (const std::int32_t vertex : {corners[k], corners[(k + 1) % 3]}) {
        ASSERT_NE(std::find(behind.begin(), behind.end(), vertex), behind.end()) << t;
      }
    }
  }
}

TEST(PackedSurface, ReportsTheFirstFlatTriangle) {
  TriangleMesh mesh = support::icosphere(6, 0.05);
  // Moves a vertex onto the midpoint of its own edge, so that a triangle has no area.
  const auto flatten = [&mesh](std::size_t t) {
    const auto [a, b, c] = mesh.triangles[t];
    mesh.vertices[static_cast<std::size_t>(c)] = mesh.vertices[static_cast<std::size_t>(a)];
  };
  flatten(70000);
  flatten(5);
  const auto surface = PackedSurface::build(mesh);
  ASSERT_FALSE(surface);
  for (int again = 0; again < 5; ++again) {
    EXPECT_EQ(PackedSurface::build(mesh).error().message, surface.error().message);
  }
}

}  // namespace
}  // namespace thimble::render
