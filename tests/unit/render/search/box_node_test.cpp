#include "search/box_node.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "search/tree_nodes.h"
#include "search/tree_search.h"
#include "support/meshes/shapes.h"
#include "support/random.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

double side_of(const BoxNode& node, std::size_t side, std::size_t child) {
  return static_cast<double>(node.origin[side % 3]) +
         static_cast<double>(node.scale()) * node.sides[side][child];
}

TEST(BoxNode, TightlyContainsItsChildren) {
  support::Random random(1);
  for (int round = 0; round < 2000; ++round) {
    // From a point to the whole lattice, at any place.
    const double size = std::exp2(random.uniform(-2, 30));
    const Vector3d middle = random.in_box(0x1p30 - size);
    std::array<LatticeAabb, BoxNode::kChildrenMax> boxes;
    const std::size_t count = 1 + random.bits() % boxes.size();
    LatticeAabb whole;
    for (std::size_t i = 0; i < count; ++i) {
      for (int corner = 0; corner < 3; ++corner) {
        const Vector3d p = middle + random.in_box(round % 10 == 0 ? 0 : size);
        boxes[i].add(p.x(), p.y(), p.z());
      }
      whole.add(boxes[i]);
    }
    BoxNode node;
    node.set_boxes({boxes.data(), count});
    double longest = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      longest = std::max(longest, whole.max[axis] - whole.min[axis]);
    }
    // 1/127 of the node's size per side, and the rounding of a float of 2^30.
    const double room = longest / 127 + 130;
    EXPECT_EQ(node.children(), (1u << count) - 1);
    EXPECT_GE(node.scale(), 1);
    const LatticeAabb around = node.box();
    int exponent = 0;
    EXPECT_EQ(std::frexp(node.scale(), &exponent), 0.5f);
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        ASSERT_LE(side_of(node, axis, i), boxes[i].min[axis]);
        ASSERT_GE(side_of(node, axis, i), boxes[i].min[axis] - room);
        ASSERT_GE(side_of(node, 3 + axis, i), boxes[i].max[axis]);
        ASSERT_LE(side_of(node, 3 + axis, i), boxes[i].max[axis] + room);
        ASSERT_LE(around.min[axis], side_of(node, axis, i));
        ASSERT_GE(around.max[axis], side_of(node, 3 + axis, i));
      }
    }
    // Places without a child repeat the last one's box, so that bounds over all eight are true.
    for (std::size_t i = count; i < BoxNode::kChildrenMax; ++i) {
      for (std::size_t side = 0; side < 6; ++side) {
        ASSERT_EQ(node.sides[side][i], node.sides[side][count - 1]);
      }
    }
  }
}

// Every item is reachable from the root exactly once, at any size; and a changed box leaves the
// tree that would have been built.
TEST(TreeNodes, ContainEveryItemOnceWithinTheirBoxes) {
  support::Random random(3);
  for (const std::size_t things : {1U, 2U, 7U, 8U, 9U, 63U, 64U, 65U, 512U, 1000U, 4097U}) {
    std::vector<LatticeAabb> boxes(things);
    const auto fill = [&](LatticeAabb& box) {
      box = LatticeAabb();
      const Vector3d p = random.in_box(0x1p29), q = p + random.in_box(0x1p24);
      box.add(p.x(), p.y(), p.z());
      box.add(q.x(), q.y(), q.z());
    };
    for (LatticeAabb& box : boxes) fill(box);
    const auto box_of = [&](std::size_t place) { return boxes[place]; };
    TreeNodes nodes;
    nodes.build(things, box_of);
    std::vector<int> seen(things, 0);
    const auto visit = [&](auto& self, TreeNodes::Name name) -> LatticeAabb {
      const BoxNode& node = nodes.node(name);
      LatticeAabb all;
      for (std::size_t i = 0; i < BoxNode::kChildrenMax; ++i) {
        if (((node.children() >> i) & 1u) == 0) continue;
        LatticeAabb below;
        if (TreeNodes::lowest(name)) {
          const std::size_t place = TreeNodes::first_thing(name) + i;
          ++seen.at(place);
          below = boxes.at(place);
        } else {
          below = self(self, TreeNodes::first_child(name) + static_cast<TreeNodes::Name>(i));
        }
        for (std::size_t axis = 0; axis < 3; ++axis) {
          EXPECT_LE(side_of(node, axis, i), below.min[axis]);
          EXPECT_GE(side_of(node, 3 + axis, i), below.max[axis]);
        }
        all.add(below);
      }
      return all;
    };
    visit(visit, nodes.root());
    for (const int times : seen) EXPECT_EQ(times, 1);

    for (int change = 0; change < 20; ++change) {
      const std::size_t place = random.bits() % things;
      fill(boxes[place]);
      nodes.refit(place, box_of);
    }
    TreeNodes fresh;
    fresh.build(things, box_of);
    ASSERT_EQ(nodes.levels(), fresh.levels());
    std::size_t width = things;
    for (std::size_t level = 0; level < nodes.levels(); ++level) {
      width = (width + 7) / 8;
      for (std::size_t i = 0; i < width; ++i) {
        ASSERT_TRUE(nodes.row(level)[i] == fresh.row(level)[i]);
      }
    }
    EXPECT_EQ(width, 1u);
  }
}

// Groups of 8, 64 and more consecutive packed triangles fill approximately a square, so that the
// nodes of the tree are as small as possible.
TEST(PackedSurface, KeepsEightsTogether) {
  const PackedSurface surface =
      PackedSurface::build(support::bumpy_sphere(5, 0.05, 0.1, 4)).value();
  const auto count = static_cast<std::size_t>(surface.triangle_count());
  double area = 0;
  for (std::int32_t t = 0; t < surface.triangle_count(); ++t) {
    const Vector3d a = surface.position(t, 0);
    area += (surface.position(t, 1) - a).cross(surface.position(t, 2) - a).norm() / 2;
  }
  for (const std::size_t block : {std::size_t{8}, std::size_t{64}, std::size_t{512}}) {
    double sizes = 0;
    for (std::size_t begin = 0; begin + block <= count; begin += block) {
      Vector3d low = Vector3d::Constant(1), high = -low;
      for (std::size_t i = begin; i < begin + block; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
          const Vector3d p = surface.position(static_cast<std::int32_t>(i), k);
          low = low.cwiseMin(p);
          high = high.cwiseMax(p);
        }
      }
      sizes += (high - low).norm();
    }
    const double side = std::sqrt(area * static_cast<double>(block) / static_cast<double>(count));
    // The diagonal of such a square is 1.41, and triangles extend beyond it.
    EXPECT_LE(sizes / static_cast<double>(count / block), 2.2 * side) << block;
  }
}

// Trivially so if the processor has no wide lanes.
TEST(WideLanes, AreBitIdenticalToPlainOnes) {
  for (const TriangleMesh& shape :
       {support::bumpy_sphere(3, 0.05, 0.3, 6), support::needle(64, 0.08, 0.01)}) {
    const PackedSurface surface = PackedSurface::build(shape).value();
    const TreeSearch<PackedSurface> wide(surface), plain(surface, false);
    support::Random random(2);
    int entries = 0;
    for (int i = 0; i < 5000; ++i) {
      const Vector3d p = random.in_box(0.08), q = random.in_box(0.08);
      const SurfacePoint a = wide.closest(p, 1), b = plain.closest(p, 1);
      ASSERT_EQ(a.triangle, b.triangle);
      ASSERT_EQ(a.distance, b.distance);
      ASSERT_EQ(a.p_W, b.p_W);
      const Entry in = wide.first_entry(p, q), other = plain.first_entry(p, q);
      ASSERT_EQ(in.triangle, other.triangle);
      ASSERT_EQ(in.parameter, other.parameter);
      ASSERT_EQ(wide.inside(p), plain.inside(p));
      entries += in.triangle >= 0;
    }
    EXPECT_GT(entries, 100);
  }
}

}  // namespace
}  // namespace thimble::render
