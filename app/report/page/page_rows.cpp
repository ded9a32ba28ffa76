#include "report/page/page_rows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace thimble::app {
namespace {

using driver::TickRecord;

double size_of(const std::array<double, 3>& v) {
  return std::hypot(v[0], v[1], v[2]);
}

std::int64_t period_ns(std::span<const TickRecord> ticks, std::size_t i) {
  if (ticks.size() < 2) return 0;
  // Nobody knows how long the first took to come; it shall not stand out.
  return i > 0 ? ticks[i].time_ns - ticks[i - 1].time_ns : ticks[1].time_ns - ticks[0].time_ns;
}

// What is plotted, and must keep its outline.
constexpr std::size_t kOutlined = 5;
std::array<double, kOutlined> outlined(std::span<const TickRecord> ticks, std::size_t i) {
  return {size_of(ticks[i].f_sent_W), size_of(ticks[i].f_wanted_W), ticks[i].depth,
          static_cast<double>(period_ns(ticks, i)), static_cast<double>(ticks[i].work_ns)};
}

// A stretch gives its first tick, and the least and the most of each.
constexpr std::size_t kPerStretch = 1 + 2 * kOutlined;

void keep_of(std::span<const TickRecord> ticks, std::size_t begin, std::size_t end,
             std::vector<std::size_t>& kept) {
  std::array<std::size_t, kPerStretch> own;
  own.fill(begin);
  auto least = outlined(ticks, begin);
  auto most = least;
  for (std::size_t i = begin + 1; i < end; ++i) {
    const auto values = outlined(ticks, i);
    for (std::size_t k = 0; k < kOutlined; ++k) {
      if (values[k] < least[k]) {
        least[k] = values[k];
        own[1 + 2 * k] = i;
      }
      if (values[k] > most[k]) {
        most[k] = values[k];
        own[2 + 2 * k] = i;
      }
    }
  }
  std::sort(own.begin(), own.end());
  kept.insert(kept.end(), own.begin(), std::unique(own.begin(), own.end()));
}

}  // namespace

std::vector<std::size_t> rows_kept(std::span<const TickRecord> ticks, std::size_t rows_most) {
  std::vector<std::size_t> kept;
  if (ticks.size() <= rows_most) {
    kept.resize(ticks.size());
    for (std::size_t i = 0; i < kept.size(); ++i) kept[i] = i;
    return kept;
  }
  // The last tick is kept as well, so that the page ends where the run did.
  const std::size_t stretches = std::max<std::size_t>(1, (rows_most - 1) / kPerStretch);
  for (std::size_t s = 0; s < stretches; ++s) {
    const std::size_t begin = ticks.size() * s / stretches;
    const std::size_t end = ticks.size() * (s + 1) / stretches;
    if (begin < end) keep_of(ticks, begin, end, kept);
  }
  if (kept.back() + 1 != ticks.size()) kept.push_back(ticks.size() - 1);
  return kept;
}

void add_rows(PageBlock& block, const std::string& prefix, std::span<const TickRecord> ticks,
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
    const TickRecord& tick = ticks[i];
    time.push_back(1e-9 * static_cast<double>(tick.time_ns - begin_ns));
    number.push_back(static_cast<std::uint32_t>(tick.tick));
    push(tip, tick.p_WT);
    push(proxy, tick.in_contact ? tick.p_WP : tick.p_WT);
    push(sent, tick.f_sent_W);
    asked.push_back(static_cast<float>(size_of(tick.f_wanted_W)));
    depth.push_back(static_cast<float>(tick.in_contact ? tick.depth : 0));
    period.push_back(static_cast<float>(1e-9 * static_cast<double>(period_ns(ticks, i))));
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

}  // namespace thimble::app
