#pragma once

#include <Eigen/Core>
#include <utility>

#include "search/contact_search.h"

namespace thimble::render {

/// The most faces that are tried in turn to hold a tip [chosen: wedges, corners and needles take
/// 3].
inline constexpr int kPassedRounds = 8;

/// Where a tip is held that has left a thin part through its back within one tick.
struct PassedThrough {
  Entry entry;                    ///< Triangle above the tip, -1: nothing is between them.
  Eigen::Vector3d p_WP{0, 0, 0};  ///< The place on it, m in W.
};

/// Finds what is between a tip outside the surface, at `p_WT`, and the place `p_WP` that held it in
/// the tick before, whose normal was `n_W` (W, m): the material that it has passed through. What
/// walks over the surface cannot see it: near a rim the walk ends at the back of the part, where
/// the tip is outside. A tip beside the rim, or above the place, has nothing in between.
/// `first_entry(from, to)` is asked once. Real-time: safe.
template <class FirstEntry>
PassedThrough passed_through(const Eigen::Vector3d& p_WT, const Eigen::Vector3d& p_WP,
                             const Eigen::Vector3d& n_W, FirstEntry&& first_entry) noexcept {
  // Farther than the plane of the place, since the surface may be curved.
  constexpr double kBeyond = 1.1;
  PassedThrough passed;
  const double depth = n_W.dot(p_WP - p_WT);
  // Written so that NaN means nothing.
  if (!(depth > 0)) return passed;
  const Eigen::Vector3d above = p_WT + kBeyond * depth * n_W;
  passed.entry = std::forward<FirstEntry>(first_entry)(above, p_WT);
  passed.p_WP = above + passed.entry.parameter * (p_WT - above);
  return passed;
}

}  // namespace thimble::render
