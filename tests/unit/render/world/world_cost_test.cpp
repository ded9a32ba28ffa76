// Time per tick and time to build for many objects. Times are printed; they are no criteria.

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

#include "support/box_union.h"
#include "thimble/driver/device_state.h"
#include "thimble/render/scene_touch.h"
#include "world/contact_world.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;
using support::SolidBlock;

/// A floor of n by n flush boxes of 1 cm with their tops at z = 0.
std::vector<SolidBlock> floor_of(int n) {
  std::vector<SolidBlock> blocks;
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < n; ++k) {
      blocks.push_back({.centre = {0.01 * (i - n / 2) + 0.005, 0.01 * (k - n / 2) + 0.005, -0.005},
                        .half = {0.005, 0.005, 0.005}});
    }
  }
  return blocks;
}

double seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Returns the time per tick, ns, of a tip that slides on circles at the height `z`: the least of
/// several rounds.
double tick_time(SceneTouch& scene, double z) {
  driver::DeviceState state;
  const int ticks = 20'000;
  double least = std::numeric_limits<double>::infinity();
  state.p_WT = {0.012, 0, 0.1};
  scene(state);
  for (int round = 0; round < 5; ++round) {
    const double begin = seconds();
    for (int i = 0; i < ticks; ++i) {
      const double angle = 2 * 3.14159265358979 * i / ticks;
      state.p_WT = {0.012 * std::cos(angle) + 0.0013, 0.012 * std::sin(angle) + 0.0017, z};
      scene(state);
    }
    least = std::min(least, (seconds() - begin) / ticks);
  }
  return 1e9 * least;
}

TEST(WorldCost, IsReportedForManyObjects) {
  for (const TrackerChoice tracker : {TrackerChoice::kEdgePlanes, TrackerChoice::kGodObject}) {
    for (const int n : {0, 1, 2, 22, 100}) {
      std::vector<SolidBlock> blocks = floor_of(std::max(n, 1));
      if (n < 2) blocks[0] = {.centre = {0, 0, -0.005}, .half = {0.05, 0.05, 0.005}};
      if (n == 1) blocks.push_back({.centre = {0, 0, -0.05}, .half = {0.05, 0.05, 0.005}});
      const double begin = seconds();
      SceneTouch scene = support::scene_of(blocks, {.tracker = tracker});
      const double built = seconds() - begin;
      const double far = tick_time(scene, 0.05), near = tick_time(scene, 0.0005);
      const double touching = tick_time(scene, -0.0005);
      std::printf(
          "%s: %zu objects: %.0f ns far, %.0f ns at 0.5 mm, %.0f ns touching; built in %.3f s\n",
          kTrackerNames[static_cast<std::size_t>(tracker)].data(), blocks.size(), far, near,
          touching, built);
    }
  }
}

}  // namespace
}  // namespace thimble::render
