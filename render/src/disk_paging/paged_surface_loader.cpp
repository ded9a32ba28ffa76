// The thread of PagedSurface that loads the pages around the tip and along its path.
#include <sys/resource.h>
#include <unistd.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "disk_paging/paged_surface.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

// Pause of the loader if there is nothing to load: at 0.5 m/s the tip moves 0.1 mm, a tenth of the
// default reach.
constexpr std::chrono::microseconds kRest{200};

// The loader works little and must not wait: before all other programs, after real-time threads.
constexpr int kLoaderNice = -15;

// Maximum number of pieces of a path for finding the pages next to it.
constexpr int kPiecesMax = 64;

}  // namespace

void PagedSurface::start_loader() {
  loader_ = std::thread([this] {
    // On a busy machine pages would be late; if this is refused, the loader continues without it.
    (void)setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kLoaderNice);
    while (!stop_.load(std::memory_order_relaxed)) {
      if (serve() == 0) std::this_thread::sleep_for(kRest);
    }
  });
}

// Returns whether the pages in memory suffice for a position: all paths near it are nearer than
// `kSpare` to those of the last position for which all pages were loaded. False for NaN.
bool PagedSurface::suffices_for(const Cursor& cursor) const noexcept {
  if (!all_loaded_) return false;
  const double spare = kSpare * settings_.reach;
  using Numbers = std::array<double, 3>;
  const auto near = [spare](const Vector3d& p, const Vector3d& q) noexcept {
    return (p - q).squaredNorm() <= spare * spare;
  };
  const auto vector = [](const Numbers& x) noexcept { return Vector3d(x[0], x[1], x[2]); };
  const auto both_near = [&](const Numbers& p, const Numbers& q) noexcept {
    const Vector3d way = settings_.horizon * vector(cursor.v_W);
    const Vector3d way_loaded = settings_.horizon * vector(loaded_for_.v_W);
    return near(vector(p), vector(q)) && near(vector(p) + way, vector(q) + way_loaded);
  };
  // Paths are straight: if both ends are near those of another path, all of it is.
  return both_near(cursor.p_tip, loaded_for_.p_tip) &&
         both_near(cursor.p_place, loaded_for_.p_place);
}

// Lists the pages within `reach` (steps) of the paths of a position.
void PagedSurface::want(const Cursor& cursor, double reach) {
  const Lattice& lattice = file_.lattice();
  const auto in_steps = [&lattice](const std::array<double, 3>& p) -> Vector3d {
    return (Eigen::Map<const Vector3d>(p.data()) - lattice.origin) / lattice.step;
  };
  const Vector3d tip = in_steps(cursor.p_tip), place = in_steps(cursor.p_place);
  const Vector3d ahead =
      settings_.horizon / lattice.step * Eigen::Map<const Vector3d>(cursor.v_W.data());
  wanted_.clear();
  want_along(place, ahead, reach);
  if (tip != place) {
    want_along(tip, place - tip, reach);
    want_along(tip, ahead, reach);
  }
  // Pages that are reached later may be loaded later.
  std::sort(wanted_.begin(), wanted_.end());
}

// Adds the pages within reach of a straight path, each with its distance along the path and from
// it.
void PagedSurface::want_along(const Vector3d& p, const Vector3d& way, double reach) {
  const double length = way.norm();
  const Vector3d along = length > 0 ? Vector3d(way / length) : Vector3d::Zero();
  // Pieces no longer than the reach, so that the boxes around them contain little else.
  const double asked = std::ceil(length / (2 * reach));  // a path with NaN requests nothing
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
      // No part of the box is nearer than implied by the place on the path nearest to its middle.
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
  if (!cursor_.load(cursor) || suffices_for(cursor)) return 0;
  const double reach = settings_.reach / file_.lattice().step;
  ++round_;
  want(cursor, (1 + kSpare) * reach);
  bool spare = true;
  if (wanted_.size() > frames_.size()) {
    spare = false;
    ++round_;
    want(cursor, reach);
  }
  if (wanted_.size() > frames_.size()) {
    wanted_.resize(frames_.size());
    short_of_frames_.fetch_add(1, std::memory_order_relaxed);
  }
  for (const auto& [distance, page] : wanted_) {
    const std::int32_t frame = table_[static_cast<std::size_t>(page)].load();
    if (frame >= 0) mark_wanted(frame);
  }
  // A few pages at a time, then the tip's position is read again.
  constexpr std::size_t kAtOnce = 16;
  std::size_t announced = 0;
  for (const auto& [distance, page] : wanted_) {
    if (announced == kAtOnce) break;
    if (table_[static_cast<std::size_t>(page)].load(std::memory_order_relaxed) != kAbsent) continue;
    // The first one is read at once.
    if (announced++ > 0) file_.announce_page(page);
  }
  std::size_t read = 0;
  all_loaded_ = spare;
  for (const auto& [distance, page] : wanted_) {
    if (table_[static_cast<std::size_t>(page)].load() != kAbsent) continue;
    if (read == kAtOnce || stop_.load(std::memory_order_relaxed)) {
      all_loaded_ = false;
      break;
    }
    const std::int32_t frame = free_frame();
    if (frame >= 0 && load(page, frame)) ++read;
  }
  loaded_for_ = cursor;
  return read;
}

void PagedSurface::mark_wanted(std::int32_t frame) {
  wanted_at_[static_cast<std::size_t>(frame)] = round_;
  order_.use(frame);
}

std::int32_t PagedSurface::free_frame() {
  const std::int32_t number = order_.oldest();
  if (wanted_at_[static_cast<std::size_t>(number)] == round_) return -1;
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
  // A tick may still use the frame if its end was not awaited.
  if (stop_.load(std::memory_order_relaxed)) return false;
  Frame& frame = frames_[static_cast<std::size_t>(frame_number)];
  const std::int32_t count = file_.read_page(page, frame.triangles);
  if (count == 0) {
    // It would fail again, and keep the loader from other pages.
    table_[static_cast<std::size_t>(page)].store(kDamaged, std::memory_order_relaxed);
    failures_.fetch_add(1, std::memory_order_relaxed);
    return false;
  }
  frame.count = count;
  for (std::int32_t begin = 0; begin < count; begin += kGroup) {
    const auto size = static_cast<std::size_t>(std::min(kGroup, count - begin));
    frame.boxes[static_cast<std::size_t>(begin / kGroup)] =
        box_of({frame.triangles.data() + begin, size});
  }
  page_in_frame_[static_cast<std::size_t>(frame_number)] = page;
  mark_wanted(frame_number);
  loads_.fetch_add(1, std::memory_order_relaxed);
  table_[static_cast<std::size_t>(page)].store(frame_number, std::memory_order_seq_cst);
  return true;
}

}  // namespace thimble::render
