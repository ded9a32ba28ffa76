#include "search/tree_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "search/lanes.h"
#include "search/mesh_segment_test.h"
#include "search/search_answers.h"

namespace thimble::render {

using Eigen::Vector3d;

// Calls visit(list) for all leaves near the segment; `visit` returns the parameter beyond which
// triangles are not wanted.
template <class Surface>
template <class Visit>
void TreeSearch<Surface>::visit_reached(const Vector3d& from, const Vector3d& way,
                                        Visit visit) const noexcept {
  const ReachedPart part = reached_part(from, way);
  if (!part.any) return;
  const auto visit_part = [&](std::span<const std::int32_t> list) noexcept {
    return (visit(list) - part.begin) / part.length;
  };
  const std::int32_t* const order = order_.empty() ? nullptr : order_.data();
  NearList near;
  if (wide_ ? lanes_avx2::list_near(nodes_, *surface_, part, near)
            : lanes_plain::list_near(nodes_, *surface_, part, near)) {
    if (near.count == 0) return;
    std::array<std::int32_t, NearList::kCapacity> list;
    for (std::size_t i = 0; i < near.count; ++i) list[i] = triangle_at(near.numbers[i]);
    visit(std::span<const std::int32_t>(list.data(), near.count));
    return;
  }
  if (wide_) {
    lanes_avx2::walk_along(nodes_, order, part, visit_part);
  } else {
    lanes_plain::walk_along(nodes_, order, part, visit_part);
  }
}

template <class Surface>
Entry TreeSearch<Surface>::first_entry(const Vector3d& p_from,
                                       const Vector3d& p_to) const noexcept {
  if (!within_range(p_from) || !within_range(p_to)) return {};
  const auto segment = segment_test(*surface_, frame_, p_from, p_to);
  const auto sieve = sieve_of(segment);
  FirstEntry first(segment);
  visit_reached(segment.from(), segment.way(), [&](std::span<const std::int32_t> list) noexcept {
    visit_near(sieve, list, [&](std::int32_t t) noexcept { first.consider(t); });
    return first.limit();
  });
  return first.entry();
}

template <class Surface>
bool TreeSearch<Surface>::inside(const Vector3d& p_W) const noexcept {
  if (!within_range(p_W) || !in_frame(frame_.to_steps(p_W))) return false;
  const Vector3d p_far = far_along_x(frame_, p_W);
  const auto segment = segment_test(*surface_, frame_, p_W, p_far);
  const auto sieve = sieve_of(segment);
  unsigned crossings = 0;
  visit_reached(segment.from(), segment.way(), [&](std::span<const std::int32_t> list) noexcept {
    crossings += count_crossings(segment, sieve, list);
    return 2.0;
  });
  return crossings % 2 == 1;
}

template <class Surface>
SurfacePoint TreeSearch<Surface>::closest(const Vector3d& p_W, double radius) const noexcept {
  if (!within_range(p_W) || !(radius >= 0)) return {};
  const Vector3d p = frame_.to_steps(p_W);
  NearestPoint best(*surface_, frame_, p, reach_of(frame_, radius));
  // Twice the error of converting a point and its distance to a node to single precision.
  const auto room = static_cast<float>(0x1p-21 * std::max(p.cwiseAbs().maxCoeff(), kLatticeHalf));
  const std::int32_t* const order = order_.empty() ? nullptr : order_.data();
  if (wide_ ? lanes_avx2::find_nearest(nodes_, order, *surface_, frame_, p.data(), room,
                                       best.so_far())
            : lanes_plain::find_nearest(nodes_, order, *surface_, frame_, p.data(), room,
                                        best.so_far())) {
    return best.point();
  }
  if (wide_) {
    lanes_avx2::walk_to_nearest(nodes_, order, *surface_, frame_, p.data(), room, best.so_far());
  } else {
    lanes_plain::walk_to_nearest(nodes_, order, *surface_, frame_, p.data(), room, best.so_far());
  }
  return best.point();
}

template <class Surface>
double TreeSearch<Surface>::clearance(const Vector3d& p_W) const noexcept {
  // A margin for the rounding of the distance.
  constexpr double kSurely = 1 - 0x1p-20;
  const double distance = closest(p_W, std::numeric_limits<double>::infinity()).distance;
  return std::isfinite(distance) ? kSurely * distance : 0;
}

template class TreeSearch<ContactMesh>;
template class TreeSearch<PackedSurface>;

}  // namespace thimble::render
