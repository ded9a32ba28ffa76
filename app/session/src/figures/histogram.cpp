#include "thimble/session/histogram.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace thimble::session {
namespace {

// From 2^11 on, each power of two is divided into 2^10 equal bins. So the width of a bin is at most
// 2^-10 of its lower end. A percentile needs only 1 %; 0.1 % resolves the jitter at 1 kHz to 1 us.
constexpr int kSubBits = 10;
constexpr std::int64_t kLinearEnd = std::int64_t{1} << (kSubBits + 1);

}  // namespace

Histogram::Histogram() : counts_(index_of(kMax_ns) + 1) {}

std::size_t Histogram::index_of(std::int64_t duration_ns) noexcept {
  if (duration_ns < kLinearEnd) return static_cast<std::size_t>(duration_ns);
  const int shift =
      static_cast<int>(std::bit_width(static_cast<std::uint64_t>(duration_ns))) - (kSubBits + 1);
  return (static_cast<std::size_t>(shift) << kSubBits) +
         static_cast<std::size_t>(duration_ns >> shift);
}

Histogram::Bin Histogram::bounds_of(std::size_t index) noexcept {
  const auto i = static_cast<std::int64_t>(index);
  if (i < kLinearEnd) return {i, i + 1, 0};
  const std::int64_t shift = (i >> kSubBits) - 1;
  const std::int64_t lower = (i - (shift << kSubBits)) << shift;
  return {lower, lower + (std::int64_t{1} << shift), 0};
}

void Histogram::add(std::int64_t duration_ns) noexcept {
  const std::int64_t duration = std::clamp<std::int64_t>(duration_ns, 0, kMax_ns);
  ++counts_[index_of(duration)];
  ++count_;
  min_ns_ = std::min(min_ns_, duration);
  max_ns_ = std::max(max_ns_, duration);
  sum_ns_ += static_cast<double>(duration);
}

double Histogram::percentile(double fraction) const {
  if (count_ == 0) return 0;
  const double asked = std::ceil(fraction * static_cast<double>(count_));
  const auto rank = static_cast<std::uint64_t>(std::max(asked, 1.0));
  std::uint64_t seen = 0;
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    seen += counts_[i];
    if (seen < rank) continue;
    const Bin bin = bounds_of(i);
    const double middle = 0.5 * static_cast<double>(bin.lower_ns + bin.upper_ns - 1);
    return std::clamp(middle, static_cast<double>(min_ns_), static_cast<double>(max_ns_));
  }
  return static_cast<double>(max_ns_);
}

double Histogram::mean_ns() const noexcept {
  return count_ > 0 ? sum_ns_ / static_cast<double>(count_) : 0;
}

std::vector<Histogram::Bin> Histogram::bins() const {
  std::vector<Bin> bins;
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    if (counts_[i] == 0) continue;
    bins.push_back(bounds_of(i));
    bins.back().count = counts_[i];
  }
  return bins;
}

}  // namespace thimble::session
