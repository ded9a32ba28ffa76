#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "studies/accuracy/accuracy_axis.h"

namespace thimble::studies {

/// Result of one point. `error` is in the unit of the axis.
struct MeasuredPoint {
  const AccuracyPoint* point = nullptr;
  double error = 0;
  bool diverged = false;  ///< If true, `error` is undefined.
  double ns = 0;          ///< Median time per tick (or the axis' unit of work).
  double ns_spread = 0;   ///< Half of the interquartile range.
  std::optional<double> instructions;
  bool on_front = false;  ///< No other point is both cheaper and better.

  /// Returns the cost of the point: instructions if counted, because they do not depend on other
  /// load of the machine, otherwise ns.
  double cost() const { return instructions.value_or(ns); }
};

/// Result of one line.
struct MeasuredLine {
  const AccuracyLine* line = nullptr;
  std::optional<double> slope;  ///< Of log error over log knob, through the points with `fits`.
  std::vector<MeasuredPoint> points;
};

/// Result of one axis. It contains pointers into `axis`, so it may be moved but not copied.
struct MeasuredAxis {
  MeasuredAxis() = default;
  MeasuredAxis(MeasuredAxis&&) = default;
  MeasuredAxis& operator=(MeasuredAxis&&) = default;

  AccuracyAxis axis;
  std::vector<MeasuredLine> lines;
  bool complete = true;  ///< False: the measurement was stopped, and numbers are missing.

  const MeasuredPoint* default_point() const;
  const MeasuredLine* line_of(const MeasuredPoint* point) const;
  /// Returns the cheapest point with an error below the threshold; nullptr if there is none.
  const MeasuredPoint* enough() const;
};

struct MeasureOptions {
  int rounds = 15;    ///< Timed strokes of each point, alternating with all others; 0: no timing.
  bool count = true;  ///< Counts instructions, if valgrind is installed.
  const std::atomic<bool>* stop = nullptr;      ///< Ends the measurement early when true.
  std::function<void(int steps)> advance = {};  ///< Called during the measurement, with the number
                                                ///< of completed steps.
};

/// Returns the number of steps that `measure_axis` reports for an axis, as a measure of its
/// duration.
int steps_of(const AccuracyAxis& axis, const MeasureOptions& options);

/// Returns the measured numbers of an axis, for a journal: error, time, its spread, and
/// instructions (NaN if not counted) of each point.
std::vector<double> numbers_of(const MeasuredAxis& measured);

/// Returns an axis with the numbers of `numbers_of` instead of measuring them; not complete if
/// their count does not match. Real-time: never from the servo thread.
MeasuredAxis with_numbers(AccuracyAxis axis, std::span<const double> numbers);

/// Measures errors, time and instructions of all points. Errors are bit-identical each time; times
/// are medians on this machine. Real-time: never from the servo thread.
MeasuredAxis measure_axis(AccuracyAxis axis, const MeasureOptions& options);

/// The minimum number of points for a slope: two points fit any law.
inline constexpr int kSlopePointsMin = 4;

/// Returns the slope of log error over log knob through the points with `fits`; empty if fewer than
/// `kSlopePointsMin` of them have an error. Real-time: never from the servo thread.
std::optional<double> slope_of(const std::vector<MeasuredPoint>& points);

}  // namespace thimble::studies
