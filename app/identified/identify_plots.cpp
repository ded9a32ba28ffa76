#include "identified/identify_plots.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

#include "bringup/identify/line_forces.h"
#include "identified/plot_tables.h"
#include "report/figure_output.h"
#include "report/gnuplot.h"
#include "report/picture_style.h"

namespace thimble::identified {
namespace {

constexpr const char* kSeenInk = "#9aa5b1";
constexpr const char* kFitInk = "#0072b2";
constexpr const char* kMarkInk = "#d55e00";
constexpr int kWidth = 1200;  // pixels, width of a plot

std::string quiet(const char* more) {
  return report::quiet_style() + "set key off\nset tics font ',14'\n" + more;
}

/// Returns the height of a plot of stacked panels, pixels: that of each panel, and of the time
/// axis.
int stacked_height(std::size_t panels) {
  return 120 + 200 * static_cast<int>(panels);
}

/// Returns the gnuplot text of panels on top of each other, one for each axis along which the tip
/// moves, with a title on the left of each.
std::string stacked(const std::string& unit, const std::vector<std::string>& plots) {
  const double height = stacked_height(plots.size());
  std::string text =
      quiet("set tmargin 0.6\nset bmargin 0.6\nset lmargin 11\nset rmargin 2\n") +
      fmt::format("set multiplot layout {},1 margins 0.09,0.985,{:.4g},{:.4g} spacing {:.4g}\n",
                  plots.size(), 79 / height, 1 - 22 / height, 22 / height);
  for (std::size_t i = 0; i < plots.size(); ++i) {
    text += fmt::format("set ylabel '{} [{}]' font ',15'\n", "xyz"[i], unit);
    text += i + 1 == plots.size() ? "set format x '%g'\nset xlabel 'time [s]' font ',15'\n"
                                  : "set format x ''\n";
    text += plots[i] + "\n";
  }
  return text + "unset multiplot\n";
}

/// Returns the gnuplot text of at most three panels side by side, one for each joint or axis.
std::string side_by_side(const std::string& commands, const std::string& x, const std::string& y,
                         const std::vector<std::string>& plots,
                         const std::array<const char*, 3>& titles = {"joint 1", "joint 2",
                                                                     "joint 3"}) {
  std::string text =
      quiet("") + commands +
      fmt::format("set multiplot layout 1,{} margins 0.085,0.985,0.2,0.885 spacing 0.055\n",
                  plots.size());
  text += fmt::format("set xlabel '{}' font ',15'\n", x);
  for (std::size_t i = 0; i < plots.size(); ++i) {
    text += fmt::format("set title '{}' font ',16'\n", titles[i]);
    text += i == 0 ? fmt::format("set ylabel '{}' font ',15' offset 1.5,0\n", y) : "unset ylabel\n";
    text += plots[i] + "\n";
  }
  return text + "unset multiplot\n";
}

std::string fit_plot(std::size_t motors) {
  std::vector<std::string> plots(motors);
  for (std::size_t i = 0; i < motors; ++i) {
    plots[i] = fmt::format(
        "plot 'data/identify_fit.dat' index {0} using 1:2 with points pt 7 ps 0.75 lc rgb '{1}', "
        "'data/identify_fit.dat' index {0} using 1:3 with lines lw 2 lc rgb '{2}'",
        i, kSeenInk, kFitInk);
  }
  return stacked("m/s²", plots);
}

std::string rest_plot(std::size_t motors, double noise) {
  std::vector<std::string> plots(motors);
  for (std::size_t i = 0; i < motors; ++i) {
    plots[i] = fmt::format(
        "plot 'data/identify_rest.dat' index {} using 1:2 with points pt 7 ps 0.22 lc rgb '{}', "
        "{:.5g} "
        "with "
        "lines lw 1.5 dt 2 lc rgb '{}', {:.5g} with lines lw 1.5 dt 2 lc rgb '{}'",
        i, kFitInk, 2 * noise, kMarkInk, -2 * noise, kMarkInk);
  }
  return stacked("m/s²", plots);
}

std::string friction_plot(std::size_t motors) {
  std::vector<std::string> plots(motors);
  for (std::size_t i = 0; i < motors; ++i) {
    plots[i] = fmt::format(
        "plot 'data/identify_friction.dat' index {0} using 1:(1e3*$2) with points pt 7 ps 0.2 lc "
        "rgb '#d5dae0', 'data/identify_friction_medians.dat' index {0} using "
        "1:(1e3*$2):(1e3*$3):(1e3*$4) with yerrorbars pt 7 ps 0.7 lw 1.5 lc rgb '{1}', "
        "'data/identify_friction_medians.dat' index {0} using 1:(1e3*$5) with lines lw 2.5 lc rgb "
        "'{2}'",
        i, report::kInk, kFitInk);
  }
  return side_by_side("set yzeroaxis lw 1 lc rgb '#b8c2cc'\nset xzeroaxis lw 1 lc rgb '#b8c2cc'\n",
                      "speed of the joint [rad/s]", "torque of friction [mN m]", plots);
}

std::string masses_plot() {
  std::vector<std::string> plots(3);
  for (std::size_t i = 0; i < 3; ++i) {
    plots[i] = fmt::format(
        "plot 'data/identify_masses.dat' index {0} using (1e3*$1):(1e3*$1) with lines lw 2 lc rgb "
        "'{1}', 'data/identify_masses.dat' index {0} using (1e3*$1):(1e3*$2):(1e3*$3) with "
        "yerrorbars pt 7 ps 0.8 lw 1.5 lc rgb '{2}'",
        i, kFitInk, report::kInk);
  }
  return side_by_side("", "fitted [g]", "measured [g]", plots, {"along x", "along y", "along z"});
}

std::string lines_plot(const bringup::Identified& identified) {
  std::vector<std::string> plots(3);
  for (std::size_t i = 0; i < 3; ++i) {
    std::string marks = "unset arrow\nunset label\n";
    if (identified.constants.cables) {
      const bringup::CableConstants& cable = (*identified.constants.cables)[i];
      // The labels use the free room: above a dip, below a peak.
      for (const auto& [at, name, place] :
           {std::tuple{cable.antiresonance.value, "antiresonance", "0.97 right"},
            std::tuple{cable.resonance.value, "resonance", "0.03 left"}}) {
        if (at < bringup::LineForces::kLowest || at > bringup::LineForces::kHighest) continue;
        marks += fmt::format(
            "set arrow from {0:.5g}, graph 0 to {0:.5g}, graph 1 nohead dt 2 lw "
            "1.5 lc rgb '{1}'\nset label '{2} {0:.0f} Hz' at {0:.5g}, graph {3} "
            "rotate offset -0.6,0 font ',13' textcolor rgb '{1}'\n",
            at, kMarkInk, name, place);
      }
    }
    plots[i] = marks + fmt::format(
                           "plot 'data/identify_resonance.dat' index {0} using 1:2 with lines lw 2 "
                           "lc rgb '{1}', 'data/identify_lines.dat' index {0} using 1:2:3 with "
                           "yerrorbars pt 7 ps 0.7 lw 1.5 lc rgb '{2}'",
                           i, kFitInk, report::kInk);
  }
  return side_by_side("set logscale xy\nset xrange [14:400]\nset xtics (15, 30, 60, 120, 240)\n",
                      "frequency [Hz]", "motion relative to stiff cables", plots);
}

}  // namespace

driver::Result<std::vector<IdentifyPlot>> draw_identified(const bringup::Identified& identified,
                                                          const scene::ArmFile& file,
                                                          const std::filesystem::path& folder) {
  const bringup::FittedMotion motion = identified.fitted();
  const double dt = identified.moved.dt;
  const bool lines = !identified.lines.noise.empty();
  std::vector<std::pair<const char*, std::string>> tables{
      {"identify_fit", fit_table(motion)},
      {"identify_rest", rest_table(motion)},
      {"identify_friction", friction_table(motion, identified)},
      {"identify_friction_medians", friction_medians(motion, identified)}};
  if (lines) {
    tables.emplace_back("identify_lines", lines_table(identified, dt));
    tables.emplace_back("identify_resonance", resonance_table(identified, dt));
  }
  const bool links = identified.constants.links.has_value();
  if (links) tables.emplace_back("identify_masses", masses_table(identified, file));
  for (const auto& [name, text] : tables) {
    if (auto done = report::write_text(text, folder / "data" / (std::string(name) + ".dat"));
        !done) {
      return done.error();
    }
  }
  std::vector<IdentifyPlot> shown{
      {"identify_fit", "Fit and data",
       "Acceleration of the tip along the axes of the base. Each point is the mean over a segment "
       "of 60 ms; the plot shows two seconds from the middle of the motion. Dots: measured. Line: "
       "fitted."},
      {"identify_rest", "Residual of the fit",
       "Measured minus fitted acceleration over the whole motion. The dashed lines mark the noise "
       "of the encoder steps (two standard deviations)."},
      {"identify_friction", "Friction over speed for each joint",
       "Remainder after motors, mass and weight, as torques at the joints. Faint: segments of 60 "
       "ms. Dots: their medians with quartiles. Line: the fitted friction on the same motion. A "
       "step at zero is dry friction; a slope is viscous friction."}};
  if (identified.play.friction.seen) {
    shown.back().caption +=
        " The friction of the motors, which was fitted separately, is subtracted.";
  }
  // Absent motors have no data to plot.
  const auto motors = static_cast<std::size_t>(file.motors());
  std::vector<std::string> commands{fit_plot(motors), rest_plot(motors, identified.bare.noise),
                                    friction_plot(motors)};
  if (lines) {
    shown.push_back(
        {"identify_lines", "Cables: response to 48 small forces",
         "Oscillation of each joint relative to an arm whose cables do not stretch. Dots: "
         "measured, with the interval from the noise near that frequency; frequencies hidden by "
         "noise are omitted. Line: fitted. A dip is the oscillation of the link on its cable; a "
         "peak is that of motor against link. If no cable stretches, all values are 1."});
    commands.push_back(lines_plot(identified));
  }
  if (links) {
    shown.push_back({"identify_masses", "Apparent mass over the workspace",
                     "Mass at the tip along the axes of the base, with one dot for each place: the "
                     "mass measured there, with its 95 % interval, over the mass fitted with tip "
                     "and links. Dots on the line agree exactly."});
    commands.push_back(masses_plot());
  }
  if (!report::has_gnuplot()) return std::vector<IdentifyPlot>{};
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const report::Plot plot{shown[i].name, kWidth, i < 2 ? stacked_height(motors) : 480,
                            commands[i]};
    if (auto drawn = report::draw_plot(plot, folder); !drawn) return drawn.error();
  }
  return shown;
}

}  // namespace thimble::identified
