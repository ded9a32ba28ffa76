#include "view/playback/moment_ring.h"

#include <algorithm>
#include <utility>

namespace thimble::view {
namespace {

template <class T>
std::size_t bytes_of(const std::vector<T>& values) {
  return values.capacity() * sizeof(T);
}

std::size_t bytes_of(const render::TriangleMesh& mesh) {
  return sizeof mesh + bytes_of(mesh.vertices) + bytes_of(mesh.triangles);
}

}  // namespace

// Moments share shapes: each shape is counted once, with the oldest moment that has it.
std::size_t MomentRing::size_of(const Kept& kept) {
  std::size_t bytes = sizeof(Kept) + bytes_of(kept.poses) + bytes_of(kept.points) +
                      bytes_of(kept.triangles) + bytes_of(kept.sources) + bytes_of(kept.arm) +
                      bytes_of(kept.others) + bytes_of(kept.shapes);
  for (const DrawnArm& other : kept.others) bytes += bytes_of(other.rods);
  return bytes;
}

void MomentRing::clear() {
  kept_.clear();
  bytes_ = 0;
  shapes_time_ = -1e300;
}

void MomentRing::drop_oldest() {
  const Kept oldest = std::move(kept_.front());
  kept_.pop_front();
  bytes_ -= oldest.bytes;
  for (std::size_t i = 0; !kept_.empty() && i < oldest.shapes.size(); ++i) {
    Kept& next = kept_.front();
    if (!oldest.shapes[i] || i >= next.shapes.size() || next.shapes[i] != oldest.shapes[i]) {
      continue;
    }
    next.bytes += bytes_of(*oldest.shapes[i]);
    bytes_ += bytes_of(*oldest.shapes[i]);
  }
}

void MomentRing::take_shapes(const DrawnMoment& moment, Kept& kept) {
  const bool time_for_it = kept.time - shapes_time_ >= kShapeStep;
  kept.shapes = time_for_it || kept_.empty() ? moment.shapes : kept_.back().shapes;
  if (!time_for_it) return;
  shapes_time_ = kept.time;
  for (std::size_t i = 0; i < kept.shapes.size(); ++i) {
    if (!kept.shapes[i]) continue;
    const bool known = !kept_.empty() && i < kept_.back().shapes.size() &&
                       kept_.back().shapes[i] == kept.shapes[i];
    if (!known) kept.bytes += bytes_of(*kept.shapes[i]);
  }
}

void MomentRing::keep(const DrawnMoment& moment) {
  const double time = 1e-9 * static_cast<double>(moment.tick.time_ns);
  if (!kept_.empty() && time < kept_.back().time) clear();
  if (!kept_.empty() && time < kept_.back().time + kStep) return;
  Kept kept;
  kept.time = time;
  kept.tick = moment.tick;
  kept.poses = moment.poses;
  const render::BodyPatch& patch = moment.patch;
  if (patch.triangle_count > 0) {
    kept.object = patch.object;
    kept.complete = patch.complete;
    kept.share = patch.share;
    kept.points.assign(patch.points.begin(), patch.points.begin() + patch.point_count);
    kept.triangles.assign(patch.triangles.begin(), patch.triangles.begin() + patch.triangle_count);
    kept.sources.assign(patch.source.begin(), patch.source.begin() + patch.triangle_count);
  }
  kept.arm = moment.arm;
  kept.others = moment.others;
  take_shapes(moment, kept);
  kept.bytes += size_of(kept);
  bytes_ += kept.bytes;
  kept_.push_back(std::move(kept));
  while (kept_.size() > 1 && (oldest() < time - kSeconds || bytes_ > kBytesMax)) drop_oldest();
}

std::size_t MomentRing::place_of(double time) const {
  const auto after = std::upper_bound(kept_.begin(), kept_.end(), time,
                                      [](double t, const Kept& kept) { return t < kept.time; });
  return static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, after - kept_.begin() - 1));
}

double MomentRing::time_of_step(double time, int steps) const {
  const auto at = static_cast<std::ptrdiff_t>(place_of(time)) + steps;
  const auto last = static_cast<std::ptrdiff_t>(kept_.size()) - 1;
  return kept_[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(at, 0, last))].time;
}

bool MomentRing::show(double time, DrawnMoment& moment) const {
  if (kept_.empty()) return false;
  const Kept& kept = kept_[place_of(time)];
  moment.tick = kept.tick;
  moment.poses = kept.poses;
  moment.arm = kept.arm;
  moment.others = kept.others;
  moment.shapes = kept.shapes;
  render::BodyPatch& patch = moment.patch;
  patch.object = kept.object;
  patch.complete = kept.complete;
  patch.share = kept.share;
  patch.point_count = static_cast<std::uint16_t>(kept.points.size());
  patch.triangle_count = static_cast<std::uint16_t>(kept.triangles.size());
  std::copy(kept.points.begin(), kept.points.end(), patch.points.begin());
  std::copy(kept.triangles.begin(), kept.triangles.end(), patch.triangles.begin());
  std::copy(kept.sources.begin(), kept.sources.end(), patch.source.begin());
  return true;
}

}  // namespace thimble::view
