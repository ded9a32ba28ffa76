#include "disk_paging/paged_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "disk_paging/page_segment.h"
#include "mesh/closest_point.h"
#include "search/segment_test.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

// Number of absent pages nearer than the nearest triangle found after which a search for it gives
// up: a few hundred ns.
constexpr int kAbsentMax = 64;

// Number of frames whose memory is provided when a file is opened: 64 MiB, half a metre of a stroke
// over 10^7 triangles on the ring of tests/bench. Memory for a page takes 5 to 14 us, as long as
// reading it [measured]; other frames get theirs when they are first used.
constexpr std::size_t kReadyFrames = 1024;

// Bytes of a memory page: one write in each lets the system provide it.
constexpr std::size_t kMemoryPage = 4096;

}  // namespace

driver::Result<std::unique_ptr<PagedSurface>> PagedSurface::open(const std::filesystem::path& file,
                                                                 const PagingSettings& settings) {
  const bool sound = settings.frames > 0 && settings.reach >= 0 && settings.horizon >= 0;
  if (!sound) {
    return driver::Error{"Paging needs at least one frame and a reach and horizon of at least 0."};
  }
  auto opened = PageFile::open(file);
  if (!opened) return opened.error();
  return std::unique_ptr<PagedSurface>(new PagedSurface(std::move(opened).value(), settings));
}

PagedSurface::PagedSurface(PageFile file, const PagingSettings& settings)
    : file_(std::move(file)),
      settings_(settings),
      tree_(file_.boxes()),
      table_(file_.boxes().size()),
      frames_(std::min(settings.frames, file_.boxes().size())),
      page_in_frame_(frames_.size(), -1),
      wanted_at_(frames_.size(), 0),
      order_(frames_.size()),
      wanted_in_(table_.size(), 0) {
  for (auto& frame : table_) frame.store(kAbsent, std::memory_order_relaxed);
  wanted_.reserve(table_.size());
  auto* const memory = reinterpret_cast<volatile unsigned char*>(frames_.data());
  const std::size_t ready = std::min(frames_.size(), kReadyFrames) * sizeof(Frame);
  for (std::size_t at = 0; at < ready; at += kMemoryPage) memory[at] = 0;
}

PagedSurface::~PagedSurface() {
  stop_.store(true);
  if (loader_.joinable()) loader_.join();
}

void PagedSurface::begin_tick(const Vector3d& p_tip, const Vector3d& p_place,
                              const Vector3d& v_W) noexcept {
  cursor_.store({.p_tip = {p_tip.x(), p_tip.y(), p_tip.z()},
                 .p_place = {p_place.x(), p_place.y(), p_place.z()},
                 .v_W = {v_W.x(), v_W.y(), v_W.z()}});
  // Sequentially consistent with the loader's eviction of pages: either the loader sees this tick
  // and waits for its end, or this tick no longer finds the page.
  tick_.fetch_add(1, std::memory_order_seq_cst);
}

void PagedSurface::end_tick() noexcept {
  tick_.fetch_add(1, std::memory_order_seq_cst);
}

template <class Visit>
bool PagedSurface::visit_crossings(const PageSegment& segment, Visit visit) const noexcept {
  bool complete = true;
  tree_.visit_reached(segment.low, segment.high, [&](std::int32_t page) noexcept {
    if (!segment.reaches(file_.boxes()[static_cast<std::size_t>(page)])) return true;
    const Frame* const frame = frame_of(page);
    if (frame == nullptr) {
      complete = false;
      return true;
    }
    for (std::int32_t begin = 0; begin < frame->count; begin += kGroup) {
      if (!segment.reaches(frame->boxes[static_cast<std::size_t>(begin / kGroup)])) continue;
      for (std::int32_t i = begin; i < std::min(begin + kGroup, frame->count); ++i) {
        double parameter = 0;
        const Crossing way =
            segment.cross(frame->triangles[static_cast<std::size_t>(i)], parameter);
        if (way != Crossing::kNone) visit(page * kPageTriangles + i, way, parameter);
      }
    }
    return true;
  });
  return complete;
}

FoundEntry PagedSurface::first_entry(const Vector3d& p_from, const Vector3d& p_to) const noexcept {
  FoundEntry found;
  if (!within_range(p_from) || !within_range(p_to)) return found;
  int crossings = 0;
  found.complete = visit_crossings(PageSegment(file_.lattice(), p_from, p_to),
                                   [&](std::int32_t t, Crossing way, double parameter) noexcept {
                                     ++crossings;
                                     if (way != Crossing::kEnters) return;
                                     const Entry& first = found.entry;
                                     if (first.triangle >= 0 && parameter >= first.parameter)
                                       return;
                                     found.entry = {t, parameter};
                                   });
  found.leaves = crossings % 2 == 0;
  return found;
}

std::int32_t PagedSurface::closest(const Vector3d& p_W, double radius,
                                   bool& complete) const noexcept {
  complete = true;
  if (!within_range(p_W) || !(radius >= 0)) return -1;
  const Vector3d p = (p_W - file_.lattice().origin) / file_.lattice().step;
  const double reach = radius / file_.lattice().step;
  double best_squared = reach * reach;
  double limit_squared = best_squared;
  double absent_squared = HUGE_VAL;
  std::int32_t best = -1;
  int absent = 0;
  tree_.visit_near(p, best_squared, [&](std::int32_t page, double squared) noexcept {
    const Frame* const frame = frame_of(page);
    if (frame == nullptr) {
      absent_squared = std::min(absent_squared, squared);
      // No triangle is farther than its page's farthest corner, so pages beyond that do not matter.
      // With many absent pages the result is unknown, and the time of a tick is bounded.
      limit_squared = std::min(limit_squared,
                               farthest_squared(file_.boxes()[static_cast<std::size_t>(page)], p));
      return ++absent < kAbsentMax ? limit_squared : 0.0;
    }
    const auto look = [&](std::int32_t begin) noexcept {
      for (std::int32_t i = begin; i < std::min(begin + kGroup, frame->count); ++i) {
        const PackedTriangle& r = frame->triangles[static_cast<std::size_t>(i)];
        const double away =
            (closest_point(p, r.corner(0), r.corner(1), r.corner(2)) - p).squaredNorm();
        const std::int32_t t = page * kPageTriangles + i;
        if (!(away < best_squared || (away == best_squared && best >= 0 && t < best))) continue;
        best_squared = away;
        best = t;
      }
    };
    // The nearest box first: then few others are near enough to be opened.
    std::array<double, kGroups> box_squared;
    std::size_t first = 0;
    const auto groups = static_cast<std::size_t>((frame->count + kGroup - 1) / kGroup);
    for (std::size_t group = 0; group < groups; ++group) {
      box_squared[group] = distance_squared(frame->boxes[group], p);
      if (box_squared[group] < box_squared[first]) first = group;
    }
    look(static_cast<std::int32_t>(first) * kGroup);
    for (std::size_t group = 0; group < groups; ++group) {
      if (group == first || !(box_squared[group] < best_squared)) continue;
      look(static_cast<std::int32_t>(group) * kGroup);
    }
    limit_squared = std::min(limit_squared, best_squared);
    return limit_squared;
  });
  complete = absent < kAbsentMax && !(absent_squared < best_squared);
  return best;
}

bool PagedSurface::inside(const Vector3d& p_W, bool& complete) const noexcept {
  const std::int32_t near = closest(p_W, HUGE_VAL, complete);
  if (!complete || near < 0) return false;
  const PackedTriangle* const nearest = find(near);
  if (nearest == nullptr) {  // The loader has evicted its page meanwhile.
    complete = false;
    return false;
  }
  const PackedTriangle& r = *nearest;
  const Vector3d a = r.corner(0);
  const Vector3d side = r.corner(1) - a, other = r.corner(2) - a;
  const Vector3d n = side.cross(other);
  // The point a thousandth of the triangle below its middle is inside. A path from there to the
  // query point crosses the surface an even number of times if that is inside too. The path is as
  // short as possible, so that few pages are needed.
  const double height = 1e-3 * std::sqrt(n.norm());
  const Vector3d under = a + (side + other) / 3 - height / n.norm() * n;
  int crossings = 0;
  complete = visit_crossings(
      PageSegment(file_.lattice(), p_W, file_.lattice().origin + file_.lattice().step * under),
      [&crossings](std::int32_t, Crossing, double) noexcept { ++crossings; });
  return complete && crossings % 2 == 0;
}

bool PagedSurface::inside_by_reading(const Vector3d& p_W) const {
  if (!within_range(p_W)) return false;
  Vector3d p_out = p_W;
  p_out.x() = file_.lattice().origin.x() + 4 * kLatticeHalf * file_.lattice().step;
  const PageSegment way(file_.lattice(), p_W, p_out);
  std::vector<PackedTriangle> triangles(kPageTriangles);
  int crossings = 0;
  bool read = true;
  tree_.visit_reached(way.low, way.high, [&](std::int32_t page) {
    const std::int32_t count = file_.read_page(page, triangles);
    read = read && count > 0;
    for (std::int32_t i = 0; i < count; ++i) {
      double parameter = 0;
      if (way.cross(triangles[static_cast<std::size_t>(i)], parameter) != Crossing::kNone) {
        ++crossings;
      }
    }
    return read;
  });
  return read && crossings % 2 == 1;
}

PagingCounters PagedSurface::counters() const noexcept {
  return {.loads = loads_.load(std::memory_order_relaxed),
          .evictions = evictions_.load(std::memory_order_relaxed),
          .failures = failures_.load(std::memory_order_relaxed),
          .misses = misses_.load(std::memory_order_relaxed),
          .short_of_frames = short_of_frames_.load(std::memory_order_relaxed)};
}

std::size_t PagedSurface::bytes() const noexcept {
  return frames_.size() * sizeof(Frame) + table_.size() * sizeof(table_[0]) +
         file_.boxes().size() * (5 * sizeof(PageBox) + sizeof(std::uint64_t));
}

}  // namespace thimble::render
