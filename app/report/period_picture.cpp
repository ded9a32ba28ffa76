#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include "report/figure_output.h"
#include "report/gnuplot.h"
#include "report/picture_style.h"

namespace thimble::report {
namespace {

constexpr int kBars = 160;

struct Range {
  double low = 0, high = 1;  // us
  bool logarithmic = false;
};

// A linear range must contain all values. Durations over more than one power of ten need a
// logarithmic axis.
Range range_of(const session::Histogram& histogram, double at_least_from, double at_least_to) {
  const double low = std::min(1e-3 * static_cast<double>(histogram.min_ns()), at_least_from);
  const double high = std::max(1e-3 * static_cast<double>(histogram.max_ns()), at_least_to);
  if (high > 10 * std::max(low, 1e-3)) return {std::max(low / 1.2, 1e-3), high * 1.2, true};
  const double margin = 0.04 * (high - low);
  return {low - margin, high + margin, false};
}

std::string bars(const session::Histogram& histogram, const Range& range) {
  std::vector<double> counts(kBars);
  const auto scaled = [&](double us) {
    return range.logarithmic ? std::log(std::max(us, 1e-9)) : us;
  };
  const double low = scaled(range.low);
  const double step = (scaled(range.high) - low) / kBars;
  for (const session::Histogram::Bin& bin : histogram.bins()) {
    const double middle = 0.5e-3 * static_cast<double>(bin.lower_ns + bin.upper_ns - 1);
    const int bar = std::clamp(static_cast<int>((scaled(middle) - low) / step), 0, kBars - 1);
    counts[static_cast<std::size_t>(bar)] += static_cast<double>(bin.count);
  }
  std::ostringstream text;
  text.precision(9);
  text << "# from us, to us, ticks\n";
  const auto unscaled = [&](double x) { return range.logarithmic ? std::exp(x) : x; };
  for (int i = 0; i < kBars; ++i) {
    if (counts[static_cast<std::size_t>(i)] == 0) continue;
    text << unscaled(low + i * step) << ' ' << unscaled(low + (i + 1) * step) << ' '
         << counts[static_cast<std::size_t>(i)] << '\n';
  }
  return text.str();
}

std::string in_us(double ns) {
  std::ostringstream text;
  const double us = 1e-3 * ns;
  text.precision(us < 100 ? 3 : us < 1000 ? 4 : 6);
  text << us;
  return text.str();
}

std::string percentiles(const session::Histogram& histogram) {
  return "median ≤ " + in_us(histogram.percentile(0.5)) + "    99 % ≤ " +
         in_us(histogram.percentile(0.99)) + "    99.9 % ≤ " + in_us(histogram.percentile(0.999)) +
         "    longest " + in_us(static_cast<double>(histogram.max_ns())) + "  µs";
}

// Returns tics at 1, 2 and 5 of each power of ten; over many powers only at 1.
std::string logarithmic_tics(const Range& range) {
  const bool many = range.high > 1e4 * range.low;
  std::string tics;
  const int first = static_cast<int>(std::floor(std::log10(range.low)));
  const int last = static_cast<int>(std::ceil(std::log10(range.high)));
  for (int power = first; power <= last; ++power) {
    const double ten = std::pow(10, power);
    for (const double tic : {ten, 2 * ten, 5 * ten}) {
      if (tic < range.low || tic > range.high || (many && tic != ten)) continue;
      tics += (tics.empty() ? "" : ", ") + number(tic);
    }
  }
  return "set xtics (" + tics + ")\nset mxtics 1\n";
}

// Returns commands for one panel from `bottom` to `top` of the picture; 0.001 means 99.9 % and so
// on.
std::string panel(const session::Histogram& histogram, const Range& range, const std::string& file,
                  const std::string& heading, double bottom, double top, const char* ink) {
  std::ostringstream c;
  const double count_top = 3 * static_cast<double>(std::max<std::uint64_t>(histogram.count(), 1));
  c << "set bmargin at screen " << number(bottom) << "\nset tmargin at screen " << number(top)
    << "\nunset label\nset label 1 " << quote(heading) << " at screen 0.085, screen "
    << number(top + 0.03) << " noenhanced textcolor rgb '" << kInk << "'\nset label 2 "
    << quote(percentiles(histogram)) << " at screen 0.975, screen " << number(top + 0.03)
    << " right noenhanced textcolor rgb '" << kInk << "'\n"
    << (range.logarithmic ? "set logscale x 10\n" : "unset logscale x\n") << "set logscale y 10\n"
    << "set xrange [" << number(range.low) << ":" << number(range.high)
    << "]\nset yrange [0.7:" << number(count_top) << "]\nset format y '10^{%T}'\n"
    << (range.logarithmic ? logarithmic_tics(range)
                          : "set xtics " + number(tic_step(range.high - range.low, 10)) + "\n")
    << "plot '" << file
    << "' using (0.5*($1+$2)):3:1:2:(0.7):3 with boxxyerror fs solid 1 noborder "
    << "lc rgb '" << ink << "' notitle\n";
  return c.str();
}

}  // namespace

driver::Result<void> draw_period_histogram(const PictureInfo& info,
                                           const std::filesystem::path& folder) {
  const double nominal = 1e6 * info.period;
  const Range range = range_of(*info.period_times, 0.95 * nominal, 1.05 * nominal);
  // In virtual time, computing times may not have been measured; then nothing is shown.
  const bool with_work = info.work_times->max_ns() > 0;
  if (auto done = write_text(bars(*info.period_times, range), folder / "data/period.dat"); !done) {
    return done;
  }
  std::ostringstream c;
  c << quiet_style() << "set multiplot\nunset key\nset lmargin at screen 0.085\n"
    << "set rmargin at screen 0.975\nset ylabel 'ticks' textcolor rgb '" << kInk << "'\n";
  // The first panel draws the heading; clearing its labels does not affect later ones.
  const std::string heading_label =
      "set label 9 " + quote("Pace of the loop: " + info.title) +
      " at screen 0.085, screen 0.955 font ',22' noenhanced textcolor rgb '" + kInk + "'\n";
  std::string first = panel(*info.period_times, range, "data/period.dat", "Time between ticks",
                            with_work ? 0.565 : 0.12, 0.86, kForceInk);
  first.insert(first.find("plot "),
               heading_label + "set arrow 1 from " + number(nominal) + ", graph 0 to " +
                   number(nominal) + ", graph 1 nohead back lw 1.5 dt 2 lc rgb '" + kInk +
                   "'\nset label 3 'requested' at " + number(nominal) +
                   ", graph 0.93 offset 0.8,0 textcolor rgb '" + kInk + "'\n" +
                   (with_work ? "unset xlabel\n" : "set xlabel 'time [µs]'\n"));
  c << first << "unset arrow 1\n";
  if (with_work) {
    const Range work_range =
        range_of(*info.work_times, 1e-3 * static_cast<double>(info.work_times->min_ns()),
                 1e-3 * static_cast<double>(info.work_times->max_ns()) + 0.1);
    if (auto done = write_text(bars(*info.work_times, work_range), folder / "data/tick_time.dat");
        !done) {
      return done;
    }
    c << "set xlabel 'time [µs]' textcolor rgb '" << kInk << "'\n"
      << panel(*info.work_times, work_range, "data/tick_time.dat",
               "Work in a tick (from read to write, on the wall clock)", 0.12, 0.42, kDepthInk);
  }
  c << "unset multiplot\n";
  return draw_plot({"period_histogram", 1600, 900, c.str()}, folder);
}

}  // namespace thimble::report
