#include "search/grid_search.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <span>

#include "search/build_volume_grid.h"
#include "search/eight_triangles.h"
#include "search/lanes.h"
#include "search/mesh_segment_test.h"
#include "search/search_answers.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;
// Maximum width, in volumes, of the box of a path that is examined as a whole.
constexpr double kShortVolumes = 6;

// Longer lists may take longer than the levels of a tree: in the mean per triangle, and at worst (a
// vertex of valence 64 fills one of 64). Eight triangles take 15 ns; a tree takes 70 ns longer than
// lists of ten triangles.
constexpr double kMeanListMax = 40;
constexpr std::size_t kListMax = 192;

// Remembers examined triangles, since neighbouring volumes list the same ones. Of those with the
// same last digits it remembers one; another may be examined again.
class Asked {
 public:
  Asked() noexcept { triangles_.fill(-1); }
  bool first_time(std::int32_t t) noexcept {
    std::int32_t& place = triangles_[static_cast<std::uint32_t>(t) % kPlaces];
    if (place == t) return false;
    place = t;
    return true;
  }

 private:
  static constexpr std::uint32_t kPlaces = 64;
  std::array<std::int32_t, kPlaces> triangles_;
};

// The triangles that may be the nearest, each with a distance that it is not nearer than.
class NearTriangles {
 public:
  void add(std::int32_t triangle, float low) noexcept {
    triangles_[count_] = triangle;
    low_[count_++] = low;
  }
  // Drops all that are farther than a distance.
  void drop_beyond(float far) noexcept {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      triangles_[kept] = triangles_[i];
      low_[kept] = low_[i];
      // Written so that NaN is kept.
      kept += low_[i] > far ? 0 : 1;
    }
    count_ = kept;
  }
  // Whether another eight may not fit.
  bool full() const noexcept { return count_ + EightTriangles::kCapacity > kPlaces; }
  void clear() noexcept { count_ = 0; }
  std::span<const std::int32_t> list() const noexcept { return {triangles_.data(), count_}; }

 private:
  static constexpr std::size_t kPlaces = 64;
  std::array<std::int32_t, kPlaces> triangles_;
  std::array<float, kPlaces> low_;
  std::size_t count_ = 0;
};

// A straight piece of a path, to test which volumes it meets.
class Piece {
 public:
  Piece(const Vector3d& from, const Vector3d& to, double room, double side) noexcept
      : middle_((from + to) / 2 - Vector3d::Constant(side / 2)), half_((to - from) / 2) {
    // Maximum of the cross product with the way over a cube grown by the margin.
    const double grown = side / 2 + room;
    const Vector3d size = half_.cwiseAbs();
    const double rounding = kRounding * (size.maxCoeff() + side) * (size.maxCoeff() + side);
    reach_ = grown * Vector3d(size.y() + size.z(), size.z() + size.x(), size.x() + size.y()) +
             Vector3d::Constant(rounding);
  }

  bool meets(const Vector3d& corner) const noexcept {
    const Vector3d d = corner - middle_;
    // Written so that NaN counts as meeting.
    return !(std::abs(d.y() * half_.z() - d.z() * half_.y()) > reach_.x()) &&
           !(std::abs(d.z() * half_.x() - d.x() * half_.z()) > reach_.y()) &&
           !(std::abs(d.x() * half_.y() - d.y() * half_.x()) > reach_.z());
  }

 private:
  // Coordinates are at most 2^14 volumes, and so wrong by less than 2^-38 of a piece and a volume.
  static constexpr double kRounding = 0x1p-36;
  Vector3d middle_, half_, reach_;
};

template <class Test>
SegmentInUnits in_units(const Test& segment, const VolumeGrid& grid) noexcept {
  return segment_in_units(segment.way(), segment.position_rounding(), grid.parts().per_unit);
}

// Calls visit(eight, there, triangles) for the triangles of a list in groups of eight. `there` has
// a bit for each lane with a triangle, whose number is triangles[lane].
template <class Visit>
inline void visit_eights(const VolumeList& list, Visit visit) noexcept {
  constexpr std::size_t kCapacity = EightTriangles::kCapacity;
  // Prefetched while the corners are tested.
  __builtin_prefetch(list.triangles.data());
  const std::size_t count = list.triangles.size();
  for (std::size_t i = 0; i < count; i += kCapacity) {
    const unsigned there = count - i < kCapacity ? (1u << (count - i)) - 1 : 0xffu;
    visit(list.eights[i / kCapacity], there, list.triangles.data() + i);
  }
}

Vector3d gap_to_box(const Vector3d& p, const Vector3d& corner, double side) noexcept {
  return (corner - p).cwiseMax(p - corner - Vector3d::Constant(side)).cwiseMax(0.0);
}

}  // namespace

template <class Surface>
GridSearch<Surface>::GridSearch(const Surface& surface)
    : surface_(&surface), frame_(frame_of(surface)), grid_(build_volume_grid(surface, frame_)) {}

template <class Surface>
bool GridSearch<Surface>::even() const noexcept {
  const auto& begins = grid_.parts().begins;
  double squares = 0;
  std::size_t longest = 0;
  for (std::size_t v = 0; v + 1 < begins.size(); ++v) {
    const std::size_t length = begins[v + 1].triangle - begins[v].triangle;
    longest = std::max(longest, length);
    squares += static_cast<double>(length) * static_cast<double>(length);
  }
  const auto all = static_cast<double>(grid_.parts().triangles.size());
  return squares <= kMeanListMax * all && longest <= kListMax;
}

// Calls visit(list) for the VolumeList of each volume near the segment.
template <class Surface>
template <class Test, class Visit>
inline void GridSearch<Surface>::visit_reached(const Test& segment, Visit visit) const noexcept {
  const Vector3d low = segment.low();
  const Vector3d high = segment.high();
  if (!((high - low).maxCoeff() <= 0.5 * grid_.side())) return visit_far(segment, visit);
  if (!grid_.meets(low, high)) return;
  const VolumeGrid::Place first = grid_.place_of(low), last = grid_.place_of(high);
  // Most paths of a tick stay in one volume.
  if (first == last) return grid_.visit_one(first, visit);
  grid_.visit_between(
      first, last, [](const Vector3d&) noexcept { return true; }, visit);
}

// The same for a segment that meets many volumes.
template <class Surface>
template <class Test, class Visit>
void GridSearch<Surface>::visit_far(const Test& segment, const Visit& visit) const noexcept {
  const Vector3d low = segment.low();
  const Vector3d high = segment.high();
  const double side = grid_.side();
  const double width = (high - low).maxCoeff();
  const Vector3d& from = segment.from();
  const Vector3d& way = segment.way();
  const double size = std::max(from.cwiseAbs().maxCoeff(), (from + way).cwiseAbs().maxCoeff());
  const double room = kGridRoom * side + 0x1p-48 * size;
  const auto visit_piece = [&](const Vector3d& a, const Vector3d& b, const Vector3d& piece_low,
                               const Vector3d& piece_high) noexcept {
    const Piece piece(a, b, room, side);
    grid_.visit_box(
        piece_low, piece_high,
        [&piece](const Vector3d& corner) noexcept { return piece.meets(corner); }, visit);
  };
  if (width <= kShortVolumes * side) {
    visit_piece(from, from + way, low, high);
    return;
  }
  // Longer paths: in pieces of a few volumes, or as long as empty space allows.
  const ReachedPart part = reached_part(from, way);
  if (!part.any) return;
  const double length = way.cwiseAbs().maxCoeff();
  const double end = part.begin + part.length;
  const double least = std::max(kShortVolumes * side, 4 * room);
  for (double s = part.begin; s <= end;) {
    const Vector3d a = from + s * way;
    const double clear = grid_.clearance(a) - 2 * room;
    // The way is at most sqrt(3) times its longest side.
    const double step = std::max(clear * 0.577, least);
    const double next = s + step / length;
    const double e = std::min(next, end);
    const Vector3d b = from + e * way;
    if (step <= least) {
      const Vector3d grown = Vector3d::Constant(room);
      visit_piece(a, b, a.cwiseMin(b) - grown, a.cwiseMax(b) + grown);
    }
    // A step below rounding would loop forever.
    if (!(next > s)) return;
    s = next;
  }
}

// Calls visit(t) for each triangle of a volume that a segment may cross.
template <class Surface>
template <bool kWide, class Visit>
inline void GridSearch<Surface>::visit_near(const SegmentInUnits& segment, const Vector3d& from,
                                            const VolumeList& list, Visit visit) const noexcept {
  const Vector3d seen = grid_.parts().per_unit * (from - list.middle);
  visit_eights(list, [&](const EightTriangles& eight, unsigned there,
                         const std::int32_t* triangles) noexcept {
    unsigned near = kWide ? lanes_avx2::met_of_eight(segment, seen.data(), eight)
                          : met_of_eight(segment, seen, eight);
    for (near &= there; near != 0; near &= near - 1) visit(triangles[std::countr_zero(near)]);
  });
}

template <class Surface>
template <bool kWide>
inline Entry GridSearch<Surface>::find_entry(const Vector3d& p_from,
                                             const Vector3d& p_to) const noexcept {
  const auto segment = segment_test(*surface_, frame_, p_from, p_to);
  const SegmentInUnits units = in_units(segment, grid_);
  FirstEntry first(segment);
  visit_reached(segment, [&](const VolumeList& list) noexcept {
    visit_near<kWide>(units, segment.from(), list,
                      [&first](std::int32_t t) noexcept { first.consider(t); });
  });
  return first.entry();
}

template <class Surface>
Entry GridSearch<Surface>::find_entry_wide(const Vector3d& p_from,
                                           const Vector3d& p_to) const noexcept {
  return find_entry<true>(p_from, p_to);
}

template <class Surface>
Entry GridSearch<Surface>::first_entry(const Vector3d& p_from,
                                       const Vector3d& p_to) const noexcept {
  if (!within_range(p_from) || !within_range(p_to)) return {};
  return wide_ ? find_entry_wide(p_from, p_to) : find_entry<false>(p_from, p_to);
}

template <class Surface>
bool GridSearch<Surface>::inside(const Vector3d& p_W) const noexcept {
  if (!within_range(p_W) || !in_frame(frame_.to_steps(p_W))) return false;
  const Vector3d p_far = far_along_x(frame_, p_W);
  const auto segment = segment_test(*surface_, frame_, p_W, p_far);
  // Each crossed triangle must count once, although several volumes may list it.
  std::array<std::int32_t, 64> crossed;
  std::size_t crossings = 0;
  bool all_kept = true;
  const SegmentInUnits units = in_units(segment, grid_);
  visit_reached(segment, [&](const VolumeList& list) noexcept {
    visit_near<false>(units, segment.from(), list, [&](std::int32_t t) noexcept {
      double parameter = 0;
      if (segment.cross(t, parameter) == Crossing::kNone) return;
      const auto kept_end = crossed.begin() + static_cast<std::ptrdiff_t>(crossings);
      if (std::find(crossed.begin(), kept_end, t) != kept_end) return;
      if (crossings == crossed.size()) {
        all_kept = false;
        return;
      }
      crossed[crossings++] = t;
    });
  });
  if (all_kept) return crossings % 2 == 1;
  // More layers than the array can hold: test every triangle once.
  unsigned all = 0;
  for (std::int32_t t = 0; t < surface_->triangle_count(); ++t) {
    double parameter = 0;
    all += segment.cross(t, parameter) != Crossing::kNone;
  }
  return all % 2 == 1;
}

template <class Surface>
template <bool kWide>
inline SurfacePoint GridSearch<Surface>::find_closest(const Vector3d& p_W,
                                                      double radius) const noexcept {
  const Vector3d p = frame_.to_steps(p_W);
  const double reach = reach_of(frame_, radius);
  const double side = grid_.side(), per_unit = grid_.parts().per_unit;
  const double room = kGridRoom * side + 0x1p-48 * p.cwiseAbs().maxCoeff();
  NearestPoint<Surface> best(*surface_, frame_, p, reach);
  NearestInUnits nearest = nearest_in_units(reach + room, room, per_unit);
  const float none = nearest.far;
  Asked asked;
  NearTriangles near;
  const auto consider = [&](std::span<const std::int32_t> list) noexcept {
    if constexpr (kWide) {
      lanes_avx2::consider_list(*surface_, frame_, list, p.data(), best.so_far());
    } else {
      best.consider(list);
    }
  };
  // Bounds the distance of each triangle by its rounded corners. Those that may be the nearest are
  // decided exactly at the end, all at once.
  const auto visit = [&](const VolumeList& list) noexcept {
    const Vector3d seen = per_unit * (p - list.middle);
    visit_eights(list, [&](const EightTriangles& eight, unsigned there,
                           const std::int32_t* triangles) noexcept {
      if (nearest.far < none) {
        there &= kWide ? lanes_avx2::nearer_of_eight(nearest, seen.data(), eight)
                       : nearer_of_eight(nearest, seen, eight);
        if (there == 0) return;
      }
      alignas(32) std::array<float, EightTriangles::kCapacity> low;
      unsigned left =
          kWide ? lanes_avx2::measure_eight(nearest, seen.data(), eight, there, low.data())
                : measure_eight(nearest, seen, eight, there, low.data());
      if (near.full()) {
        near.drop_beyond(nearest.far);
        if (near.full()) {
          consider(near.list());
          near.clear();
        }
      }
      for (; left != 0; left &= left - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(left));
        if (asked.first_time(triangles[lane])) near.add(triangles[lane], low[lane]);
      }
    });
  };
  // The volume of the point, then wider and wider boxes until one has a triangle within reach; then
  // the ball up to that triangle.
  const VolumeGrid::Place own = grid_.place_of(p);
  const Vector3d own_corner = grid_.corner_of(own);
  grid_.visit_one(own, visit);
  const double per_step = 1 / per_unit;
  const auto distance = [&]() noexcept { return nearest.far * per_step; };
  const auto ask_within = [&](double r) noexcept {
    const Vector3d grown = Vector3d::Constant(r + room);
    grid_.visit_box(
        p - grown, p + grown,
        [&](const Vector3d& corner) noexcept {
          const double ball = distance() + room;
          return corner != own_corner && gap_to_box(p, corner, side).squaredNorm() <= ball * ball;
        },
        visit);
  };
  double width = 0;
  while (!(nearest.far < none) && width < reach) {
    width = width > 0 ? 2 * width : grid_.clearance(p) + side;
    ask_within(std::min(width, reach));
  }
  // If it is near in the middle of a large volume, all others are farther.
  if (nearest.far < none && distance() > width &&
      (width > 0 || distance() + room > grid_.within_volume(p))) {
    ask_within(distance());
  }
  near.drop_beyond(nearest.far);
  consider(near.list());
  return best.point();
}

template <class Surface>
SurfacePoint GridSearch<Surface>::find_closest_wide(const Vector3d& p_W,
                                                    double radius) const noexcept {
  return find_closest<true>(p_W, radius);
}

template <class Surface>
SurfacePoint GridSearch<Surface>::closest(const Vector3d& p_W, double radius) const noexcept {
  if (!within_range(p_W) || !(radius >= 0)) return {};
  return wide_ ? find_closest_wide(p_W, radius) : find_closest<false>(p_W, radius);
}

template <class Surface>
double GridSearch<Surface>::clearance(const Vector3d& p_W) const noexcept {
  if (!within_range(p_W)) return 0;
  const Vector3d p = frame_.to_steps(p_W);
  return std::max(0.0, grid_.clearance(p) - 0x1p-48 * p.cwiseAbs().maxCoeff()) * frame_.step;
}

template class GridSearch<ContactMesh>;
template class GridSearch<PackedSurface>;

}  // namespace thimble::render
