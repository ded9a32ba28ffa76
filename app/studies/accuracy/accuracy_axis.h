#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace thimble::studies {

/// Runs one stroke of work and returns a number computed from all results, so that the compiler
/// cannot remove any of it.
using Stroke = std::function<double()>;

/// One setting of a knob: its error and its work.
struct AccuracyPoint {
  std::string name;  ///< Without spaces: part of an argument of `thimble cost-probe`.
  double knob = 0;   ///< Value of the knob, in the unit of the axis.
  /// Computes the error against the truth, in the unit of the axis; bit-identical each time. NaN or
  /// infinite if the method has diverged.
  std::function<double()> error;
  /// Prepares one stroke; called once, outside of the timed part.
  std::function<Stroke()> prepare;
  /// Prepares the additional work of a stroke that is no cost of the point; its cost is subtracted.
  /// Empty if there is none.
  std::function<Stroke()> baseline = {};
  double ticks = 1;                ///< Divisor of a stroke's cost: ticks, or ms of touch.
  bool is_default = false;         ///< On an axis with `given`: the value of a PHANTOM-like arm.
  bool fits = false;               ///< Whether it is used for the slope of the line.
  std::optional<double> law = {};  ///< Error predicted by a published law, if there is one.
  std::string title = {};          ///< Words for the point, if line and knob do not describe it.
};

/// One method with several settings of its knob.
struct AccuracyLine {
  std::string name;                  ///< Without spaces.
  std::string title;                 ///< In words, for legends.
  std::optional<double> order = {};  ///< Theoretical slope of error over knob.
  bool exact = false;                ///< Its error should be at rounding level at every point.
  bool apart = false;                ///< Its points are separate methods, each with a name.
  std::vector<AccuracyPoint> points = {};
};

/// One diagram of accuracy and cost: a knob, an error with its truth, and methods.
struct AccuracyAxis {
  std::string name;   ///< Value of `--axis`, and name of the files.
  std::string title;  ///< Title of the diagram.
  std::string knob, knob_unit;
  std::string metric, unit;
  std::string truth;                     ///< One sentence: what the errors are measured against.
  std::optional<double> threshold = {};  ///< Threshold of perception, in `unit` [PHYSICS 6].
  std::string threshold_words;
  std::string felt_words;       ///< Replaces the sentence about the point beyond which accuracy
                                ///< cannot be felt.
  std::string per = "tick";     ///< Unit of work of the cost.
  bool given = false;           ///< The arm gives the value of the knob.
  bool cost_is_added = false;   ///< The cost is an increment, and may be negative.
  std::string default_words;    ///< Why the default is where it is, if it is not on the front.
  std::string left_out;         ///< One or two sentences: what this axis does not show, and why.
  bool over_cost = true;        ///< Draws the error over the cost.
  bool over_knob = true;        ///< Draws the error over the knob.
  bool cost_over_knob = false;  ///< Draws the cost over the knob, for exact methods.
  std::vector<AccuracyLine> lines;
};

/// A function that makes one axis, without measuring.
struct AxisMaker {
  std::string_view name;
  AccuracyAxis (*make)();
};

/// Returns every axis, in the order of the page. To add one, write its file and add its line there.
std::span<const AxisMaker> accuracy_axes();

}  // namespace thimble::studies
