// Scenes of several boxes against the exact proxy over their union.

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "support/box_union.h"
#include "support/long_form.h"
#include "support/random.h"
#include "support/tip_at.h"
#include "thimble/render/scene_touch.h"
#include "track/path_bounded.h"
#include "world/contact_world.h"

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

/// What a tip found in a scene.
struct Comparison {
  int several = 0;       ///< Ticks with several active solids.
  int parted = 0;        ///< Ticks at another local minimum than the reference.
  int inside = 0;        ///< Ticks with the proxy inside a box.
  int no_minimum = 0;    ///< Ticks in which the proxy is no local minimum.
  int unsettled = 0;     ///< Ticks that reached the bound of a tick.
  double proxy_off = 0;  ///< Greatest distance from the reference proxy, m.
  double force_off = 0;  ///< Greatest difference from the reference force, N.
};

/// Follows a wandering tip through a scene. Where several faces are met in one tick, two orders may
/// lead to two local minima; the comparison with the reference then continues once both are free.
Comparison compare(const std::vector<SolidBlock>& blocks, Random& random, int ticks) {
  SceneTouch scene = scene_of(blocks, kGodObject);
  Vector3d p(0, 0, 0.1);
  BoxUnionProxy exact(blocks, p);
  ProxyFilter filter;
  scene(support::tip_at(p));
  filter.follow(p, {});
  Vector3d target = random.in_box(0.02);
  Comparison result;
  bool parted = false;
  for (int tick = 0; tick < ticks; ++tick) {
    if (random.uniform(0, 1) < 0.004) target = random.in_box(0.03);
    const Vector3d way = target - p;
    p += std::min(1.0, random.uniform(0, 2e-4) / way.norm()) * way + 2e-5 * random.in_box(1);
    const auto unsettled = scene.world()->counters().unsettled;
    const driver::ForceCommand command = scene(support::tip_at(p));
    const Vector3d q = exact.follow(p);
    const Vector3d proxy = scene.world()->proxy();
    if (scene.world()->active_count() > 1) ++result.several;
    const bool settled = scene.world()->counters().unsettled == unsettled;
    if (!settled) ++result.unsettled;
    if (settled && !nearest_around(blocks, p, proxy, 1e-9 * kSize)) ++result.no_minimum;
    for (const SolidBlock& block : blocks) {
      if (block.depth(proxy) > 1e-9 * kSize) ++result.inside;
    }
    ContactState found{.touching = exact.active() > 0, .depth = (q - p).norm()};
    found.n_W = found.depth > 0 ? Vector3d((q - p) / found.depth) : Vector3d::UnitX();
    const bool as_found = filter.follow(p, found);
    const ContactState& felt = as_found ? found : filter.felt();
    if (parted) {
      ++result.parted;
      parted = scene.world()->active_count() > 0 || exact.active() > 0;
      continue;
    }
    const double off = (proxy - q).norm();
    const bool alike = (exact.active() > 0) == (scene.world()->active_count() > 0);
    if (off > 1e-6 || !alike) {
      parted = true;
      ++result.parted;
      continue;
    }
    result.proxy_off = std::max(result.proxy_off, off);
    result.force_off =
        std::max(result.force_off, (command.f_T_W - kStiffness * felt.depth * felt.n_W).norm());
  }
  return result;
}

TEST(WorldUnion, TheProxyIsThatOfTheUnionOfBoxes) {
  const int scenes = support::long_form() ? 10'000 : 300;
  const int ticks = support::long_form() ? 10'000 : 2000;
  Random random(scenes);
  Comparison all;
  int scenes_parted = 0;
  for (int i = 0; i < scenes; ++i) {
    const Comparison one = compare(random_blocks(random, i % 2 == 1), random, ticks);
    all.several += one.several;
    all.parted += one.parted;
    all.inside += one.inside;
    all.no_minimum += one.no_minimum;
    all.unsettled += one.unsettled;
    all.proxy_off = std::max(all.proxy_off, one.proxy_off);
    all.force_off = std::max(all.force_off, one.force_off);
    scenes_parted += one.parted > 0 ? 1 : 0;
  }
  std::printf(
      "%d ticks, %d with several solids; proxy within %.1e m, force within %.1e N; at another "
      "minimum in %d ticks of %d scenes; %d unsettled\n",
      scenes * ticks, all.several, all.proxy_off, all.force_off, all.parted, scenes_parted,
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
