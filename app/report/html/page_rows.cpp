#include "report/html/page_rows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <queue>

#include "report/extremes.h"

namespace thimble::report {
namespace {

using driver::TickRecord;

double size_of(const std::array<double, 3>& v) {
  return std::hypot(v[0], v[1], v[2]);
}

// The plotted columns, whose outline must be kept.
constexpr std::size_t kOutlined = 6;
std::array<double, kOutlined> outlined(const PageTicks& ticks, std::size_t i) {
  const TickRecord& tick = ticks.ticks[i];
  return {size_of(tick.f_sent_W),
          size_of(tick.f_wanted_W),
          tick.depth,
          size_of(tick.v_WT),
          static_cast<double>(ticks.period_ns(i)),
          static_cast<double>(tick.work_ns)};
}

// A stretch contributes its first tick, and the minimum and the maximum of each column.
constexpr std::size_t kPerStretch = 1 + 2 * kOutlined;

// The values of a tick that are drawn: tip, proxy, force; then the outlined columns.
constexpr std::size_t kDrawn = 9 + kOutlined;
constexpr std::size_t kPath = 6;     // the first of them: tip and proxy, m
constexpr std::size_t kSmooth = 12;  // the first of them: the others may be noisy in each tick
std::array<double, kDrawn> drawn(const PageTicks& ticks, std::size_t i) {
  const TickRecord& tick = ticks.ticks[i];
  const auto& proxy = tick.in_contact ? tick.p_WP : tick.p_WT;
  const auto& f = tick.f_sent_W;
  const auto outline = outlined(ticks, i);
  std::array<double, kDrawn> all{tick.p_WT[0], tick.p_WT[1], tick.p_WT[2], proxy[0], proxy[1],
                                 proxy[2],     f[0],         f[1],         f[2]};
  std::copy(outline.begin(), outline.end(), all.begin() + 9);
  return all;
}

// The set of kept ticks.
class KeptTicks {
 public:
  explicit KeptTicks(std::size_t ticks) : kept_(ticks, 0) {}
  void keep(std::size_t i) {
    count_ += kept_[i] == 0 ? 1 : 0;
    kept_[i] = 1;
  }
  bool has(std::size_t i) const { return kept_[i] != 0; }
  std::size_t count() const { return count_; }
  std::vector<std::size_t> list() const {
    std::vector<std::size_t> list;
    list.reserve(count_);
    for (std::size_t i = 0; i < kept_.size(); ++i) {
      if (kept_[i] != 0) list.push_back(i);
    }
    return list;
  }

 private:
  std::vector<std::uint8_t> kept_;
  std::size_t count_ = 0;
};

// Keeps the first of some ticks, and those with the minimum and maximum of each outlined column.
void keep_outline(const PageTicks& ticks, std::span<const std::size_t> some, KeptTicks& kept) {
  Extremes<kOutlined> extremes;
  for (const std::size_t i : some) extremes.take(outlined(ticks, i), i);
  kept.keep(some.front());
  for (const std::size_t i : extremes.places()) kept.keep(i);
}

// Keeps the outline of some of the run's ticks in at most `rows`; all of them if they fit.
void keep_outlines(const PageTicks& ticks, std::span<const std::size_t> some, std::size_t rows,
                   KeptTicks& kept) {
  if (some.size() <= rows) {
    for (const std::size_t i : some) kept.keep(i);
    return;
  }
  const std::size_t stretches = rows / kPerStretch;
  for (std::size_t s = 0; s < stretches; ++s) {
    const std::size_t begin = some.size() * s / stretches;
    const std::size_t end = some.size() * (s + 1) / stretches;
    if (begin < end) keep_outline(ticks, some.subspan(begin, end - begin), kept);
  }
}

// Returns the largest of 1, 2, 5, 10, 20 ... that is not above `max_count`, so that stretches of a
// run of round length begin at round ticks; 1 at least.
std::size_t round_stretches(std::size_t max_count) {
  std::size_t round = 1;
  for (std::size_t power = 1; power <= max_count; power *= 10) {
    for (const std::size_t times : {1U, 2U, 5U}) {
      if (times * power <= max_count) round = times * power;
    }
  }
  return round;
}

// Keeps the ticks with the minimum and maximum of every drawn value in the whole run; returns the
// range of each, with a lower bound.
std::array<double, kDrawn> keep_extremes(const PageTicks& ticks, KeptTicks& kept) {
  Extremes<kDrawn> extremes;
  for (std::size_t i = 0; i < ticks.ticks.size(); ++i) extremes.take(drawn(ticks, i), i);
  for (const std::size_t i : extremes.places()) kept.keep(i);
  std::array<double, kDrawn> ranges;
  for (std::size_t k = 0; k < kDrawn; ++k) ranges[k] = std::max(1e-9, extremes.range(k));
  return ranges;
}

// Ticks between two rows, which are shown like the first of them.
struct Gap {
  double error = 0;        // error of the display, in visible units
  std::size_t begin = 0;   // the row
  std::size_t end = 0;     // the next row
  std::size_t middle = 0;  // best position for a new row
  bool operator<(const Gap& other) const {
    return error < other.error || (error == other.error && begin > other.begin);
  }
};

// Visible differences: of the path, m, and of a curve, as a fraction of its range; weight of ticks
// in contact. [chosen]
constexpr double kSeenOfPath = 1e-4, kSeenOfCurve = 0.04, kOfContact = 4;

Gap gap_of(const PageTicks& ticks, const std::array<double, kDrawn>& ranges, std::size_t begin,
           std::size_t end) {
  Gap gap{.begin = begin, .end = end, .middle = begin + (end - begin) / 2};
  const auto shown = drawn(ticks, begin);
  double path = 0, curve = 0;
  std::size_t curve_at = begin + 1;
  std::vector<double> paths;
  paths.reserve(end - begin);
  for (std::size_t i = begin + 1; i < end; ++i) {
    const auto values = drawn(ticks, i);
    const double weight = ticks.ticks[i].in_contact ? kOfContact : 1;
    double off = 0;
    for (std::size_t k = 0; k < kPath; ++k) off = std::max(off, std::abs(values[k] - shown[k]));
    paths.push_back(weight * off / kSeenOfPath);
    path = std::max(path, paths.back());
    for (std::size_t k = kPath; k < kSmooth; ++k) {
      const double error = weight * std::abs(values[k] - shown[k]) / (kSeenOfCurve * ranges[k]);
      if (!(error > curve)) continue;
      curve = error;
      curve_at = i;
    }
  }
  gap.error = std::max(path, curve);
  if (curve > path) {
    gap.middle = curve_at;
    return gap;
  }
  // A path is divided at half of its largest deviation.
  for (std::size_t n = 0; n < paths.size(); ++n) {
    if (paths[n] < path / 2) continue;
    gap.middle = begin + 1 + n;
    break;
  }
  return gap;
}

// Adds the remaining rows where the display differs most from the ticks.
void keep_where_it_errs(const PageTicks& ticks, const std::array<double, kDrawn>& ranges,
                        std::size_t max_rows, KeptTicks& kept) {
  std::priority_queue<Gap> gaps;
  const auto add = [&](std::size_t begin, std::size_t end) {
    if (end - begin < 2) return;
    const Gap gap = gap_of(ticks, ranges, begin, end);
    if (gap.error > 0) gaps.push(gap);
  };
  const std::vector<std::size_t> rows = kept.list();
  for (std::size_t i = 1; i < rows.size(); ++i) add(rows[i - 1], rows[i]);
  while (kept.count() < max_rows && !gaps.empty()) {
    const Gap gap = gaps.top();
    gaps.pop();
    kept.keep(gap.middle);
    add(gap.begin, gap.middle);
    add(gap.middle, gap.end);
  }
}

// Distributes rows that still remain evenly over the other ticks, where nothing changes.
void keep_evenly(std::size_t ticks, std::size_t max_rows, KeptTicks& kept) {
  std::vector<std::size_t> others;
  for (std::size_t i = 0; i < ticks; ++i) {
    if (!kept.has(i)) others.push_back(i);
  }
  const std::size_t left = std::min(others.size(), max_rows - std::min(max_rows, kept.count()));
  for (std::size_t n = 0; n < left; ++n) kept.keep(others[n * others.size() / left]);
}

// Keeps the ticks before and after each begin and end of a touch, up to `rows` of them.
void keep_touch_ends(const PageTicks& ticks, std::size_t rows, KeptTicks& kept) {
  const std::size_t max_count = kept.count() + rows;
  for (std::size_t i = 1; i < ticks.ticks.size() && kept.count() + 2 <= max_count; ++i) {
    if (ticks.ticks[i].in_contact == ticks.ticks[i - 1].in_contact) continue;
    kept.keep(i - 1);
    kept.keep(i);
  }
}

}  // namespace

std::int64_t PageTicks::period_ns(std::size_t i) const noexcept {
  if (!periods_ns.empty()) return periods_ns[i > 0 || periods_ns.size() < 2 ? i : 1];
  if (ticks.size() < 2) return 0;
  // The period of the first tick is unknown; it must not stand out.
  const TickRecord& before = ticks[i > 0 ? i - 1 : 0];
  const TickRecord& tick = ticks[i > 0 ? i : 1];
  // The mean, if the ticks are not consecutive.
  const std::uint64_t apart = tick.tick > before.tick ? tick.tick - before.tick : 1;
  return (tick.time_ns - before.time_ns) / static_cast<std::int64_t>(apart);
}

std::vector<std::size_t> rows_kept(const PageTicks& ticks, std::size_t max_rows) {
  const std::size_t count = ticks.ticks.size();
  if (count <= max_rows) {
    std::vector<std::size_t> all(count);
    for (std::size_t i = 0; i < count; ++i) all[i] = i;
    return all;
  }
  KeptTicks kept(count);
  kept.keep(0);
  // The page ends with the last tick.
  kept.keep(count - 1);
  constexpr std::size_t kFixed = 2 + 2 * kDrawn;
  if (max_rows < 4 * kFixed) {  // room for an outline only
    std::vector<std::size_t> all(count);
    for (std::size_t i = 0; i < count; ++i) all[i] = i;
    if (max_rows > 2 + kPerStretch) keep_outlines(ticks, all, max_rows - 2, kept);
    return kept.list();
  }
  const auto ranges = keep_extremes(ticks, kept);
  keep_touch_ends(ticks, max_rows / 8, kept);
  std::vector<std::size_t> touching, free;
  for (std::size_t i = 0; i < count; ++i) {
    (ticks.ticks[i].in_contact ? touching : free).push_back(i);
  }
  // About one stretch per pixel of a plot, over all ticks.
  std::vector<std::size_t> all(count);
  for (std::size_t i = 0; i < count; ++i) all[i] = i;
  keep_outlines(ticks, all, kPerStretch * round_stretches(max_rows / (4 * kPerStretch)), kept);
  const std::size_t rows = max_rows - std::min(max_rows, kept.count());
  const std::size_t for_free =
      std::min(free.size(), std::max(rows / 4, rows - std::min(rows, touching.size())));
  keep_outlines(ticks, touching, rows - for_free, kept);
  keep_outlines(ticks, free, for_free, kept);
  keep_where_it_errs(ticks, ranges, max_rows, kept);
  keep_evenly(count, max_rows, kept);
  return kept.list();
}

void add_rows(PageBlock& block, const std::string& prefix, const PageTicks& ticks,
              std::span<const std::size_t> kept, std::int64_t begin_ns) {
  std::vector<double> time;
  std::vector<std::uint32_t> number;
  std::vector<float> tip, proxy, sent, asked, depth, period, work, speed;
  std::vector<std::int16_t> object;
  std::vector<std::uint8_t> touching;
  const auto push = [](std::vector<float>& to, const std::array<double, 3>& v) {
    for (const double one : v) to.push_back(static_cast<float>(one));
  };
  for (const std::size_t i : kept) {
    const TickRecord& tick = ticks.ticks[i];
    time.push_back(1e-9 * static_cast<double>(tick.time_ns - begin_ns));
    number.push_back(static_cast<std::uint32_t>(tick.tick));
    push(tip, tick.p_WT);
    push(proxy, tick.in_contact ? tick.p_WP : tick.p_WT);
    push(sent, tick.f_sent_W);
    asked.push_back(static_cast<float>(size_of(tick.f_wanted_W)));
    depth.push_back(static_cast<float>(tick.in_contact ? tick.depth : 0));
    period.push_back(static_cast<float>(1e-9 * static_cast<double>(ticks.period_ns(i))));
    work.push_back(static_cast<float>(1e-9 * static_cast<double>(tick.work_ns)));
    speed.push_back(static_cast<float>(size_of(tick.v_WT)));
    object.push_back(tick.object);
    touching.push_back(tick.in_contact ? 1 : 0);
  }
  block.add(prefix + "t", time);
  block.add(prefix + "tick", number);
  block.add(prefix + "tip", tip);
  block.add(prefix + "proxy", proxy);
  block.add(prefix + "sent", sent);
  block.add(prefix + "asked", asked);
  block.add(prefix + "depth", depth);
  block.add(prefix + "period", period);
  block.add(prefix + "work", work);
  block.add(prefix + "speed", speed);
  block.add(prefix + "object", object);
  block.add(prefix + "touching", touching);
}

}  // namespace thimble::report
