#include "studies/friction/friction_pictures.h"

#include <fmt/core.h>

#include <cmath>
#include <span>
#include <sstream>

#include "report/figure_output.h"
#include "report/gnuplot.h"
#include "report/picture_style.h"
#include "stability/signal.h"

namespace thimble::studies {
namespace {

/// Returns a short text about the state at rest.
std::string verdict(const FrictionMeasures& found) {
  if (found.rest_force < 0.001) {
    return found.rest_held >= 0.01
               ? fmt::format("at rest: no oscillation, holds {:.2f} N", found.rest_held)
               : "at rest: no oscillation, but no force either";
  }
  return fmt::format("at rest: limit cycle of {:.2f} N and {:.1f} µm RMS at {:.0f} Hz",
                     found.rest_force, 1e6 * found.rest_way, found.rest_frequency);
}

std::string stop_table(const stability::RigRun& run) {
  const std::vector<double> way = stability::high_passed(run.x, 1 / run.period, 50);
  std::ostringstream text;
  text.precision(8);
  text << "# time s, wanted mm, tip mm, force N, tip above 50 Hz um\n";
  for (std::size_t i = 0; i < run.x.size(); ++i) {
    text << run.period * static_cast<double>(i) - kStopTime << ' ' << 1e3 * run.x_wanted[i] << ' '
         << 1e3 * run.x[i] << ' ' << run.force[i] << ' ' << 1e6 * way[i] << '\n';
  }
  return text.str();
}

std::string spectrum_table(const stability::RigRun& run) {
  const double rate = 1 / run.period;
  const auto second = static_cast<std::size_t>(std::lround(rate));
  std::ostringstream text;
  text << "# frequency Hz, amplitude of the force N\n";
  for (const stability::SpectralLine& line :
       stability::spectrum(std::span<const double>(run.force).last(second), rate)) {
    text << line.frequency << ' ' << line.amplitude << '\n';
  }
  return text.str();
}

/// Returns commands for a panel by its edges, in fractions of the picture.
std::string panel(double left, double right, double bottom, double top) {
  return "set lmargin at screen " + report::number(left) + "\nset rmargin at screen " +
         report::number(right) + "\nset bmargin at screen " + report::number(bottom) +
         "\nset tmargin at screen " + report::number(top) + "\n";
}

}  // namespace

driver::Result<void> draw_friction(const FrictionCase& which, const FrictionMeasures& found,
                                   const std::filesystem::path& folder) {
  const std::string stop = "data/" + which.name + ".dat";
  const std::string lines = "data/" + which.name + "_spectrum.dat";
  if (auto done = report::write_text(stop_table(found.stop), folder / stop); !done) return done;
  if (auto done = report::write_text(spectrum_table(found.stop), folder / lines); !done)
    return done;
  const std::string ink = std::string("'") + report::kInk + "'";
  std::ostringstream c;
  c << report::quiet_style() << "set multiplot\n"
    << "set label 1 " << report::quote("Friction: " + which.title)
    << " at screen 0.075, screen 0.955 font ',22' noenhanced textcolor rgb " << ink << "\n"
    << "set label 2 " << report::quote(verdict(found))
    << " at screen 0.075, screen 0.908 noenhanced textcolor rgb '" << report::kFaintInk << "'\n"
    << "set label 3 'hand stops' at graph 0.345, graph 0.5 textcolor rgb '" << report::kFaintInk
    << "'\n"
    << "set arrow 1 from 0, graph 0 to 0, graph 1 nohead lc rgb '" << report::kFaintInk
    << "' dt 2\n"
    << panel(0.075, 0.56, 0.53, 0.86)
    << "set xrange [-0.2:0.4]\nset yrange [-1:12]\nset ytics 5\nset xtics 0.1\nset format x ''\n"
    << "set key bottom right samplen 2 textcolor rgb " << ink << "\n"
    << "set ylabel 'position [mm]' textcolor rgb " << ink << "\n"
    << "plot '" << stop << "' using 1:2 with lines lw 2 lc rgb '" << report::kFaintInk
    << "' title 'target of the hand', '' using 1:3 with lines lw 2 lc rgb '" << report::kDepthInk
    << "' title 'tip'\n"
    << "unset label 1\nunset label 2\nunset label 3\nunset key\n"
    << panel(0.075, 0.56, 0.11, 0.48) << "set yrange [-0.7:0.7]\nset ytics 0.5\nset format x '%g'\n"
    << "set xlabel 'time after the stop [s]' textcolor rgb " << ink << "\n"
    << "set ylabel 'force on the hand [N]'\n"
    << "plot '" << stop << "' using 1:4 with lines lw 1.5 lc rgb '" << report::kForceInk
    << "' notitle\n"
    << "unset arrow 1\n"
    << panel(0.645, 0.975, 0.53, 0.86)
    << "set xrange [1:1.2]\nset yrange [-60:60]\nset ytics 20\nset xtics 0.05\n"
    << "set xlabel 'time after the stop [s]'\nset ylabel 'tip above 50 Hz [µm]'\n"
    << "plot '" << stop << "' using 1:5 with lines lw 1.5 lc rgb '" << report::kDepthInk
    << "' notitle\n"
    << panel(0.645, 0.975, 0.11, 0.40)
    << "set xrange [0:500]\nset xtics 100\nset yrange [0:0.4]\nset ytics 0.1\n"
    << "set xlabel 'frequency [Hz]'\n"
    << "set ylabel 'force at rest [N]'\n";
  if (found.rest_force < 0.001) {
    c << "set label 4 'no oscillation' at graph 0.5, graph 0.5 center textcolor rgb '"
      << report::kFaintInk << "'\n";
  }
  c << "plot '" << lines << "' using 1:2 with impulses lw 1.5 lc rgb '" << report::kForceInk
    << "' notitle\nunset multiplot\n";
  return report::draw_plot({which.name, 1600, 900, c.str()}, folder);
}

driver::Result<void> draw_friction_overview(const std::vector<FrictionMeasures>& found,
                                            const std::filesystem::path& folder) {
  const std::vector<FrictionCase>& cases = friction_cases();
  constexpr int kColumns = 4;
  constexpr int kRows = 3;
  std::ostringstream c;
  c << report::quiet_style() << "set multiplot\n"
    << "set label 1 'Friction after the hand stops: 0.5 N, encoder step 0.03 mm, 1 "
       "kHz'"
    << " at screen 0.065, screen 0.96 font ',22' textcolor rgb '" << report::kInk << "'\n"
    << "set xrange [-0.1:0.3]\nset yrange [-0.7:0.7]\nset ytics 0.5\nset xtics 0, 0.1\n"
    << "set arrow 1 from 0, graph 0 to 0, graph 1 nohead lc rgb '" << report::kFaintInk
    << "' dt 2\n";
  for (std::size_t i = 0; i < cases.size() && i < found.size(); ++i) {
    const auto column = static_cast<int>(i) % kColumns;
    const auto row = static_cast<int>(i) / kColumns;
    const double left = 0.065 + 0.235 * column;
    const double top = 0.87 - 0.293 * row;
    const bool oscillates = found[i].rest_force >= 0.001;
    const bool holds = found[i].rest_held >= 0.01;
    const char* const color = oscillates ? report::kDepthInk
                              : holds    ? report::kForceInk
                                         : report::kFaintInk;
    std::string text = "comes to rest, but holds no force";
    if (oscillates) {
      text = fmt::format("limit cycle: {:.2f} N, {:.1f} µm", found[i].rest_force,
                         1e6 * found[i].rest_way);
    } else if (holds) {
      text = fmt::format("no oscillation, holds {:.2f} N", found[i].rest_held);
    }
    c << panel(left, left + 0.2, top - 0.19, top) << "set format x "
      << (row == kRows - 1 ? "'%g'" : "''") << "\nset format y " << (column == 0 ? "'%g'" : "''")
      << "\n"
      << (row == kRows - 1 ? "set xlabel 'time after the stop [s]' offset 0,0.3 textcolor rgb '" +
                                 std::string(report::kInk) + "'\n"
                           : "unset xlabel\n")
      << (column == 0 ? "set ylabel 'force [N]' offset 1,0 textcolor rgb '" +
                            std::string(report::kInk) + "'\n"
                      : "unset ylabel\n")
      << "set label 2 " << report::quote(cases[i].title)
      << " at graph 0, graph 1.22 noenhanced textcolor rgb '" << report::kInk << "'\n"
      << "set label 3 " << report::quote(text)
      << " at graph 0, graph 1.08 font ',14' noenhanced textcolor "
      << "rgb '" << color << "'\n"
      << "plot 'data/" << cases[i].name << ".dat' using 1:4 with lines lw 1.5 lc rgb '" << color
      << "' notitle\n"
      << "unset label 1\n";
  }
  c << "unset multiplot\n";
  return report::draw_plot({"overview", 1600, 1000, c.str()}, folder);
}

}  // namespace thimble::studies
