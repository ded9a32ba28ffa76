#include "observers/dent_record.h"

#include <algorithm>

namespace thimble::session {
namespace {

constexpr std::int64_t kFrame = 16'000'000;  // ns: 60 pictures a second, as a screen shows

}  // namespace

DentRecord::DentRecord(render::SceneTouch& touch, std::int64_t period_ns)
    : touch_(touch), every_(ticks_between(period_ns)) {}

std::uint64_t DentRecord::ticks_between(std::int64_t period_ns) noexcept {
  return static_cast<std::uint64_t>(std::max<std::int64_t>(1, kFrame / period_ns));
}

void DentRecord::take(const driver::TickRecord& tick) noexcept {
  if (tick.tick % every_ != 0 || !touch_.draw(drawn_.patch)) return;
  ++drawn_.drawings;
  if (drawn_.patch.triangle_count == 0 || !(tick.depth > depth_)) return;
  depth_ = tick.depth;
  deepest_ = drawn_.patch;
}

}  // namespace thimble::session
