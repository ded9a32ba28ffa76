#pragma once

#include <cstddef>
#include <limits>
#include <optional>

namespace thimble::view {

/// A range of the time of a run, s.
struct TimeRange {
  double begin = 0, end = 0;

  double width() const { return end - begin; }
};

/// The smallest and the largest value of a part of a curve.
struct Extent {
  float min = std::numeric_limits<float>::infinity();
  float max = -std::numeric_limits<float>::infinity();
  bool empty() const { return max < min; }
  void add(const Extent& other);
};

/// A value over time, as samples; drawn by `draw_curves`. Real-time: never from the servo thread.
class Curve {
 public:
  virtual ~Curve() = default;

  virtual std::size_t size() const = 0;
  /// Returns the time of a sample on the drawn axis, s. The times do not decrease.
  virtual double time(std::size_t i) const = 0;
  /// Returns the value of a sample, SI or in the unit of an own signal.
  virtual float value(std::size_t i) const = 0;
  /// Returns the extent of the samples from `from` up to, and without, `to`. Fast for many samples.
  virtual Extent extent(std::size_t from, std::size_t to) const = 0;

  /// Returns the index of the first sample that is not earlier; `size` if there is none.
  std::size_t first_at(double time) const;
  /// Returns the extent within a range of time, including its ends.
  Extent extent(const TimeRange& range) const;
  /// Returns the value of the last sample that is no later than `time`; none before the first and
  /// after the last.
  std::optional<double> value_at(double time) const;
};

}  // namespace thimble::view
