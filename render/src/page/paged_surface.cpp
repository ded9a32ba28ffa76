#include "page/paged_surface.h"

#include <sys/resource.h>
#include <unistd.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <utility>

#include "mesh/closest_point.h"
#include "page/page_segment.h"
#include "search/segment_test.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

// How long the loader rests when there is nothing to bring: at 0.5 m/s the tip moves 0.1 mm, a
// tenth of the default reach.
constexpr std::chrono::microseconds kRest{200};

// The loader works little and must not wait: before all programs, after what is real-time.
constexpr int kLoaderNice = -15;

// So many pages nearer than the nearest triangle found may be absent before a search for it gives
// up: a few hundred ns.
constexpr int kAbsentMax = 64;

// Into so many pieces at most a way is cut to find the pages beside it.
constexpr int kPiecesMax = 64;

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
      wanted_in_(table_.size(), 0),
      incoming_(kPageTriangles) {
  for (auto& frame : table_) frame.store(kAbsent, std::memory_order_relaxed);
  wanted_.reserve(table_.size());
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
  // In one order with the loader's taking back of pages: either it sees this tick and waits for its
  // end, or this tick no longer finds the page.
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
      // No triangle of its own is farther than its box's farthest corner: so no other page that is
      // farther than that matters. Who lacks many still does not know; and a tick has an end.
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
  if (nearest == nullptr) {  // The loader has taken its page back meanwhile.
    complete = false;
    return false;
  }
  const PackedTriangle& r = *nearest;
  const Vector3d a = r.corner(0);
  const Vector3d side = r.corner(1) - a, other = r.corner(2) - a;
  const Vector3d n = side.cross(other);
  // A thousandth of the triangle below its middle is inside, and a way from there to the point
  // crosses the surface an even number of times if that is inside too. The way is as short as can
  // be, so that few pages need be there.
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

void PagedSurface::start_loader() {
  loader_ = std::thread([this] {
    // On a busy machine the pages would come late; where this is refused it goes on as it is.
    (void)setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kLoaderNice);
    while (!stop_.load(std::memory_order_relaxed)) {
      if (serve() == 0) std::this_thread::sleep_for(kRest);
    }
  });
}

void PagedSurface::want(const Cursor& cursor) {
  const Lattice& lattice = file_.lattice();
  const auto in_steps = [&lattice](const std::array<double, 3>& p) -> Vector3d {
    return (Eigen::Map<const Vector3d>(p.data()) - lattice.origin) / lattice.step;
  };
  const Vector3d tip = in_steps(cursor.p_tip), place = in_steps(cursor.p_place);
  const Vector3d ahead =
      settings_.horizon / lattice.step * Eigen::Map<const Vector3d>(cursor.v_W.data());
  wanted_.clear();
  want_along(place, ahead);
  if (tip != place) {
    want_along(tip, place - tip);
    want_along(tip, ahead);
  }
  // What is reached later may come later.
  std::sort(wanted_.begin(), wanted_.end());
}

// Adds the pages within reach of a straight way, each with how far along it and beside it they lie.
void PagedSurface::want_along(const Vector3d& p, const Vector3d& way) {
  const double reach = settings_.reach / file_.lattice().step;
  const double length = way.norm();
  const Vector3d along = length > 0 ? Vector3d(way / length) : Vector3d::Zero();
  // Pieces no longer than the reach, so that the boxes around them hold little else.
  const double asked = std::ceil(length / (2 * reach));  // a way that is no number asks for none
  const int pieces = asked > 1 ? static_cast<int>(std::min(asked, double{kPiecesMax})) : 1;
  for (int piece = 0; piece < pieces; ++piece) {
    const Vector3d from = p + way * piece / pieces, to = p + way * (piece + 1) / pieces;
    const Vector3d low = from.cwiseMin(to) - Vector3d::Constant(reach);
    const Vector3d high = from.cwiseMax(to) + Vector3d::Constant(reach);
    tree_.visit_reached(low, high, [&](std::int32_t page) {
      if (wanted_in_[static_cast<std::size_t>(page)] == round_) return true;
      const PageBox& box = file_.boxes()[static_cast<std::size_t>(page)];
      const Vector3d middle(0.5 * (double{box.min[0]} + double{box.max[0]}),
                            0.5 * (double{box.min[1]} + double{box.max[1]}),
                            0.5 * (double{box.min[2]} + double{box.max[2]}));
      const Vector3d half =
          Vector3d(double{box.max[0]}, double{box.max[1]}, double{box.max[2]}) - middle;
      // No part of the box is nearer than the place on the way nearest to its middle tells.
      const double ahead = std::clamp(along.dot(middle - p), 0.0, length);
      const double beside = std::sqrt(distance_squared(box, p + ahead * along));
      if (beside > reach + half.norm()) return true;
      wanted_in_[static_cast<std::size_t>(page)] = round_;
      wanted_.emplace_back(std::max(ahead - half.norm(), 0.0) + beside, page);
      return true;
    });
  }
}

std::size_t PagedSurface::serve() {
  Cursor cursor;
  if (!cursor_.load(cursor)) return 0;
  ++round_;
  want(cursor);
  if (wanted_.size() > frames_.size()) {
    wanted_.resize(frames_.size());
    short_of_frames_.fetch_add(1, std::memory_order_relaxed);
  }
  for (const auto& [distance, page] : wanted_) {
    const std::int32_t frame = table_[static_cast<std::size_t>(page)].load();
    if (frame >= 0) wanted_at_[static_cast<std::size_t>(frame)] = round_;
  }
  // A few pages at a time, then a new look at where the tip is.
  constexpr std::size_t kAtOnce = 16;
  std::size_t announced = 0;
  for (const auto& [distance, page] : wanted_) {
    if (announced == kAtOnce) break;
    if (table_[static_cast<std::size_t>(page)].load(std::memory_order_relaxed) != kAbsent) continue;
    file_.announce_page(page);
    ++announced;
  }
  std::size_t read = 0;
  for (const auto& [distance, page] : wanted_) {
    if (read == kAtOnce || stop_.load(std::memory_order_relaxed)) break;
    if (table_[static_cast<std::size_t>(page)].load() != kAbsent) continue;
    const std::int32_t frame = free_frame();
    if (frame < 0 || !load(page, frame)) continue;
    ++read;
  }
  return read;
}

std::int32_t PagedSurface::free_frame() {
  const auto oldest = std::min_element(wanted_at_.begin(), wanted_at_.end());
  if (*oldest == round_) return -1;
  const auto number = static_cast<std::int32_t>(oldest - wanted_at_.begin());
  std::int32_t& page = page_in_frame_[static_cast<std::size_t>(number)];
  if (page >= 0) {
    table_[static_cast<std::size_t>(page)].store(kAbsent, std::memory_order_seq_cst);
    page = -1;
    evictions_.fetch_add(1, std::memory_order_relaxed);
    wait_for_ticks_end();
  }
  return number;
}

void PagedSurface::wait_for_ticks_end() const {
  const std::uint64_t tick = tick_.load(std::memory_order_seq_cst);
  if (tick % 2 == 0) return;
  while (tick_.load(std::memory_order_seq_cst) == tick && !stop_.load(std::memory_order_relaxed)) {
    std::this_thread::yield();
  }
}

bool PagedSurface::load(std::int32_t page, std::int32_t frame_number) {
  Frame& frame = frames_[static_cast<std::size_t>(frame_number)];
  const std::int32_t count = file_.read_page(page, incoming_);
  if (count == 0 || stop_.load(std::memory_order_relaxed)) {
    if (count == 0) {
      // It would fail again, and keep the loader from what it can bring.
      table_[static_cast<std::size_t>(page)].store(kDamaged, std::memory_order_relaxed);
      failures_.fetch_add(1, std::memory_order_relaxed);
    }
    return false;
  }
  std::copy_n(incoming_.begin(), count, frame.triangles.begin());
  frame.count = count;
  for (std::int32_t begin = 0; begin < count; begin += kGroup) {
    const auto size = static_cast<std::size_t>(std::min(kGroup, count - begin));
    frame.boxes[static_cast<std::size_t>(begin / kGroup)] =
        box_of({frame.triangles.data() + begin, size});
  }
  page_in_frame_[static_cast<std::size_t>(frame_number)] = page;
  wanted_at_[static_cast<std::size_t>(frame_number)] = round_;
  loads_.fetch_add(1, std::memory_order_relaxed);
  table_[static_cast<std::size_t>(page)].store(frame_number, std::memory_order_seq_cst);
  return true;
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
