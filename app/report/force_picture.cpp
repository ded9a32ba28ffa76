#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "report/extremes.h"
#include "report/figure_output.h"
#include "report/gnuplot.h"
#include "report/picture_style.h"

namespace thimble::report {
namespace {

constexpr std::size_t kBucketsMax = 1500;  // about one per pixel of a panel's width
constexpr double kVisible = 0.02;          // of the maximum force: the width of a line in the panel

// Returns the values of a row that are plotted over time.
std::array<double, 3> plotted(const driver::TickRecord& row) {
  return {length_of(row.f_wanted_W), length_of(row.f_sent_W), row.depth};
}

// Returns time, requested force, sent force and depth as text. Long runs are divided into buckets
// that keep the rows with the minimum and maximum of each value, so that no peak is lost.
std::string table(std::span<const driver::TickRecord> rows) {
  std::ostringstream text;
  text.precision(7);
  text << "# time s, force wanted N, force sent N, depth mm\n";
  const auto put = [&](std::size_t i) {
    text << time_of(rows[i], rows.front()) << ' ' << length_of(rows[i].f_wanted_W) << ' '
         << length_of(rows[i].f_sent_W) << ' ' << 1e3 * rows[i].depth << '\n';
  };
  const std::size_t bucket = (rows.size() + kBucketsMax - 1) / kBucketsMax;
  for (std::size_t begin = 0; begin < rows.size(); begin += bucket) {
    const std::size_t end = std::min(begin + bucket, rows.size());
    Extremes<3> extremes;
    for (std::size_t i = begin; i < end; ++i) extremes.take(plotted(rows[i]), i);
    auto own = extremes.places();
    std::sort(own.begin(), own.end());
    const auto last = std::unique(own.begin(), own.end());
    std::for_each(own.begin(), last, put);
  }
  return text.str();
}

}  // namespace

driver::Result<void> draw_force_and_depth(std::span<const driver::TickRecord> rows,
                                          const PictureInfo& info,
                                          const std::filesystem::path& folder) {
  if (auto done = write_text(table(rows), folder / "data/force_and_depth.dat"); !done) return done;
  double force_max = 0.1;
  double wanted_max = 0;
  double depth_max = 1e-4;
  double difference = 0;
  for (const driver::TickRecord& row : rows) {
    const double sent = length_of(row.f_sent_W);
    force_max = std::max(force_max, sent);
    depth_max = std::max(depth_max, row.depth);
    difference = std::max(difference, std::abs(length_of(row.f_wanted_W) - sent));
  }
  const bool show_wanted = difference > kVisible * force_max;
  const double duration = std::max(time_of(rows.back(), rows.front()), 1e-6);
  const auto intervals = contact_intervals(rows, duration / 1000);

  const bool touched = !intervals.empty();
  std::ostringstream c;
  c << quiet_style() << "set multiplot\nset xrange [0:" << number(duration) << "]\n"
    << "set lmargin at screen 0.075\nset rmargin at screen 0.975\nset style fill solid 1 "
       "noborder\n";
  int object = 0;
  for (const auto& [begin, end] : intervals) {
    c << "set object " << ++object << " rectangle from " << number(begin) << ", graph 0 to "
      << number(end) << ", graph 1 fc rgb '" << kContactFill << "' fs solid noborder behind\n";
  }
  if (show_wanted) {
    for (const driver::TickRecord& row : rows) {
      wanted_max = std::max(wanted_max, length_of(row.f_wanted_W));
    }
  }
  // A requested force far beyond the limit must not flatten the curve of the sent force.
  const double force_top = 1.12 * std::max(force_max, std::min(wanted_max, 2 * force_max));
  const double depth_top = 1.12e3 * depth_max;
  const std::string title = (touched ? "Force and depth: " : "Force: ") + info.title;
  const std::string time_axis =
      "\nset format x '%g'\nset xlabel 'time [s]' textcolor rgb '" + std::string(kInk) + "'\n";
  c << "set tmargin at screen 0.875\nset bmargin at screen " << (touched ? "0.515" : "0.115")
    << "\nset label 1 " << quote(fitted(title, show_wanted ? 800 : 1140, 22))
    << " at screen 0.075, screen 0.945 font ',22' noenhanced textcolor rgb '" << kInk << "'\n";
  if (touched) {
    c << "set label 2 'tip in contact' at screen 0.975, screen 0.945 right textcolor rgb '" << kInk
      << "'\nset object 100000 rectangle from screen 0.84, screen 0.932 to screen 0.86, screen "
         "0.958 fc rgb '#d5e2ee' fs solid noborder front\n";
  }
  c << "set yrange [0:" << number(force_top) << "]\nset ytics " << number(tic_step(force_top, 5))
    << "\nset xtics " << number(tic_step(duration, 10))
    << (touched ? "\nset format x ''\n" : time_axis)
    << "set ylabel 'force on the hand [N]' offset 0.5,0 textcolor rgb '" << kInk << "'\n"
    << (show_wanted
            ? "set key at screen 0.82, screen 0.955 right horizontal samplen 2 textcolor rgb '" +
                  std::string(kInk) + "'\n"
            : "unset key\n")
    << "plot ";
  if (show_wanted) {
    c << "'data/force_and_depth.dat' using 1:2 with lines lw 1.5 lc rgb '" << kFaintInk
      << "' title 'requested', ";
  }
  c << "'data/force_and_depth.dat' using 1:3 with lines lw 2 lc rgb '" << kForceInk
    << "' title 'sent'\n";
  if (touched) {
    c << "unset label 1\nunset label 2\nunset object 100000\nunset key\n"
      << "set tmargin at screen 0.475\nset bmargin at screen 0.115\nset yrange [0:"
      << number(depth_top) << "]\nset ytics " << number(tic_step(depth_top, 5)) << time_axis
      << "set ylabel 'depth of the tip [mm]'\n"
      << "plot 'data/force_and_depth.dat' using 1:4 with lines lw 2 lc rgb '" << kDepthInk
      << "' notitle\n";
  }
  c << "unset multiplot\n";
  return draw_plot({"force_and_depth", 1600, 900, c.str()}, folder);
}

}  // namespace thimble::report
