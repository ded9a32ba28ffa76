#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "thimble/driver/export.h"

namespace thimble::session {

/// Histogram of durations. Bins are 1 ns wide below 2048 ns and less than 0.1 % wide above, up to
/// 10 s. Longer durations count as 10 s, negative ones as 0. All memory is allocated by the
/// constructor.
class THIMBLE_EXPORT Histogram {
 public:
  /// Longest duration with a bin of its own.
  static constexpr std::int64_t kMax_ns = 10'000'000'000;

  /// A non-empty bin: values from `lower_ns` up to but not including `upper_ns`.
  struct Bin {
    std::int64_t lower_ns = 0;  ///< Lower bound, ns; included.
    std::int64_t upper_ns = 0;  ///< Upper bound, ns; not included.
    std::uint64_t count = 0;    ///< Number of durations in the bin.
  };

  Histogram();

  /// Counts one duration. Real-time: safe.
  void add(std::int64_t duration_ns) noexcept;

  /// Returns the number of durations counted. Real-time: safe.
  std::uint64_t count() const noexcept { return count_; }

  /// Returns the duration (ns) that the given fraction (0 to 1) of all durations do not exceed,
  /// with the resolution of its bin. Returns 0 if nothing was counted. Real-time: never from the
  /// servo thread.
  double percentile(double fraction) const;

  /// Returns the shortest duration, ns; 0 if nothing was counted. Real-time: safe.
  std::int64_t min_ns() const noexcept { return count_ > 0 ? min_ns_ : 0; }
  /// Returns the longest duration, ns; 0 if nothing was counted. Real-time: safe.
  std::int64_t max_ns() const noexcept { return max_ns_; }
  /// Returns the mean duration, ns; 0 if nothing was counted. Real-time: safe.
  double mean_ns() const noexcept;

  /// Returns the non-empty bins, shortest durations first. Real-time: never from the servo thread.
  std::vector<Bin> bins() const;

 private:
  static std::size_t index_of(std::int64_t duration_ns) noexcept;
  static Bin bounds_of(std::size_t index) noexcept;

  std::vector<std::uint64_t> counts_;
  std::uint64_t count_ = 0;
  std::int64_t min_ns_ = kMax_ns;
  std::int64_t max_ns_ = 0;
  double sum_ns_ = 0;
};

}  // namespace thimble::session
