// Scenes of several boxes against the exact proxy over their union.

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <vector>

#include "support/box_union.h"
#include "support/long_form.h"
#include "support/random.h"
#include "support/union_walk.h"
#include "thimble/render/scene_touch.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;
using support::BoxUnionProxy;
using support::nearest_around;
using support::Random;
using support::scene_of;
using support::SolidBlock;

constexpr ContactChoice kGodObject{.tracker = TrackerChoice::kGodObject};
constexpr double kStiffness = 800;
constexpr double kSize = 0.04;  // m, of a scene

/// Boxes of a random scene: on a lattice, so that many are flush, or of any pose.
std::vector<SolidBlock> random_blocks(Random& random, bool turned) {
  std::vector<SolidBlock> blocks;
  const auto count = static_cast<std::size_t>(random.uniform(2, 21));
  for (std::size_t i = 0; i < count; ++i) {
    SolidBlock block;
    for (int axis = 0; axis < 3; ++axis) {
      if (turned) {
        block.half[axis] = random.uniform(0.003, 0.012);
        block.centre[axis] = random.uniform(-0.02, 0.02);
      } else {
        const double low = std::floor(random.uniform(-5, 5));
        block.half[axis] = 0.002 * std::floor(random.uniform(1, 5));
        block.centre[axis] = 0.004 * low + block.half[axis];
      }
    }
    if (turned) {
      block.R = Eigen::AngleAxisd(random.uniform(0, 3), random.direction()).toRotationMatrix();
    }
    blocks.push_back(block);
  }
  return blocks;
}

/// The proxy over boxes in closed form.
class BoxReference {
 public:
  explicit BoxReference(const std::vector<SolidBlock>& blocks)
      : blocks_(blocks), exact_(blocks, {0, 0, 0.1}) {}
  Vector3d follow(const Vector3d& p) { return exact_.follow(p); }
  bool touching() const { return exact_.active() > 0; }
  bool is_minimum(const Vector3d& p, const Vector3d& q) const {
    return nearest_around(blocks_, p, q, 1e-9 * kSize);
  }
  bool inside(const Vector3d& q) const {
    return std::any_of(blocks_.begin(), blocks_.end(),
                       [&](const SolidBlock& block) { return block.depth(q) > 1e-9 * kSize; });
  }

 private:
  const std::vector<SolidBlock>& blocks_;
  BoxUnionProxy exact_;
};

TEST(WorldUnion, TheProxyIsThatOfTheUnionOfBoxes) {
  const int scenes = support::long_form() ? 10'000 : 300;
  const int ticks = support::long_form() ? 10'000 : 2000;
  Random random(scenes);
  support::UnionComparison all;
  for (int i = 0; i < scenes; ++i) {
    const std::vector<SolidBlock> blocks = random_blocks(random, i % 2 == 1);
    SceneTouch scene = scene_of(blocks, kGodObject);
    BoxReference exact(blocks);
    all.add(support::compare_with_union(scene, kStiffness, exact, random, ticks));
  }
  std::printf(
      "%d ticks, %d with several solids; proxy within %.1e m, force within %.1e N; at another "
      "minimum in %d ticks of %d scenes; %d unsettled\n",
      scenes * ticks, all.several, all.proxy_off, all.force_off, all.parted, all.scenes_parted,
      all.unsettled);
  EXPECT_GT(all.several, scenes * 50);
  EXPECT_EQ(all.inside, 0);
  EXPECT_EQ(all.no_minimum, 0);
  EXPECT_LT(all.proxy_off, 1e-9 * kSize);
  EXPECT_LT(all.force_off, 1e-6);
  EXPECT_LE(all.parted, scenes / 100 * ticks);
  EXPECT_LE(all.unsettled, scenes * ticks / 100'000);
}

}  // namespace
}  // namespace thimble::render
