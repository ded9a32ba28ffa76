#include "studies/stability/stability_pictures.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <sstream>
#include <string>

#include "report/gnuplot.h"
#include "report/picture_style.h"
#include "stability/stability_laws.h"
#include "studies/stability/drive_train_walls.h"
#include "studies/stability/stability_picture_parts.h"

namespace thimble::studies {
namespace {

/// Returns a text with arm, hand and loop.
std::string subject(const StabilitySetup& setup, bool with_hand) {
  const device_sim::PlantSettings& tip = setup.arm.simulated.plant;
  std::string text = fmt::format("{} at {:.4g} Hz, force {:.3g} ms late, tip {:.3g} kg",
                                 setup.arm.name, 1 / setup.period(), 1e3 * setup.delay(), tip.mass);
  if (with_hand && setup.hand.stiffness > 0) {
    text += fmt::format("; hand {:.3g} kg, {:.3g} N/m, {:.3g} N s/m", setup.hand.mass,
                        setup.hand.stiffness, setup.hand.damping);
  } else {
    text += "; no hand";
  }
  return text;
}

double log_of(double value) {
  return value > 0 ? std::log10(value) : std::nan("");
}

std::string curve(const std::string& file, const std::string& columns, const char* color,
                  const std::string& style, const std::string& title) {
  return "'data/" + file + "' using " + columns + " " + style + " lc rgb '" + color + "' title " +
         report::quote(title);
}

// ---- The K-B map ----

/// Writes the lines over the maps: log10 B, then log10 of K by each law and measurement.
driver::Result<void> write_kb_lines(const StabilitySetup& setup,
                                    const std::vector<StabilityRow>& rows,
                                    const std::filesystem::path& folder) {
  const auto linear = part_of(rows, StabilityPart::kLinearEdge);
  const auto arm = part_of(rows, StabilityPart::kArmEdge);
  const auto diagonal = part_of(rows, StabilityPart::kDiagonalEdge);
  const auto guarded = part_of(rows, StabilityPart::kGuardedEdge);
  const device_sim::PlantSettings& tip = setup.arm.simulated.plant;
  std::vector<std::vector<double>> lines;
  for (std::size_t i = 0; i < linear.size(); ++i) {
    const double b = linear[i].cell.b;
    lines.push_back(
        {std::log10(b), log_of(linear[i].found[0]), log_of(linear[i].law), log_of(linear[i].exact),
         log_of(arm[i].found[0]), log_of(arm[i].law), log_of(diagonal[i].found[0]),
         log_of(stability::passive_stiffness(tip.viscous, b, setup.period(), setup.delay())),
         log_of(guarded[i].found[0])});
  }
  return write_data(lines, folder / "data/kb_lines.dat");
}

/// Writes a map as log10 B, log10 K, value. A blank line between blocks keeps gnuplot's grid.
driver::Result<void> write_map(const std::vector<StabilityRow>& rows,
                               const std::function<double(double)>& value,
                               const std::filesystem::path& file) {
  std::vector<std::vector<double>> lines;
  lines.reserve(rows.size());
  for (const StabilityRow& row : rows) {
    lines.push_back({std::log10(row.cell.b), std::log10(row.cell.a), value(row.found[0])});
  }
  return write_data(lines, file);
}

std::string decade_axes() {
  // %% would be a number of decades; the tics are powers of ten of the linear axes.
  return "set xrange [-3.05:2.05]\nset yrange [-0.05:5.05]\nset xtics 1\nset ytics 1\n"
         "set format x '10^{%g}'\nset format y '10^{%g}'\n";
}

driver::Result<void> draw_kb_map(const StabilitySetup& setup, const std::vector<StabilityRow>& rows,
                                 const std::filesystem::path& folder) {
  if (auto done = write_kb_lines(setup, rows, folder); !done) return done;
  if (auto done = write_map(
          part_of(rows, StabilityPart::kLinearMap),
          [](double growth) { return std::clamp(growth, -40.0, 40.0); },
          folder / "data/kb_linear.dat");
      !done) {
    return done;
  }
  const double step = setup.direction.step;
  if (auto done = write_map(
          part_of(rows, StabilityPart::kArmMap),
          [step](double oscillation) {
            return std::log10(std::clamp(oscillation / step, 1e-2, 1e3));
          },
          folder / "data/kb_arm.dat");
      !done) {
    return done;
  }
  const device_sim::PlantSettings& tip = setup.arm.simulated.plant;
  const double latency = scene::latency_of({.period = setup.period(), .delay = setup.delay()});
  const double quantised =
      stability::passive_stiffness_quantised(tip.viscous, tip.coulomb, step, setup.period());
  std::string note;
  std::ostringstream c;
  c << report::quiet_style() << "set multiplot\n"
    << heading("Stable walls: stiffness against damping", subject(setup, true))
    << "unset grid\nset border 15 lw 1 lc rgb '" << report::kFaintInk << "'\n"
    << "set key at screen 0.065, screen 0.195 left top Left reverse samplen 2.2 spacing 1.2 "
       "maxrows 6 font ',15' textcolor rgb '"
    << report::kInk << "'\n"
    << axis_labels("damping B of the wall [N s/m]", "stiffness K of the wall [N/m]")
    << decade_axes() << panel(0.065, 0.42, 0.29, 0.83)
    << panel_title("Linear arm: ideal encoders, no dry friction")
    << "set palette defined (-40 '#0072b2', -8 '#a9cfe6', 0 '#ffffff', 8 '#f3c19b', 40 '#d55e00')\n"
    << "set cbrange [-40:40]\nset cbtics 20\n"
    << "set cblabel 'growth of an oscillation [1/s]' textcolor rgb '" << report::kInk
    << "' offset 0.6,0\n"
    << "set colorbox user origin screen 0.43, screen 0.29 size screen 0.012, screen 0.54\n"
    << "plot 'data/kb_linear.dat' using 1:2:3 with image pixels notitle, "
    << curve("kb_lines.dat", "1:2", report::kInk, "with points pt 7 ps 0.45", "measured edge")
    << ", "
    << curve("kb_lines.dat", "1:4", report::kInk, "with lines lw 1.5", "exact map of one tick")
    << ", "
    << curve("kb_lines.dat", "1:3", kGreenInk, "with lines lw 3 dt 2", "latency budget (b+B)/L")
    << ", "
    << curve("kb_lines.dat", "1:8", kPurpleInk, "with lines lw 3",
             "passive with any hand (Colgate, Schenkel)")
    << "\n";
  note = fmt::format("L = {:.3g} ms", 1e3 * latency);
  c << "set key at screen 0.55, screen 0.195\nset ylabel ''\n"
    << panel(0.55, 0.905, 0.29, 0.83)
    << panel_title(setup.hand.stiffness > 0 ? "Arm without energy stage, pressed in by the hand"
                                            : "Arm without energy stage, released at 0.1 m/s")
    << "set palette defined (-2 '#ffffff', -1 '#f6e3c8', 0 '#f0c08a', 1 '#d55e00', 2 '#8c2d04', "
       "3 '#3b0f00')\n"
    << "set cbrange [-2:3]\nset cbtics ('rest' -2, '0.1' -1, '1' 0, '10' 1, '100' 2, '1000' 3)\n"
    << "set cblabel 'limit cycle at the end [encoder steps]' textcolor rgb '" << report::kInk
    << "'\n"
    << "set colorbox user origin screen 0.915, screen 0.29 size screen 0.012, screen 0.54\n"
    << "plot 'data/kb_arm.dat' using 1:2:3 with image pixels notitle, "
    << curve("kb_lines.dat", "1:5", report::kInk, "with lines lw 2",
             "measured edge: limit cycle of 1/4 step")
    << ", "
    << curve("kb_lines.dat", "1:9", report::kForceInk, "with lines lw 2.5",
             "the same with the arm's energy stage")
    << ", "
    << curve("kb_lines.dat", "1:7", report::kInk, "with lines lw 3 dt 3",
             "the same if all encoders step at once")
    << ", "
    << curve("kb_lines.dat", "1:6", kGreenInk, "with lines lw 3 dt 2",
             "law: limit by damping and dry friction")
    << ", " << log_of(quantised) << " with lines lw 3 lc rgb '" << kPurpleInk
    << "' title 'passive: min(2b/T, 2c/Δ) (Abbott, Okamura)', " << log_of(2 * tip.coulomb / step)
    << " with lines lw 2 dt 4 lc rgb '" << kGoldInk
    << "' title 'σ = 1/2: dry friction holds one step (Diolaiti)'\nunset multiplot\n";
  return report::draw_plot({"kb_map", 1700, 1000, c.str()}, folder);
}

// ---- Restitution ----

driver::Result<void> draw_restitution(const StabilitySetup& setup,
                                      const std::vector<StabilityRow>& rows,
                                      const std::filesystem::path& folder) {
  constexpr std::array kInks{report::kInk,      report::kDepthInk, kPurpleInk,
                             report::kForceInk, kGreenInk,         kGoldInk};
  const auto bounces = part_of(rows, StabilityPart::kRestitution);
  std::vector<std::vector<double>> points, curves;
  std::vector<StabilityCell> series;
  for (std::size_t i = 0; i < bounces.size(); ++i) {
    const StabilityCell& cell = bounces[i].cell;
    const bool fresh = series.empty() || cell.c != series.back().c || cell.d != series.back().d ||
                       cell.b != series.back().b;
    if (fresh && !series.empty()) {
      points.insert(points.end(), 1, {});
      curves.insert(curves.end(), 1, {});
    }
    if (fresh) series.push_back(cell);
    points.push_back(
        {cell.a, bounces[i].found[0], bounces[i].found[1], bounces[i].found[2], bounces[i].law});
    // The law is also drawn between the points.
    if (i + 1 == bounces.size() || bounces[i + 1].cell.c != cell.c ||
        bounces[i + 1].cell.d != cell.d || bounces[i + 1].cell.b != cell.b) {
      const device_sim::PlantSettings& tip = setup.arm.simulated.plant;
      for (double k = 100; k <= cell.a * 1.001; k *= 1.03) {
        curves.push_back(
            {k, stability::restitution(k, tip.viscous + cell.b, tip.mass,
                                       scene::latency_of({.period = cell.c, .delay = cell.d}))});
      }
    }
  }
  if (auto done = write_data(points, folder / "data/restitution.dat"); !done) return done;
  if (auto done = write_data(curves, folder / "data/restitution_law.dat"); !done) return done;
  std::ostringstream c;
  c << report::quiet_style()
    << heading("Restitution of a wall",
               setup.arm.name +
                   " without a hand, ideal encoders, no dry friction; 0.1 m/s; dots: mean over "
                   "all sampling phases, bars: minimum and maximum")
    << panel(0.08, 0.73, 0.12, 0.86)
    << "set logscale x\nset xrange [90:35000]\nset yrange [0.5:2]\n"
    << "set logscale y\nset ytics (0.5, 0.6, 0.7, 0.8, 0.9, 1, 1.1, 1.2, 1.4, 1.6, 1.8, 2)\n"
    << axis_labels("stiffness of the wall [N/m]", "restitution: speed out / speed in")
    << "set key at screen 0.745, screen 0.84 left top Left reverse samplen 2 spacing 1.6 font "
       "',15' textcolor rgb '"
    << report::kInk << "'\n"
    << "set arrow 1 from graph 0, first 1 to graph 1, first 1 nohead lw 1.5 lc rgb '"
    << report::kFaintInk << "'\n"
    << "set label 1 'above this line the wall generates energy, below it dissipates' "
       "at first 95, first 0.97 font ',14' textcolor rgb '"
    << report::kFaintInk << "'\nplot ";
  for (std::size_t i = 0; i < series.size(); ++i) {
    std::string title = fmt::format("{:.4g} kHz", 1e-3 / series[i].c);
    if (series[i].d > 0) {
      title += fmt::format(", {:.3g} ms late", 1e3 * series[i].d);
    }
    if (series[i].b > 0) {
      title += fmt::format(", B = {:.3g} N s/m", series[i].b);
    }
    c << "'data/restitution.dat' every :::" << i << "::" << i
      << " using 1:2:3:4 with yerrorbars pt 7 ps 0.9 lw 1 lc rgb '" << kInks[i % kInks.size()]
      << "' title " << report::quote(title) << ", 'data/restitution_law.dat' every :::" << i
      << "::" << i << " using 1:2 with lines lw 2 lc rgb '" << kInks[i % kInks.size()]
      << "' notitle, ";
  }
  c << "NaN with lines lw 2 lc rgb '" << report::kFaintInk
    << "' title 'lines: the law; dots: simulated'\n";
  return report::draw_plot({"restitution", 1600, 900, c.str()}, folder);
}

// ---- Limit cycles ----

driver::Result<void> draw_cycles(const StabilitySetup& setup, const std::vector<StabilityRow>& rows,
                                 const std::filesystem::path& folder) {
  const auto cycles = part_of(rows, StabilityPart::kCycle);
  std::ostringstream c;
  c << report::quiet_style() << "set multiplot\n"
    << heading("Limit cycles of a wall with coarse encoders and dry friction",
               "β = b/(K T), σ = c/(K Δ); blue: corners of Diolaiti et al.; green: limit at "
               "which dry friction stops the start; " +
                   setup.arm.name + ", no hand")
    << "unset grid\nset border 15 lw 1 lc rgb '" << report::kFaintInk << "'\n"
    << "set palette defined (-3 '#ffffff', -2 '#f6e3c8', 0 '#f0c08a', 1 '#d55e00', 2.4 '#3b0f00')\n"
    << "set cbrange [-3:2.4]\nset cbtics ('rest' -3, '0.01' -2, '0.1' -1, '1' 0, '10' 1, '100' 2)\n"
    << "set cblabel 'oscillation at the end [encoder steps]' textcolor rgb '" << report::kInk
    << "'\n"
    << "set xrange [0.02:1.53]\nset xtics 0.5\nset ytics 0.5\n";
  int index = 0;
  for (const double start : {3.5, 60.5}) {
    for (const double delay : {0.0, 1.0}) {
      std::vector<std::vector<double>> map, limit;
      for (const StabilityRow& row : cycles) {
        if (row.cell.c != start || row.cell.d != delay) continue;
        map.push_back({row.cell.a, row.cell.b, std::log10(std::clamp(row.found[0], 1e-3, 250.0))});
      }
      // beta at which dry friction just suppresses the initial speed: v* solved for b.
      const double speed = cycle_speed(setup, start);
      for (double sigma = 0.02; sigma <= 1.54; sigma += 0.02) {
        const double held = 4 / std::numbers::pi * sigma * kCycleStep / (setup.period() * speed);
        limit.push_back({sigma, 0.5 + delay - held});
      }
      const std::string name = "cycles_" + std::to_string(index);
      if (auto done = write_data(map, folder / ("data/" + name + ".dat")); !done) return done;
      if (auto done = write_data(limit, folder / ("data/" + name + "_limit.dat")); !done) {
        return done;
      }
      const int column = index % 2, row = index / 2;
      const double left = 0.09 + 0.415 * column, top = 0.84 - 0.4 * row;
      const std::string title =
          fmt::format("{} start ({:.3g} steps), force {}", start < 10 ? "small" : "large", start,
                      delay > 0 ? "one period late" : "not delayed");
      c << panel(left, left + 0.35, top - 0.3, top) << panel_title(title)
        << axis_labels(row == 1 ? "dry friction σ" : "", column == 0 ? "viscous friction β" : "")
        << "set yrange [" << 0.02 + delay << ":" << 1.53 + delay << "]\n"
        << "set arrow 1 from 0.5, graph 0 to 0.5, graph 1 nohead front lw 2 lc rgb '"
        << report::kForceInk << "'\nset arrow 2 from graph 0, first " << 0.5 + delay
        << " to graph 1, first " << 0.5 + delay << " nohead front lw 2 lc rgb '"
        << report::kForceInk << "'\n";
      const auto region = [&](int tag, const char* text, double x, double y, const char* ink) {
        c << "set label " << tag << " '" << text << "' at graph " << x << ", graph " << y
          << " center front font ',15' textcolor rgb '" << ink << "'\n";
      };
      const bool large = start > 10;
      region(1, "comes to rest", 0.66, 0.66, report::kInk);
      region(2, "flickers", 0.16, 0.66, report::kInk);
      region(3, large ? "exceeds dry friction: grows" : "stops a small oscillation", 0.66,
             large ? 0.06 : 0.16, large ? "#ffffff" : report::kInk);
      region(4, large ? "grows" : "", 0.16, 0.06, "#ffffff");
      c << (index == 0 ? "set colorbox user origin screen 0.89, screen 0.14 size screen 0.014, "
                         "screen 0.7\n"
                       : "unset colorbox\n")
        << "plot 'data/" << name << ".dat' using 1:2:3 with image pixels notitle, 'data/" << name
        << "_limit.dat' using 1:2 with lines lw 2.5 dt 2 lc rgb '" << kGreenInk << "' notitle\n"
        << "unset label 101\nunset label 102\n";
      ++index;
    }
  }
  c << "unset multiplot\n";
  return report::draw_plot({"limit_cycles", 1500, 1200, c.str()}, folder);
}

// ---- Largest stiffness ----

driver::Result<void> draw_largest(const StabilitySetup& setup,
                                  const std::vector<StabilityRow>& rows,
                                  const std::filesystem::path& folder) {
  const auto write = [&](StabilityPart part, const char* file, auto x) {
    std::vector<std::vector<double>> lines;
    const StabilityRow* last = nullptr;
    const auto chosen = part_of(rows, part);
    for (const StabilityRow& row : chosen) {
      // A new series begins where x decreases.
      if (last != nullptr && x(row) < x(*last)) lines.push_back({});
      lines.push_back({x(row), row.found[0], row.law});
      last = &row;
    }
    return write_data(lines, folder / "data" / file);
  };
  using Row = const StabilityRow&;
  for (const auto& done :
       {write(StabilityPart::kRateEdge, "by_rate.dat", [](Row r) { return 1e-3 / r.cell.c; }),
        write(StabilityPart::kDelayEdge, "by_delay.dat", [](Row r) { return 1e3 * r.cell.d; }),
        write(StabilityPart::kLateEdge, "by_late.dat", [](Row r) { return 100 * r.cell.a; }),
        write(StabilityPart::kSpreadEdge, "by_spread.dat", [](Row r) { return 100 * r.cell.a; }),
        write(StabilityPart::kStepEdge, "by_step.dat", [](Row r) { return 1e6 * r.cell.a; })}) {
    if (!done) return done;
  }
  const auto pair = [](const std::string& file, const char* color, const std::string& title,
                       int block) {
    const std::string blocks = " every :::" + std::to_string(block) + "::" + std::to_string(block);
    return "'data/" + file + "'" + blocks + " using 1:3 with lines lw 2.5 lc rgb '" + color +
           "' title " + report::quote(title) + ", 'data/" + file + "'" + blocks +
           " using 1:2 with points pt 7 ps 1 lc rgb '" + color + "' notitle";
  };
  const std::string y = "largest stiffness [N/m]";
  std::ostringstream c;
  c << report::quiet_style() << "set multiplot\n"
    << heading("Largest stable stiffness of a wall",
               "lines: the laws; dots: the simulated loop; " + setup.arm.name)
    << "set key top right samplen 2 spacing 1.2 font ',15' textcolor rgb '" << report::kInk << "'\n"
    << panel(0.095, 0.475, 0.57, 0.83) << panel_title("Rate: free linear arm, b = 1 N s/m")
    << axis_labels("rate [kHz]", y)
    << "set logscale xy\nset xrange [0.22:9]\nset xtics (0.25, 0.5, 1, 2, 4, 8)\n"
    << "set ytics (100, 300, 1000, 3000, 10000, 30000)\nset yrange [80:40000]\nset key bottom "
       "right\nplot "
    << pair("by_rate.dat", report::kForceInk, "no delay", 0) << ", "
    << pair("by_rate.dat", report::kDepthInk, "one period late", 1)
    << "\nunset label 101\nunset label 102\n"
    << panel(0.575, 0.975, 0.57, 0.83) << panel_title("Delay: the same arm")
    << axis_labels("delay beyond the hold [ms]", "")
    << "unset logscale x\nset xrange [-0.1:5.1]\nset xtics auto\nset ytics (200, 300, 500, 1000, "
       "2000)\nset yrange [150:3000]\n"
    << "set key top right\nplot " << pair("by_delay.dat", report::kForceInk, "", 0) << "\n"
    << panel(0.095, 0.475, 0.11, 0.40) << panel_title("Jitter: the same arm")
    << axis_labels("late ticks, or spread of the period [%]", y)
    << "unset logscale y\nset xrange [-2:92]\nset ytics 500\nset yrange [0:2800]\nplot "
    << pair("by_late.dat", report::kDepthInk, "this share of ticks is 3 periods late", 0) << ", "
    << pair("by_spread.dat", report::kForceInk, "periods spread uniformly by ± this", 0) << "\n"
    << panel(0.575, 0.975, 0.11, 0.40)
    << panel_title("Encoder step: the arm with its dry friction and the hand")
    << axis_labels("encoder step at the tip [µm]", "")
    << "set logscale xy\nset xrange [2.5:360]\nset xtics (3, 10, 30, 100, 300)\n"
    << "set yrange [150:5000]\nset ytics (200, 500, 1000, 2000, 5000)\n"
    << "set label 1 'limit by damping and dry friction' at graph 0.03, graph 0.62 "
       "font ',14' textcolor rgb '"
    << report::kFaintInk
    << "'\nset label 2 '2 c / Δ' at graph 0.86, graph 0.42 font ',14' textcolor rgb '"
    << report::kFaintInk << "'\nplot " << pair("by_step.dat", report::kForceInk, "", 0)
    << "\nunset multiplot\n";
  return report::draw_plot({"stiffness", 1600, 1100, c.str()}, folder);
}

}  // namespace

driver::Result<void> draw_stability(const StabilitySetup& setup,
                                    const std::vector<StabilityRow>& rows,
                                    const std::filesystem::path& folder) {
  if (auto done = draw_kb_map(setup, rows, folder); !done) return done;
  if (auto done = draw_restitution(setup, rows, folder); !done) return done;
  if (auto done = draw_cycles(setup, rows, folder); !done) return done;
  if (auto done = draw_largest(setup, rows, folder); !done) return done;
  return draw_drive_train_walls(setup, rows, folder);
}

}  // namespace thimble::studies
