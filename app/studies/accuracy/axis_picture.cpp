#include "studies/accuracy/axis_picture.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <sstream>

#include "report/gnuplot.h"
#include "report/picture_style.h"
#include "studies/accuracy/axis_words.h"

namespace thimble::studies {
namespace {

// Colours that colour-blind people can distinguish [M Okabe and Ito].
constexpr std::array kColours{"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#8a6d00", "#30343b"};
constexpr std::array kMarks{7, 5, 9, 13, 11, 3};
constexpr std::array kHollowMarks{6, 4, 8, 12, 10, 2};  // the same shapes, hollow, for the next six
constexpr const char* kUnfeltFill = "#f0f4ee";          // background below the threshold
constexpr std::size_t kTitleWidth = 50, kKnobWidth = 60, kErrorWidth = 26;  // in letters

enum class View { kErrorOverCost, kErrorOverKnob, kCostOverKnob };

// Returns the words that distinguish the diagrams of one axis.
const char* words_for(View view) {
  switch (view) {
    case View::kErrorOverCost:
      return "error over cost";
    case View::kErrorOverKnob:
      return "error over the parameter";
    case View::kCostOverKnob:
      break;
  }
  return "cost over the parameter";
}

// Returns a unit as written on pictures.
std::string shown_unit(const std::string& unit) {
  return unit == "um" || unit == "us" ? "µ" + unit.substr(1) : unit;
}

// Splits a text into words; a number and its unit stay together.
std::vector<std::string> words_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) {
    const bool joins = !words.empty() && (std::isdigit(words.back().back()) || words.back() == "x");
    if (joins) {
      words.back() += " " + shown_unit(word);
    } else {
      words.push_back(word);
    }
  }
  return words;
}

std::vector<std::string> filled(const std::vector<std::string>& words, std::size_t width) {
  std::vector<std::string> lines;
  for (const std::string& word : words) {
    if (!lines.empty() && lines.back().size() + 1 + word.size() <= width) {
      lines.back() += " " + word;
    } else {
      lines.push_back(word);
    }
  }
  return lines;
}

// Breaks a text at spaces into the smallest number of lines of up to `width` letters, of similar
// lengths.
std::vector<std::string> broken(const std::string& text, std::size_t width) {
  const std::vector<std::string> words = words_of(text);
  std::vector<std::string> fewest = filled(words, width);
  for (std::size_t narrow = text.size() / fewest.size(); narrow < width; ++narrow) {
    std::vector<std::string> lines = filled(words, narrow);
    if (lines.size() == fewest.size()) return lines;
  }
  return fewest;
}

// Quotes a text with gnuplot's line breaks.
std::string wrapped(const std::string& text, std::size_t width) {
  std::string quoted;
  for (const std::string& line : broken(text, width)) {
    quoted.append(quoted.empty() ? "\"" : "\\n").append(line);
  }
  return quoted + "\"";
}

std::string labelled(const std::string& name, const std::string& unit, std::size_t width) {
  if (unit.empty()) return wrapped(name, width);
  return wrapped(name + (unit[0] == '%' ? " in " : ", ") + shown_unit(unit), width);
}

// Returns tics at 1, 2 and 5 of each decade if gnuplot would label only one; 1 and 3 if the numbers
// are long.
std::string tics_of(char axis, double low, double high) {
  if (high / low > 3000) return {};
  const bool high_numbers = high > 1e4;
  std::string text = "set ";
  text.append(1, axis).append("tics (");
  bool first = true;
  const int last_decade = static_cast<int>(std::floor(std::log10(high)));
  for (int decade = static_cast<int>(std::floor(std::log10(low))); decade <= last_decade;
       ++decade) {
    const double power = std::pow(10, decade);
    for (const double factor : {1.0, 2.0, 3.0, 5.0}) {
      if (factor > 1 && (high / low > 300 || (factor == 3) != high_numbers)) continue;
      if (factor * power < low || factor * power > high) continue;
      text.append(first ? "" : ", ").append(report::number(factor * power));
      first = false;
    }
  }
  return first ? std::string() : text + ")\n";
}

// Errors below this fraction of the threshold are rounding, and are drawn at it so that they do not
// compress the axis. Without a threshold they are drawn below all others.
constexpr double kFloorShare = 1e-4;
constexpr double kRounding = 1e-9;

/// Coordinates of points in one view.
class Eye {
 public:
  Eye(const MeasuredAxis& axis, View view)
      : view_(view), added_(view == View::kErrorOverCost && axis.axis.cost_is_added) {
    double largest = 0;
    double smallest = INFINITY;
    for (const MeasuredLine& line : axis.lines) {
      for (const MeasuredPoint& point : line.points) {
        if (point.diverged || point.error == 0) continue;
        largest = std::max(largest, std::abs(point.error));
        smallest = std::min(smallest, std::abs(point.error));
      }
    }
    if (axis.axis.threshold) {
      floor_ = kFloorShare * *axis.axis.threshold;
    } else {
      floor_ = largest > 0 ? std::max(smallest / 2, kRounding * largest) : 1;
    }
  }
  double floor() const { return floor_; }
  double x(const MeasuredPoint& point) const {
    return view_ == View::kErrorOverCost ? point.ns : point.point->knob;
  }
  double y(const MeasuredPoint& point) const {
    return view_ == View::kCostOverKnob ? point.ns : shown(point.error);
  }
  double shown(double error) const { return std::max(std::abs(error), floor_); }
  bool sees(const MeasuredPoint& point) const {
    if (!std::isfinite(x(point))) return false;
    const bool any = added_ || point.point->knob == 0;  // zero needs a linear axis
    if (!(x(point) > 0) && !any) return false;
    return view_ == View::kCostOverKnob || !point.diverged;
  }

 private:
  View view_;
  bool added_;
  double floor_ = 0;
};

bool spans_decades(double low, double high) {
  return low > 0 && high / low > 5;
}

// Draws points that are separate methods, each with its mark, colour and name.
void draw_apart(const MeasuredLine& line, const Eye& eye, std::size_t index,
                std::ostringstream& text, std::ostringstream& plots) {
  std::size_t k = 0;
  for (const MeasuredPoint& point : line.points) {
    if (!eye.sees(point)) continue;
    const std::string data = "$apart" + std::to_string(index) + "_" + std::to_string(k);
    text << data << " << EOD\n"
         << report::number(eye.x(point)) << ' ' << report::number(eye.y(point)) << "\nEOD\n";
    plots << ", " << data << " using 1:2 with points lw 2 ps 1.4 pt "
          << (k < kMarks.size() ? kMarks[k] : kHollowMarks[k % kHollowMarks.size()]) << " lc rgb '"
          << kColours[(k + 1) % kColours.size()] << "' title "
          << report::quote(point.point->title.empty() ? point.point->name : point.point->title);
    ++k;
  }
}

report::Plot plot_of(const MeasuredAxis& axis, View view) {
  const Eye eye(axis, view);
  const AccuracyAxis& a = axis.axis;
  std::ostringstream text;
  std::ostringstream plots;
  text << report::quiet_style()
       << "set key below left Left reverse samplen 2 spacing 1.15 width 1 height 1.5 "
          "font ',13'"
       << (axis.lines.back().line->apart ? " maxrows 8" : "") << "\n";
  double low_x = INFINITY, high_x = 0, low_y = INFINITY, high_y = 0;
  bool floored = false;
  bool law_named = false;
  std::ostringstream law_plots;
  const MeasuredPoint* marked = axis.default_point();
  for (std::size_t i = 0; i < axis.lines.size(); ++i) {
    const MeasuredLine& line = axis.lines[i];
    text << "$line" << i << " << EOD\n";
    int points = 0;
    bool laws = false;
    for (const MeasuredPoint& point : line.points) {
      if (!eye.sees(point)) continue;
      const double x = eye.x(point);
      const double y = eye.y(point);
      floored = floored || (view != View::kCostOverKnob && std::abs(point.error) < eye.floor());
      low_x = std::min(low_x, x);
      high_x = std::max(high_x, x);
      low_y = std::min(low_y, y);
      high_y = std::max(high_y, y);
      const bool law = point.point->law && view == View::kErrorOverKnob;
      laws = laws || law;
      text << report::number(x) << ' ' << report::number(y) << ' '
           << (law ? report::number(eye.shown(*point.point->law)) : std::string("NaN")) << " \""
           << (line.line->apart ? point.point->name : three_digits(point.point->knob)) << "\"\n";
      ++points;
    }
    text << "EOD\n";
    if (points == 0) continue;
    const std::string colour = kColours[i % kColours.size()];
    const std::string data = "$line" + std::to_string(i);
    const std::string title = report::quote(line.line->title);
    const bool again = i >= kMarks.size();
    const std::string mark =
        std::to_string(again ? kHollowMarks[i % kHollowMarks.size()] : kMarks[i % kMarks.size()]) +
        (again ? " dt (10,4)" : "");
    if (line.line->apart) {
      draw_apart(line, eye, i, text, plots);
      continue;
    }
    plots << ", " << data << " using 1:2 with linespoints lw 2.4 ps 1 lc rgb '" << colour << "' pt "
          << mark << " title " << title;
    if (laws) {
      law_plots << ", " << data << " using 1:3 with lines lw 4 dt '.' lc rgb '" << report::kInk
                << (law_named ? "' notitle" : "' title 'published law'");
      law_named = true;
    }
  }
  plots << law_plots.str();
  if (marked != nullptr && eye.sees(*marked)) {
    plots << ", '-' using 1:2 with points pt 6 ps 2.1 lw 2.2 lc rgb '" << report::kInk
          << (a.given ? "' title 'a PHANTOM-like arm'" : "' title 'default of the product'");
  }
  std::string title = wrapped(a.title, kTitleWidth);
  title.insert(title.size() - 1, std::string("\\n{/*0.8 ") + words_for(view) + "}");
  text << "set title " << title << " font ',17'\n";
  const bool over_cost = view == View::kErrorOverCost;
  const std::string cost = "ns" + std::string(a.cost_is_added ? " more" : "") + " per " + a.per;
  text << "set xlabel "
       << (over_cost ? report::quote(cost + ", median") : labelled(a.knob, a.knob_unit, kKnobWidth))
       << "\nset ylabel "
       << (view == View::kCostOverKnob ? report::quote(cost + ", median")
                                       : labelled(a.metric, a.unit, kErrorWidth))
       << '\n';
  const std::size_t label_lines =
      broken(a.metric + ", " + a.unit, kErrorWidth).size();  // their space next to the numbers
  text << "set lmargin " << 9 + 2 * label_lines << "\nset rmargin 5\nset ylabel offset -1\n";
  if (over_cost && a.cost_is_added) {
    const double more = 0.08 * (high_x - std::min(low_x, 0.0));
    text << "set xrange [" << report::number(std::min(low_x, 0.0) - more / 4) << ':'
         << report::number(high_x + more) << "]\n";
  } else if (spans_decades(low_x, high_x)) {
    text << "set logscale x\nset xrange [" << report::number(low_x / 1.35) << ':'
         << report::number(high_x * 1.35) << "]\n"
         << tics_of('x', low_x / 1.35, high_x * 1.35);
  } else if (high_x > low_x) {
    const double more = 0.06 * (high_x - low_x);
    text << "set xrange [" << report::number(low_x - more) << ':' << report::number(high_x + more)
         << "]\n";
  }
  if (a.threshold && view != View::kCostOverKnob) {
    low_y = std::min(low_y, *a.threshold);
    high_y = std::max(high_y, *a.threshold);
  }
  if (low_y < high_y) {
    const double low = low_y / (floored ? 5 : 1.6);
    text << "set logscale y\nset format y '%g'\nset yrange [" << report::number(low) << ':'
         << report::number(high_y * 1.6) << "]\n"
         << tics_of('y', low, high_y * 1.6);
  }
  if (a.threshold && view != View::kCostOverKnob) {
    text << "set object 1 rectangle from graph 0, graph 0 to graph 1, first "
         << report::number(*a.threshold) << " behind fillcolor rgb '" << kUnfeltFill
         << "' fillstyle solid noborder\n";
    plots << ", " << report::number(*a.threshold) << " with lines dt '-' lw 1.5 lc rgb '"
          << report::kFaintInk << "' title "
          << report::quote("not noticeable below: " + a.threshold_words);
  }
  if (floored) {
    text << "set label 2 'errors of zero and of rounding are drawn at the lower edge' at "
            "graph 0.99, graph 0.03 right font ',12' tc rgb '"
         << report::kFaintInk << "'\n";
  }
  text << "plot " << plots.str().substr(2) << '\n';
  if (marked != nullptr && eye.sees(*marked)) {
    text << report::number(eye.x(*marked)) << ' ' << report::number(eye.y(*marked)) << "\ne\n";
  }
  std::string name = a.name;
  if (view == View::kErrorOverKnob && a.over_cost) name += "_knob";
  if (view == View::kCostOverKnob) name += "_cost";
  std::size_t entries = 2 + (law_named ? 1 : 0);
  for (const MeasuredLine& line : axis.lines) {
    entries += line.line->apart ? line.points.size() : 1;
  }
  // A longer legend makes the picture taller, so that the diagram keeps its size.
  return {.name = name,
          .width = 840,
          .height = static_cast<int>(584 + 24 * entries),
          .commands = text.str()};
}

}  // namespace

driver::Result<std::vector<std::string>> draw_axis(const MeasuredAxis& axis,
                                                   const std::filesystem::path& folder) {
  std::vector<report::Plot> plots;
  if (axis.axis.over_cost) plots.push_back(plot_of(axis, View::kErrorOverCost));
  if (axis.axis.over_knob) plots.push_back(plot_of(axis, View::kErrorOverKnob));
  if (axis.axis.cost_over_knob) plots.push_back(plot_of(axis, View::kCostOverKnob));
  std::vector<std::string> names;
  for (const report::Plot& plot : plots) {
    if (auto drawn = report::draw_plot(plot, folder); !drawn) return drawn.error();
    names.push_back(plot.name);
  }
  return names;
}

}  // namespace thimble::studies
