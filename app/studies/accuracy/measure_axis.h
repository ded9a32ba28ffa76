#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "studies/accuracy/accuracy_axis.h"

namespace thimble::studies {

/// What one point was found to be. `error` in the unit of the axis.
struct MeasuredPoint {
  const AccuracyPoint* point = nullptr;
  double error = 0;
  bool diverged = false;  ///< Then `error` stands for nothing.
  double ns = 0;          ///< Median of the work of a tick (or what the axis counts for).
  double ns_spread = 0;   ///< Half the distance between the quartiles.
  std::optional<double> instructions;
  bool on_front = false;  ///< No other point is both cheaper and better.

  /// Returns what the point costs: instructions where they were counted, for they do not depend on
  /// what else the machine does, else ns.
  double cost() const { return instructions.value_or(ns); }
};

/// What one line was found to be.
struct MeasuredLine {
  const AccuracyLine* line = nullptr;
  std::optional<double> slope;  ///< Of log error over log knob, through the points that fit.
  std::vector<MeasuredPoint> points;
};

/// What one axis was found to be. Points into `axis`, so it is moved and never copied.
struct MeasuredAxis {
  MeasuredAxis() = default;
  MeasuredAxis(MeasuredAxis&&) = default;
  MeasuredAxis& operator=(MeasuredAxis&&) = default;

  AccuracyAxis axis;
  std::vector<MeasuredLine> lines;
  bool complete = true;  ///< False: it was stopped, and numbers are missing.

  const MeasuredPoint* default_point() const;
  const MeasuredLine* line_of(const MeasuredPoint* point) const;
  /// Finds the cheapest point that cannot be told from the truth; nullptr if there is none.
  const MeasuredPoint* enough() const;
};

struct MeasureOptions {
  int rounds = 15;    ///< Strokes timed of each point, in turn with all others; 0: no time.
  bool count = true;  ///< Counts instructions, if valgrind is installed.
  const std::atomic<bool>* stop = nullptr;      ///< Ends the measurement early once it is true.
  std::function<void(int steps)> advance = {};  ///< Called as it gets on, with steps done.
};

/// Returns how many steps `measure_axis` reports for an axis, as a measure of its duration.
int steps_of(const AccuracyAxis& axis, const MeasureOptions& options);

/// Returns the measured numbers of an axis, for a journal: error, time, its spread, and
/// instructions (NaN if not counted) of each point.
std::vector<double> numbers_of(const MeasuredAxis& measured);

/// Returns an axis with the numbers of `numbers_of` instead of measuring them; not complete if they
/// are not as many as it has. Real-time: never from the servo thread.
MeasuredAxis with_numbers(AccuracyAxis axis, std::span<const double> numbers);

/// Measures errors, time and instructions of all points. Errors are the same bits each time; times
/// are medians on whatever this machine is. Real-time: never from the servo thread.
MeasuredAxis measure_axis(AccuracyAxis axis, const MeasureOptions& options);

/// The fewest points through which a slope is drawn: through two, every law fits.
inline constexpr int kSlopePointsLeast = 4;

/// Finds the slope of log error over log knob through the points that fit; empty if fewer than
/// `kSlopePointsLeast` of them have an error. Real-time: never from the servo thread.
std::optional<double> slope_of(const std::vector<MeasuredPoint>& points);

}  // namespace thimble::studies
