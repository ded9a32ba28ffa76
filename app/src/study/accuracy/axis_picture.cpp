#include "study/accuracy/axis_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "gnuplot.h"
#include "picture_parts.h"
#include "study/accuracy/axis_words.h"

namespace thimble::app {
namespace {

// Colours that stay apart for colour-blind eyes [M Okabe and Ito].
constexpr std::array kColours{"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#8a6d00", "#30343b"};
constexpr std::array kMarks{7, 5, 9, 13, 11, 3};
constexpr std::size_t kTitleWidth = 52, kKnobWidth = 60, kErrorWidth = 36;  // letters

enum class View { kErrorOverCost, kErrorOverKnob, kCostOverKnob };

// Breaks a text at spaces, and quotes it with gnuplot's own line breaks.
std::string wrapped(const std::string& text, std::size_t width) {
  std::istringstream words(text);
  std::string quoted = "\"";
  std::size_t column = 0;
  for (std::string word; words >> word;) {
    if (column > 0 && column + word.size() > width) {
      quoted += "\\n";
      column = 0;
    } else if (column > 0) {
      quoted += ' ';
    }
    quoted += word;
    column += word.size() + 1;
  }
  return quoted + "\"";
}

std::string labelled(const std::string& name, const std::string& unit, std::size_t width) {
  if (unit.empty()) return wrapped(name, width);
  return wrapped(name + (unit[0] == '%' ? " in " : ", ") + unit, width);
}

// Names 1, 2 and 5 of each decade where gnuplot would name one number only.
std::string tics_of(char axis, double low, double high) {
  if (high / low > 200) return {};
  std::string text = "set ";
  text.append(1, axis).append("tics (");
  bool first = true;
  for (double power = std::pow(10, std::floor(std::log10(low))); power <= high; power *= 10) {
    for (const double factor : {1.0, 2.0, 5.0}) {
      if (factor * power < low || factor * power > high) continue;
      text.append(first ? "" : ", ").append(number(factor * power));
      first = false;
    }
  }
  return first ? std::string() : text + ")\n";
}

// Errors below this share of the threshold are drawn there: rounding, which would squeeze all else.
constexpr double kFloorShare = 1e-4;

/// Is how one view sees a point.
class Eye {
 public:
  Eye(const MeasuredAxis& axis, View view) : view_(view) {
    double largest = 0;
    for (const MeasuredLine& line : axis.lines) {
      for (const MeasuredPoint& point : line.points) {
        if (!point.diverged) largest = std::max(largest, std::abs(point.error));
      }
    }
    floor_ = kFloorShare * axis.axis.threshold.value_or(largest > 0 ? largest : 1);
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
    if (!std::isfinite(x(point)) || !(x(point) > 0 || point.point->knob == 0)) return false;
    return view_ == View::kCostOverKnob || !point.diverged;
  }

 private:
  View view_;
  double floor_ = 0;
};

bool spans_decades(double low, double high) {
  return low > 0 && high / low > 5;
}

// Draws points that are methods of their own: each with its mark, colour and name.
void draw_apart(const MeasuredLine& line, const Eye& eye, std::size_t index,
                std::ostringstream& text, std::ostringstream& plots) {
  std::size_t k = 0;
  for (const MeasuredPoint& point : line.points) {
    if (!eye.sees(point)) continue;
    const std::string data = "$apart" + std::to_string(index) + "_" + std::to_string(k);
    text << data << " << EOD\n" << number(eye.x(point)) << ' ' << number(eye.y(point)) << "\nEOD\n";
    std::string name = point.point->name;
    std::replace(name.begin(), name.end(), '_', ' ');
    plots << ", " << data << " using 1:2 with points lw 2 ps 1.2 pt "
          << kMarks[k % kMarks.size()] + (k >= kMarks.size() ? -1 : 0) << " lc rgb '"
          << kColours[(k + 1) % kColours.size()] << "' title " << quote(name);
    ++k;
  }
}

Plot plot_of(const MeasuredAxis& axis, View view) {
  const Eye eye(axis, view);
  const AccuracyAxis& a = axis.axis;
  std::ostringstream text;
  std::ostringstream plots;
  text << quiet_style()
       << "set key below Left reverse samplen 2 spacing 1.15 width 1 height 1.5 font ',13'"
       << (axis.lines.back().line->apart ? " maxrows 8" : "") << "\n";
  double low_x = INFINITY, high_x = 0, low_y = INFINITY, high_y = 0;
  bool floored = false;
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
      text << number(x) << ' ' << number(y) << ' '
           << (law ? number(eye.shown(*point.point->law)) : std::string("NaN")) << " \""
           << (line.line->apart ? point.point->name : three_digits(point.point->knob)) << "\"\n";
      ++points;
    }
    text << "EOD\n";
    if (points == 0) continue;
    const std::string colour = kColours[i % kColours.size()];
    const std::string data = "$line" + std::to_string(i);
    const std::string title = quote(line.line->title);
    const std::string mark = std::to_string(kMarks[i % kMarks.size()]);
    if (line.line->apart) {
      draw_apart(line, eye, i, text, plots);
      continue;
    }
    plots << ", " << data << " using 1:2 with linespoints lw 2.4 pt " << mark << " ps 1 lc rgb '"
          << colour << "' title " << title;
    if (laws) {
      plots << ", " << data << " using 1:3 with lines lw 1 dt '.' lc rgb '" << colour
            << "' notitle";
    }
  }
  if (marked != nullptr && eye.sees(*marked)) {
    plots << ", '-' using 1:2 with points pt 6 ps 2.4 lw 2.2 lc rgb '" << kInk
          << "' title 'default of the product'";
  }
  text << "set title " << wrapped(a.title, kTitleWidth) << " font ',17'\n";
  const bool over_cost = view == View::kErrorOverCost;
  text << "set xlabel "
       << (over_cost ? quote("ns per " + a.per + ", median")
                     : labelled(a.knob, a.knob_unit, kKnobWidth))
       << "\nset ylabel "
       << (view == View::kCostOverKnob ? quote("ns per " + a.per + ", median")
                                       : labelled(a.metric, a.unit, kErrorWidth))
       << '\n';
  if (spans_decades(low_x, high_x)) {
    text << "set logscale x\nset xrange [" << number(low_x / 1.35) << ':' << number(high_x * 1.35)
         << "]\n"
         << tics_of('x', low_x / 1.35, high_x * 1.35);
  } else if (high_x > low_x) {
    const double more = 0.06 * (high_x - low_x);
    text << "set xrange [" << number(low_x - more) << ':' << number(high_x + more) << "]\n";
  }
  if (a.threshold && view != View::kCostOverKnob) {
    low_y = std::min(low_y, *a.threshold);
    high_y = std::max(high_y, *a.threshold);
  }
  if (low_y < high_y) {
    const double low = low_y / (floored ? 5 : 1.6);
    text << "set logscale y\nset format y '%g'\nset yrange [" << number(low) << ':'
         << number(high_y * 1.6) << "]\n"
         << tics_of('y', low, high_y * 1.6);
  }
  if (a.threshold && view != View::kCostOverKnob) {
    plots << ", " << number(*a.threshold) << " with lines dt '-' lw 1.5 lc rgb '" << kFaintInk
          << "' title " << quote("not felt below: " + a.threshold_words);
  }
  if (floored) {
    text
        << "set label 2 'rounding is drawn at the lower edge' at graph 0.99, graph 0.03 right font "
           "',12' tc rgb '"
        << kFaintInk << "'\n";
  }
  text << "plot " << plots.str().substr(2) << '\n';
  if (marked != nullptr && eye.sees(*marked)) {
    text << number(eye.x(*marked)) << ' ' << number(eye.y(*marked)) << "\ne\n";
  }
  std::string name = a.name;
  if (view == View::kErrorOverKnob && a.over_cost) name += "_knob";
  if (view == View::kCostOverKnob) name += "_cost";
  return {.name = name,
          .width = 800,
          .height = axis.lines.back().line->apart ? 900 : 720,
          .commands = text.str()};
}

}  // namespace

driver::Result<std::vector<std::string>> draw_axis(const MeasuredAxis& axis,
                                                   const std::filesystem::path& folder) {
  std::vector<Plot> plots;
  if (axis.axis.over_cost) plots.push_back(plot_of(axis, View::kErrorOverCost));
  if (axis.axis.over_knob) plots.push_back(plot_of(axis, View::kErrorOverKnob));
  if (axis.axis.cost_over_knob) plots.push_back(plot_of(axis, View::kCostOverKnob));
  std::vector<std::string> names;
  for (const Plot& plot : plots) {
    if (auto drawn = draw_plot(plot, folder); !drawn) return drawn.error();
    names.push_back(plot.name);
  }
  return names;
}

}  // namespace thimble::app
