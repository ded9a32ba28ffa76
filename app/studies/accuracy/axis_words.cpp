#include "studies/accuracy/axis_words.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace thimble::studies {
namespace {

std::string with_unit(double value, const std::string& unit) {
  std::string text = three_digits(value);
  if (!unit.empty()) text.append(" ").append(unit);
  return text;
}

std::string cost_words(const MeasuredAxis& axis, const MeasuredPoint& point) {
  std::string text = three_digits(point.ns) + " ns";
  if (point.instructions)
    text.append(" or ").append(three_digits(*point.instructions)).append(" instructions");
  return text.append(" per ").append(axis.axis.per);
}

double largest_error(const MeasuredLine& line) {
  double largest = 0;
  for (const MeasuredPoint& point : line.points) {
    largest = point.diverged ? INFINITY : std::max(largest, std::abs(point.error));
  }
  return largest;
}

// Without a cost there is no cheapest point; returns the coarsest knob below the threshold.
std::string coarsest_sentence(const MeasuredAxis& axis) {
  std::string text;
  for (const MeasuredLine& line : axis.lines) {
    const MeasuredPoint* coarsest = nullptr;
    for (const MeasuredPoint& point : line.points) {
      // NaN counts as above the threshold.
      if (point.diverged || !(point.error <= *axis.axis.threshold)) continue;
      if (coarsest == nullptr || point.point->knob > coarsest->point->knob) coarsest = &point;
    }
    if (coarsest == nullptr) continue;
    text.append(text.empty() ? "" : "; ").append(name_of(axis, *coarsest));
  }
  const std::string threshold = with_unit(*axis.axis.threshold, axis.axis.unit);
  if (text.empty()) return "Every point can be felt (threshold: " + threshold + ").";
  return "More accuracy cannot be felt. Coarsest points below " + threshold + ": " + text + ".";
}

}  // namespace

std::string three_digits(double value) {
  if (value == 0) return "0";
  if (std::abs(value) >= 100 && std::abs(value) < 1e7) {
    const double power = std::pow(10.0, std::floor(std::log10(std::abs(value))) - 2);
    return fmt::format("{:.0f}", std::round(value / power) * power);
  }
  return fmt::format("{:.3g}", value);
}

std::string name_of(const MeasuredAxis& axis, const MeasuredPoint& point) {
  const MeasuredLine* line = axis.line_of(&point);
  if (line->line->apart) return point.point->title.empty() ? point.point->name : point.point->title;
  std::string text = line->line->title;
  text.append(" at ").append(with_unit(point.point->knob, axis.axis.knob_unit));
  return text;
}

std::string felt_sentence(const MeasuredAxis& axis) {
  if (!axis.axis.felt_words.empty()) return axis.axis.felt_words;
  if (!axis.axis.threshold) return {};
  const std::string threshold = with_unit(*axis.axis.threshold, axis.axis.unit);
  if (!axis.axis.over_cost) return coarsest_sentence(axis);
  const MeasuredPoint* enough = axis.enough();
  if (enough == nullptr) {
    return "Every point can be felt (threshold: " + threshold + ").";
  }
  std::string text = "More accuracy cannot be felt beyond ";
  text.append(name_of(axis, *enough)).append(": ");
  text.append(with_unit(enough->error, axis.axis.unit)).append(" for ");
  text.append(cost_words(axis, *enough))
      .append(", the cheapest point below ")
      .append(threshold)
      .append(".");
  return text;
}

std::string default_sentence(const MeasuredAxis& axis) {
  const MeasuredPoint* point = axis.default_point();
  if (point == nullptr) return "The product has no default here. " + axis.axis.default_words;
  if (axis.axis.given) {
    return "The arm determines this value: " + axis.axis.default_words +
           " A PHANTOM-like arm is at " + name_of(axis, *point) + ": " +
           with_unit(point->error, axis.axis.unit) + ".";
  }
  std::string text = "The default is ";
  text.append(name_of(axis, *point)).append(": ");
  text.append(point->diverged ? std::string("diverged") : with_unit(point->error, axis.axis.unit));
  text.append(" for ").append(cost_words(axis, *point)).append(". ");
  if (point->on_front) {
    text.append("No other point is both cheaper and more accurate.");
  } else {
    text.append(
        "Another point is cheaper or more accurate without a disadvantage. Reason for "
        "the default: ");
    text.append(axis.axis.default_words);
  }
  return text;
}

std::string order_sentence(const MeasuredAxis& axis) {
  std::string text;
  for (const MeasuredLine& line : axis.lines) {
    if (line.line->exact) {
      text.append(text.empty() ? "" : "; ").append(line.line->title).append(" at most ");
      text.append(with_unit(largest_error(line), axis.axis.unit)).append(" off (rounding)");
    }
    if (!line.line->order || !line.slope) continue;
    const std::string numbers =
        fmt::format(" {:.2f} (theory {:g})", *line.slope, *line.line->order);
    text.append(text.empty() ? "" : "; ").append(line.line->title).append(numbers);
  }
  return text.empty() ? text : "Slopes of error over the parameter: " + text + ".";
}

std::vector<session::Figure> figures_of(const MeasuredAxis& axis) {
  std::vector<session::Figure> figures;
  const std::string& name = axis.axis.name;
  for (const MeasuredLine& line : axis.lines) {
    const std::string line_name = name + ", " + line.line->title;
    if (line.line->exact) {
      figures.push_back({.name = line_name + ": largest error",
                         .value = largest_error(line),
                         .unit = axis.axis.unit,
                         .goal = "< 1e-6"});
    }
    if (line.line->order && line.slope) {
      figures.push_back({.name = line_name + ": order off by",
                         .value = std::abs(*line.slope - *line.line->order),
                         .unit = "",
                         .goal = "<= 0.2"});
    }
  }
  const auto add = [&](const std::string& what, const MeasuredPoint& point) {
    figures.push_back({.name = name + ", " + what + ": error",
                       .value = point.error,
                       .unit = axis.axis.unit,
                       .goal = {}});
    figures.push_back({.name = name + ", " + what + ": time",
                       .value = point.ns,
                       .unit = "ns/" + axis.axis.per,
                       .goal = {}});
    if (!point.instructions) return;
    figures.push_back({.name = name + ", " + what + ": instructions",
                       .value = *point.instructions,
                       .unit = "per " + axis.axis.per,
                       .goal = {}});
  };
  if (const auto* point = axis.default_point()) {
    add(axis.axis.given ? "of a PHANTOM-like arm" : "default", *point);
    if (!axis.axis.given) {
      figures.push_back({.name = name + ", default on the front",
                         .value = point->on_front ? 1.0 : 0.0,
                         .unit = "",
                         .goal = {}});
    }
  }
  if (const auto* point = axis.axis.over_cost ? axis.enough() : nullptr) add("enough", *point);
  if (axis.axis.cost_is_added) {
    for (const MeasuredLine& line : axis.lines) {
      for (const MeasuredPoint& point : line.points) {
        add(name_of(axis, point) + ", saved without", point);
      }
    }
  }
  return figures;
}

std::string csv_of(const MeasuredAxis& axis) {
  std::ostringstream csv;
  csv.precision(9);
  csv << "line,point,knob,error,law,ns,ns_spread,instructions,on_front,default,diverged\n";
  for (const MeasuredLine& line : axis.lines) {
    for (const MeasuredPoint& point : line.points) {
      csv << line.line->name << ',' << point.point->name << ',';
      if (std::isfinite(point.point->knob)) csv << point.point->knob;
      csv << ',';
      if (!point.diverged) csv << point.error;
      csv << ',';
      if (point.point->law) csv << *point.point->law;
      csv << ',' << point.ns << ',' << point.ns_spread << ',';
      if (point.instructions) csv << *point.instructions;
      csv << ',' << point.on_front << ',' << point.point->is_default << ',' << point.diverged
          << '\n';
    }
  }
  return csv.str();
}

}  // namespace thimble::studies
