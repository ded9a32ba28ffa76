#include "twin/twin_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "report/gnuplot.h"
#include "report/picture_style.h"

namespace thimble::twin {
namespace {

constexpr double kMicro = 1e6;

/// Returns the change of an error in percent; -0 becomes 0.
double changed(double before, double after) {
  const double percent = before > 0 ? 100 * (after / before - 1) : 0;
  return std::abs(percent) < 0.05 ? 0 : percent;
}

std::string error_table(const TwinTrace& trace) {
  std::ostringstream text;
  text.precision(7);
  text << "# time s, error of a window (RMS) in x, y, z, um\n";
  for (std::size_t w = 0; w < trace.windows.size(); ++w) {
    Eigen::Vector3d square(0, 0, 0);
    double count = 0;
    for (std::size_t j = 0; j < trace.windows[w].seen.size(); ++j) {
      if (!trace.windows[w].seen[j]) continue;
      count += 1;
      square +=
          (trace.R_WB * trace.replayed.error_B[w].col(static_cast<Eigen::Index>(j))).cwiseAbs2();
    }
    const Eigen::Vector3d rms = kMicro * (square / count).cwiseSqrt();
    text << trace.windows[w].time << ' ' << rms.x() << ' ' << rms.y() << ' ' << rms.z() << '\n';
  }
  return text.str();
}

std::string spectrum_table(const TwinComparison& comparison) {
  std::ostringstream text;
  text.precision(7);
  text << "# frequency Hz, error in x, y, z um, recorded motion in x, y, z um\n";
  for (const TwinSpectrum& line : comparison.spectrum) {
    if (line.frequency == 0) continue;
    text << line.frequency;
    for (const double value : line.error) text << ' ' << kMicro * value;
    for (const double value : line.motion) text << ' ' << kMicro * value;
    text << '\n';
  }
  return text.str();
}

/// The window with the largest error.
std::size_t worst_window(const TwinTrace& trace) {
  std::size_t worst = 0;
  double largest = -1;
  for (std::size_t w = 0; w < trace.windows.size(); ++w) {
    const double square = trace.replayed.error_B[w].squaredNorm();
    if (square > largest) largest = square, worst = w;
  }
  return worst;
}

std::string motion_table(const TwinTrace& trace) {
  std::ostringstream text;
  text.precision(9);
  text << "# time s, recorded minus a straight line in x, y, z mm, twin minus the same line in x, "
          "y, z mm\n";
  const std::size_t w = worst_window(trace);
  for (std::size_t j = 0; j < trace.windows[w].seen.size(); ++j) {
    if (!trace.windows[w].seen[j]) continue;
    const auto k = static_cast<Eigen::Index>(j);
    const Eigen::Vector3d recorded = 1e3 * trace.R_WB * trace.windows[w].motion_B.col(k);
    const Eigen::Vector3d twin = recorded + 1e3 * trace.R_WB * trace.replayed.error_B[w].col(k);
    text << trace.windows[w].time + static_cast<double>(j) * trace.dt;
    for (int i = 0; i < 3; ++i) text << ' ' << recorded[i];
    for (int i = 0; i < 3; ++i) text << ' ' << twin[i];
    text << '\n';
  }
  return text.str();
}

std::string heading(const std::string& title) {
  return report::quiet_style() + "set title " + report::quote(title) +
         " noenhanced textcolor rgb '" + report::kInk + "'\nset key top right textcolor rgb '" +
         report::kInk + "'\n";
}

// Three colours that are distinct for colour-blind users [M Okabe and Ito].
constexpr const char* kAxisInk[] = {"#0072b2", "#d55e00", "#009e73"};

std::string plots(const char* file, const char* style, int first, const std::string& titles,
                  bool more) {
  std::string text;
  for (int i = 0; i < 3; ++i) {
    text += fmt::format("{}'data/{}.dat' using 1:{} with {} lc rgb '{}' title '{} {}'",
                        i > 0 || more ? ", " : "plot ", file, first + i, style, kAxisInk[i],
                        "xyz"[i], titles);
  }
  return text;
}

driver::Result<void> draw(const std::string& title, const std::filesystem::path& folder) {
  const report::Plot motion{
      "twin_motion", 1600, 900,
      heading("Window with the largest error of the twin: " + title) +
          "set xlabel 'time [s]'\nset ylabel 'tip minus a straight line [mm]'\n" +
          plots("twin_motion", "lines lw 2", 2, "recorded", false) +
          plots("twin_motion", "lines lw 2 dt 2", 5, "twin", true) + "\n"};
  const report::Plot error{
      "twin_error", 1600, 700,
      heading("Error of the twin over time: " + title) +
          "set xlabel 'time [s]'\nset ylabel 'error of a window, RMS [um]'\nset "
          "yrange [0:*]\n" +
          plots("twin_error", "linespoints pt 7 ps 0.5", 2, "", false) + "\n"};
  const report::Plot spectrum{
      "twin_spectrum", 1600, 900,
      heading("Error of the twin over frequency: " + title) +
          "set logscale xy\nset xlabel 'frequency [Hz]'\nset ylabel 'amplitude [um]'\n" +
          plots("twin_spectrum", "lines lw 2", 2, "error", false) +
          plots("twin_spectrum", "lines lw 1 dt 2", 5, "motion", true) + "\n"};
  for (const report::Plot* plot : {&motion, &error, &spectrum}) {
    if (auto done = report::draw_plot(*plot, folder); !done) return done;
  }
  return {};
}

}  // namespace

std::vector<session::Figure> twin_figures(const TwinComparison& found, double min_fit) {
  std::vector<session::Figure> figures;
  for (const TwinAxis& axis : found.axes) {
    const bool moved = !std::isnan(axis.fit);
    figures.push_back({fmt::format("fit_{}", axis.name), moved ? axis.fit : 0, "%",
                       moved && min_fit > 0 ? fmt::format(">= {:g}", min_fit) : "",
                       moved ? "100 (1 - error / motion)" : "the axis did not move"});
    figures.push_back(
        {fmt::format("error_{}", axis.name), kMicro * axis.error_rms, "um", "", "RMS"});
    figures.push_back(
        {fmt::format("motion_{}", axis.name), kMicro * axis.motion_rms, "um", "", "RMS"});
  }
  figures.push_back({"error", kMicro * found.error_rms, "um", "", "RMS of all axes"});
  figures.push_back(
      {"error_of_encoders", kMicro * found.step_error, "um", "", "from encoder steps"});
  figures.push_back({"compared", found.seconds, "s", "", ""});
  for (const TwinRemedy& remedy : found.remedies) {
    figures.push_back(
        {"best " + remedy.key, remedy.best, remedy.unit, "",
         fmt::format("file {:.5g}; the error would be {:.4g} um, expected {:.4g}", remedy.value,
                     kMicro * remedy.error_rms, kMicro * remedy.expected)});
  }
  return figures;
}

std::string twin_table(const TwinComparison& found) {
  std::string text =
      fmt::format("{:<5} {:>10} {:>12} {:>12}\n", "axis", "fit", "error RMS", "motion RMS");
  for (const TwinAxis& axis : found.axes) {
    text += fmt::format("{:<5} {:>10} {:>9.3g} um {:>9.4g} um\n", axis.name,
                        std::isnan(axis.fit) ? "not moved" : fmt::format("{:.2f} %", axis.fit),
                        kMicro * axis.error_rms, kMicro * axis.motion_rms);
  }
  text += fmt::format(
      "{:.1f} s compared; error {:.3g} um, of which the encoder steps cause {:.3g} um.\n",
      found.seconds, kMicro * found.error_rms, kMicro * found.step_error);
  text += fmt::format("\n{:<34} {:>10} {:>10} {:<6} {:>12} {:>9}\n", "constant", "file", "best", "",
                      "error change", "expected");
  for (const TwinRemedy& remedy : found.remedies) {
    text += fmt::format("{:<34} {:>10.5g} {:>10.5g} {:<6} {:>10.1f} % {:>7.1f} %\n", remedy.key,
                        remedy.value, remedy.best, remedy.unit,
                        changed(found.error_rms, remedy.error_rms),
                        changed(found.error_rms, remedy.expected));
  }
  if (found.has_remedy()) {
    const TwinRemedy& first = found.remedies.front();
    text += fmt::format(
        "\n{} reduces the error most: with {:.5g} {} instead of {:.5g} it is {:.3g} um instead of "
        "{:.3g} um.\n",
        first.key, first.best, first.unit, first.value, kMicro * first.error_rms,
        kMicro * found.error_rms);
  } else {
    text += "\nNo change of a single constant would reduce the error by 1 %.\n";
  }
  if (!found.together.empty()) {
    text += fmt::format("Together these changes reduce it to {:.3g} um:\n",
                        kMicro * found.together.front().error_rms);
    for (const TwinRemedy& one : found.together) {
      text += fmt::format("  {}: {:.5g} {} instead of {:.5g}\n", one.key, one.best, one.unit,
                          one.value);
    }
  }
  if (found.missed() > TwinComparison::kMissed) {
    text += fmt::format(
        "The remaining error is {:.0f} % of the motion: several constants are wrong, something "
        "held the tip, or the arm has a property that its file does not contain.\n",
        100 * found.missed());
  }
  return text;
}

driver::Result<void> write_twin(const TwinResult& result,
                                const std::vector<session::Figure>& figures,
                                const std::string& title, const std::filesystem::path& folder) {
  if (auto made = report::make_picture_folder(folder); !made) return made;
  if (auto done = report::write_figures(figures, folder / "figures.json"); !done) return done;
  const std::pair<const char*, std::string> tables[] = {
      {"data/twin_motion.dat", motion_table(result.trace)},
      {"data/twin_error.dat", error_table(result.trace)},
      {"data/twin_spectrum.dat", spectrum_table(result.comparison)}};
  for (const auto& [name, text] : tables) {
    if (auto done = report::write_text(text, folder / name); !done) return done;
  }
  return report::has_gnuplot() ? draw(title, folder) : driver::Result<void>();
}

}  // namespace thimble::twin
