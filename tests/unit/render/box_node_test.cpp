#include "thimble/render/contact/box_node.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>

#include "support/random.h"
#include "support/shapes.h"
#include "thimble/render/contact/bvh.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

double side_of(const BoxNode& node, std::size_t side, std::size_t child) {
  return static_cast<double>(node.origin[side % 3]) +
         static_cast<double>(node.scale) * node.sides[side][child];
}

TEST(BoxNode, HoldsItsChildrensBoxesAndLittleMore) {
  support::Random random(1);
  for (int round = 0; round < 2000; ++round) {
    // From a point to the whole lattice, anywhere on it.
    const double size = std::exp2(random.uniform(-2, 30));
    const Vector3d middle = random.in_box(0x1p30 - size);
    std::array<StepBox, BoxNode::kChildrenMax> boxes;
    const std::size_t count = 1 + random.bits() % boxes.size();
    StepBox whole;
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
    // 1/127 of the node's size for each side, and what a float of 2^30 cannot tell.
    const double room = longest / 127 + 130;
    int exponent = 0;
    EXPECT_EQ(std::frexp(node.scale, &exponent), 0.5f);
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        ASSERT_LE(side_of(node, axis, i), boxes[i].min[axis]);
        ASSERT_GE(side_of(node, axis, i), boxes[i].min[axis] - room);
        ASSERT_GE(side_of(node, 3 + axis, i), boxes[i].max[axis]);
        ASSERT_LE(side_of(node, 3 + axis, i), boxes[i].max[axis] + room);
      }
    }
  }
}

TEST(BoxNode, NamesLeaves) {
  for (const std::size_t place : {std::size_t{0}, std::size_t{5}, (std::size_t{1} << 28) - 4}) {
    for (std::size_t size = 1; size <= BoxNode::kLeafMax; ++size) {
      const std::uint32_t leaf = leaf_of(place, size);
      EXPECT_NE(leaf & BoxNode::kLeaf, 0u);
      EXPECT_EQ(first_place(leaf), place);
      EXPECT_EQ(end_place(leaf), place + size);
    }
  }
}

// Trivially so where the processor has no wide lanes.
TEST(WideLanes, GiveTheAnswersOfPlainOnesToTheBit) {
  for (const TriangleMesh& shape :
       {support::bumpy_sphere(3, 0.05, 0.3, 6), support::needle(64, 0.08, 0.01)}) {
    const CompactSurface surface = CompactSurface::build(shape).value();
    const Bvh wide(surface), plain(surface, false);
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
