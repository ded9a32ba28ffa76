#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <utility>

#include "support/random.h"
#include "support/tip_at.h"
#include "thimble/render/scene_touch.h"
#include "track/path_bounded.h"
#include "world/contact_world.h"

namespace thimble::support {

/// Result of a walk through a scene and through a reference of its union.
struct UnionComparison {
  int several = 0;        ///< Ticks with several active solids.
  int parted = 0;         ///< Ticks at another local minimum than the reference.
  int scenes_parted = 0;  ///< Scenes with such ticks.
  int inside = 0;         ///< Ticks with the proxy inside a solid.
  int no_minimum = 0;     ///< Ticks in which the proxy is no local minimum.
  int unsettled = 0;      ///< Ticks that reached the bound of a tick.
  double proxy_off = 0;   ///< Greatest distance from the reference proxy, m.
  double force_off = 0;   ///< Greatest difference from the reference force, N.

  void add(const UnionComparison& one) {
    several += one.several;
    parted += one.parted;
    scenes_parted += one.parted > 0 ? 1 : 0;
    inside += one.inside;
    no_minimum += one.no_minimum;
    unsettled += one.unsettled;
    proxy_off = std::max(proxy_off, one.proxy_off);
    force_off = std::max(force_off, one.force_off);
  }
};

/// Follows a wandering tip through a scene of several solids of one stiffness (N/m) without
/// damping. Where several faces are met in one tick, two orders may lead to two local minima; the
/// comparison with the reference then continues once both are free.
///
/// `reference.follow(p)` returns the proxy on the surface, the tip while it is free; `touching()`
/// is whether it is held. `is_minimum(p, q)` is whether q is a local minimum of the distance from
/// p, and `inside(q)` whether q is inside a solid.
template <class Reference>
UnionComparison compare_with_union(render::SceneTouch& scene, double stiffness,
                                   Reference& reference, Random& random, int ticks) {
  using Eigen::Vector3d;
  Vector3d p(0, 0, 0.1);
  render::ProxyFilter filter;
  scene(tip_at(p));
  reference.follow(p);
  filter.follow(p, {});
  Vector3d target = random.in_box(0.02);
  UnionComparison result;
  bool parted = false;
  for (int tick = 0; tick < ticks; ++tick) {
    if (random.uniform(0, 1) < 0.004) target = random.in_box(0.03);
    const Vector3d way = target - p;
    p += std::min(1.0, random.uniform(0, 2e-4) / way.norm()) * way + 2e-5 * random.in_box(1);
    const auto unsettled = scene.world()->counters().unsettled;
    const driver::ForceCommand command = scene(tip_at(p));
    const Vector3d q = reference.follow(p);
    const Vector3d proxy = scene.world()->proxy();
    const bool active = scene.world()->active_count() > 0;
    if (scene.world()->active_count() > 1) ++result.several;
    const bool settled = scene.world()->counters().unsettled == unsettled;
    if (!settled) ++result.unsettled;
    if (settled && !reference.is_minimum(p, proxy)) ++result.no_minimum;
    if (reference.inside(proxy)) ++result.inside;
    render::ContactState found{.touching = reference.touching(), .depth = (q - p).norm()};
    found.n_W = found.depth > 0 ? Vector3d((q - p) / found.depth) : Vector3d::UnitX();
    const bool as_found = filter.follow(p, found);
    const render::ContactState& felt = as_found ? found : filter.felt();
    if (parted) {
      ++result.parted;
      parted = active || reference.touching();
      continue;
    }
    const double off = (proxy - q).norm();
    if (off > 1e-6 || reference.touching() != active) {
      parted = true;
      ++result.parted;
      continue;
    }
    result.proxy_off = std::max(result.proxy_off, off);
    result.force_off =
        std::max(result.force_off, (command.f_T_W - stiffness * felt.depth * felt.n_W).norm());
  }
  return result;
}

}  // namespace thimble::support
