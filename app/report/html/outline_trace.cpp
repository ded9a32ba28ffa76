#include "report/html/outline_trace.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace thimble::report {

OutlineTrace::OutlineTrace(std::uint64_t expected_ticks) : ticks_(kRowsMax), periods_ns_(kRowsMax) {
  const std::uint64_t stretches = (kRowsMax - kTouchRowsMax) / kPerStretch - 1;
  stretch_ = std::max<std::uint64_t>(1, (expected_ticks + stretches - 1) / stretches);
}

void OutlineTrace::take(const driver::TickRecord& tick) noexcept {
  const auto length = [](const std::array<double, 3>& v) { return std::hypot(v[0], v[1], v[2]); };
  const Row last = own_[1];
  const Row row{.tick = tick, .period_ns = seen_ > 0 ? tick.time_ns - last.tick.time_ns : 0};
  const std::array<double, kOutlined> values{length(tick.f_sent_W),
                                             length(tick.f_wanted_W),
                                             tick.depth,
                                             static_cast<double>(row.period_ns),
                                             static_cast<double>(tick.work_ns),
                                             tick.p_WT[0],
                                             tick.p_WT[1],
                                             tick.p_WT[2]};
  if (in_stretch_ == 0) {
    own_.fill(row);
    extremes_.clear();
    changed_ = false;
  }
  extremes_.take(values, row);
  if (!changed_ && seen_ > 0 && tick.in_contact != last.tick.in_contact) {
    changed_ = true;
    own_[2] = last;
    own_[3] = row;
  }
  own_[1] = row;
  ++seen_;
  if (tick.in_contact && touch_rows_ < kTouchRowsMax) {
    ++touch_rows_;
    keep(row);
  }
  if (++in_stretch_ >= stretch_) end_stretch();
}

void OutlineTrace::end_stretch() noexcept {
  in_stretch_ = 0;
  std::array<const Row*, kPerStretch> rows;
  const auto address = [](const Row& row) { return &row; };
  const auto rest = std::transform(own_.begin(), own_.end(), rows.begin(), address);
  std::transform(extremes_.places().begin(), extremes_.places().end(), rest, address);
  std::sort(rows.begin(), rows.end(),
            [](const Row* a, const Row* b) { return a->tick.tick < b->tick.tick; });
  for (std::size_t n = 0; n < kPerStretch; ++n) {
    if (n > 0 && rows[n]->tick.tick == rows[n - 1]->tick.tick) continue;
    keep(*rows[n]);
  }
}

void OutlineTrace::keep(const Row& row) noexcept {
  if (kept_ >= ticks_.size()) return;
  ticks_[kept_] = row.tick;
  periods_ns_[kept_++] = row.period_ns;
}

void OutlineTrace::finish() {
  if (finished_) return;
  finished_ = true;
  if (in_stretch_ > 0) end_stretch();
  std::vector<std::size_t> order(kept_);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [this](std::size_t a, std::size_t b) { return ticks_[a].tick < ticks_[b].tick; });
  std::vector<driver::TickRecord> ticks;
  std::vector<std::int64_t> periods_ns;
  ticks.reserve(kept_);
  periods_ns.reserve(kept_);
  for (const std::size_t i : order) {
    if (!ticks.empty() && ticks.back().tick == ticks_[i].tick) continue;
    ticks.push_back(ticks_[i]);
    periods_ns.push_back(periods_ns_[i]);
  }
  kept_ = ticks.size();
  ticks_ = std::move(ticks);
  periods_ns_ = std::move(periods_ns);
}

}  // namespace thimble::report
