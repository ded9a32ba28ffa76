#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace thimble::studies {

/// Runs one stroke of work and returns a number made of all that was worked out, so that none of it
/// can be left out as unused.
using Stroke = std::function<double()>;

/// One setting of a knob: how wrong it is, and the work that it takes.
struct AccuracyPoint {
  std::string name;  ///< Without spaces: part of an argument of `thimble cost-probe`.
  double knob = 0;   ///< In the unit of the axis.
  /// Finds the error against the truth, in the unit of the axis: the same bits each time. NaN or
  /// infinite where the method has diverged.
  std::function<double()> error;
  /// Makes one stroke ready; called once, outside of what is timed.
  std::function<Stroke()> prepare;
  /// Makes ready what a stroke does besides, which is no cost of the point and is taken off; empty
  /// if there is nothing.
  std::function<Stroke()> beside = {};
  double ticks = 1;                ///< What a stroke's cost is divided by: ticks, or ms of touch.
  bool is_default = false;         ///< On a given axis: where a PHANTOM-like arm stands.
  bool fits = false;               ///< Whether the slope of the line is taken from it.
  std::optional<double> law = {};  ///< The error that a published law tells, if there is one.
  std::string title = {};  ///< In words, where the line's title and the knob do not name it.
};

/// One method over its knob.
struct AccuracyLine {
  std::string name;                  ///< Without spaces.
  std::string title;                 ///< In words, for legends.
  std::optional<double> order = {};  ///< Slope of error over knob that theory asks for.
  bool exact = false;                ///< Should sit at rounding level at every point.
  bool apart = false;                ///< Its points are methods of their own: each is named.
  std::vector<AccuracyPoint> points = {};
};

/// One diagram of what accuracy costs: a knob, an error with its truth, and methods.
struct AccuracyAxis {
  std::string name;   ///< `--axis NAME`, and of the files.
  std::string title;  ///< Says what is shown.
  std::string knob, knob_unit;
  std::string metric, unit;
  std::string truth;                     ///< One sentence: what the errors are measured against.
  std::optional<double> threshold = {};  ///< What cannot be felt, in `unit` [PHYSICS 6].
  std::string threshold_words;
  std::string felt_words;      ///< In place of the sentence about the point beyond what is felt.
  std::string per = "tick";    ///< What the cost is counted for.
  bool given = false;          ///< No choice of a program: the arm brings the knob's value.
  bool cost_is_added = false;  ///< The cost is what a point adds to something, and may be negative.
  std::string default_words;   ///< Why the default is where it is, if it is not on the front.
  std::string left_out;        ///< One or two sentences: what this axis does not show, and why.
  bool over_cost = true;       ///< Draws the error over the cost.
  bool over_knob = true;       ///< Draws the error over the knob.
  bool cost_over_knob = false;  ///< Draws the cost over the knob, where all are exact.
  std::vector<AccuracyLine> lines;
};

/// Makes one axis; nothing is measured yet.
struct AxisMaker {
  std::string_view name;
  AccuracyAxis (*make)();
};

/// Returns every axis, in the order of the page. To add one: write its file, add its line there.
std::span<const AxisMaker> accuracy_axes();

}  // namespace thimble::studies
