#include "view/playback/plots.h"

#include <algorithm>
#include <cmath>

namespace thimble::view {
namespace {

constexpr double kNarrowest = 1e-4;  // s

}  // namespace

TimeRange shifted(const TimeRange& range, double by, const TimeRange& all) {
  const double width = std::min(range.width(), all.width());
  const double begin = std::clamp(range.begin + by, all.begin, all.end - width);
  return {begin, begin + width};
}

TimeRange zoomed(const TimeRange& range, double at, double factor, const TimeRange& all) {
  const double widest = std::max(all.width(), kNarrowest);
  const double width = std::clamp(factor * range.width(), kNarrowest, widest);
  const double share = range.width() > 0 ? (at - range.begin) / range.width() : 0.5;
  const double begin = at - share * width;
  if (width >= all.width()) return all;
  return shifted({begin, begin + width}, 0, all);
}

Plots Plots::of_recording() {
  Plots plots;
  plots.seconds_ = std::numeric_limits<double>::infinity();
  plots.samples_max_ = std::numeric_limits<std::size_t>::max();
  return plots;
}

void Plots::clear() {
  samples_.clear();
  blocks_.clear();
  dropped_ = 0;
}

void Plots::add(const driver::TickRecord& tick) {
  const double time = static_cast<double>(tick.time_ns) * 1e-9;
  if (!samples_.empty() && time < samples_.back().time) clear();
  const double last = samples_.empty() ? time : samples_.back().time;
  const auto length = [](const std::array<double, 3>& v) {
    return static_cast<float>(std::hypot(v[0], v[1], v[2]));
  };
  const Sample sample{
      time,
      {length(tick.f_sent_W), static_cast<float>(tick.in_contact ? tick.depth : 0),
       static_cast<float>(static_cast<double>(tick.work_ns) * 1e-9),
       static_cast<float>(time - last), length(tick.v_WT), static_cast<float>(tick.p_WT[0]),
       static_cast<float>(tick.p_WT[1]), static_cast<float>(tick.p_WT[2])}};
  if ((dropped_ + samples_.size()) % kBlock == 0 || blocks_.empty()) blocks_.emplace_back();
  for (std::size_t k = 0; k < kChannels; ++k) {
    Extent& extent = blocks_.back()[k];
    extent.min = std::min(extent.min, sample.value[k]);
    extent.max = std::max(extent.max, sample.value[k]);
  }
  samples_.push_back(sample);
  while (samples_.front().time < time - seconds_ || samples_.size() > samples_max_) {
    samples_.pop_front();
    if (++dropped_ % kBlock == 0) blocks_.pop_front();
  }
}

TimeRange Plots::kept() const {
  if (samples_.empty()) return {};
  return {samples_.front().time, samples_.back().time};
}

TimeRange Plots::newest() const {
  const TimeRange all = kept();
  const double end = std::max(all.end, all.begin + kShownSeconds);
  return {end - kShownSeconds, end};
}

std::optional<TimeRange> Plots::whole_run(double duration) const {
  const TimeRange all = kept();
  if (!(duration > 0 && duration <= kSeconds && all.begin >= 0 && all.end <= duration)) return {};
  return TimeRange{0, duration};
}

std::size_t Plots::first_at(double time) const {
  const auto found =
      std::lower_bound(samples_.begin(), samples_.end(), time,
                       [](const Sample& sample, double t) { return sample.time < t; });
  return static_cast<std::size_t>(found - samples_.begin());
}

std::optional<double> Plots::value_at(Channel channel, double time) const {
  // Ticks are whole nanoseconds, so a smaller difference is the same time.
  constexpr double kSame = 0.5e-9;
  if (samples_.empty() ||
      !(time >= samples_.front().time - kSame && time <= samples_.back().time + kSame)) {
    return {};
  }
  return samples_[first_at(time + kSame) - 1].value[static_cast<std::size_t>(channel)];
}

Plots::Extent Plots::extent(Channel channel, std::size_t from, std::size_t to) const {
  const auto k = static_cast<std::size_t>(channel);
  Extent extent;
  const auto add = [&](float min, float max) {
    extent.min = std::min(extent.min, min);
    extent.max = std::max(extent.max, max);
  };
  const std::uint64_t first_block = dropped_ / kBlock;
  for (std::uint64_t i = dropped_ + from; i < dropped_ + to;) {
    if (i % kBlock == 0 && i + kBlock <= dropped_ + to) {
      const Extent& whole = blocks_[static_cast<std::size_t>(i / kBlock - first_block)][k];
      add(whole.min, whole.max);
      i += kBlock;
    } else {
      const float value = samples_[static_cast<std::size_t>(i - dropped_)].value[k];
      add(value, value);
      ++i;
    }
  }
  return extent;
}

Plots::Extent Plots::extent(Channel channel, const TimeRange& range) const {
  std::size_t to = first_at(range.end);
  if (to < samples_.size() && samples_[to].time <= range.end) ++to;
  return extent(channel, first_at(range.begin), to);
}

}  // namespace thimble::view
