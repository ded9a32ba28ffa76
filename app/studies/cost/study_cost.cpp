#include "studies/cost/study_cost.h"

#include <fmt/core.h>
#include <malloc.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "log/logger.h"
#include "log/printed_text.h"
#include "log/progress.h"
#include "report/gnuplot.h"
#include "report/picture_style.h"
#include "studies/cost/cost_subjects.h"
#include "studies/cost/instruction_count.h"
#include "studies/cost/memory_trades.h"

namespace thimble::studies {
namespace {

using Eigen::Vector3d;

constexpr int kRounds = 41;           // timed strokes of each subject, alternating with all others
constexpr double kDeepEnough = 2e-4;  // m; below, a relative error is meaningless

struct Cost {
  const CostSubject* subject = nullptr;
  std::unique_ptr<render::ObjectTouch> touch;
  double bytes = 0;                    // on the heap
  std::vector<double> round_ns;        // per tick
  std::optional<double> instructions;  // per tick
  std::vector<Vector3d> forces;        // N
  double error = 0;  // contact: RMS of the relative error; effect: RMS of the added force, N
  double direction_p99 = 0;  // contact: rad

  double median_ns() const {
    std::vector<double> sorted = round_ns;
    std::sort(sorted.begin(), sorted.end());
    return sorted[sorted.size() / 2];
  }
};

// Returns the heap's bytes in use, including large blocks.
double heap_bytes() {
  const struct mallinfo2 info = mallinfo2();
  return static_cast<double>(info.uordblks + info.hblkhd);
}

void stroke(Cost& cost, const std::vector<driver::DeviceState>& states) {
  using SteadyClock = std::chrono::steady_clock;
  const auto begin = SteadyClock::now();
  for (std::size_t i = 0; i < states.size(); ++i) {
    cost.forces[i] = cost.touch->update(states[i]).f_T_W;
  }
  const std::chrono::duration<double, std::nano> time = SteadyClock::now() - begin;
  cost.round_ns.push_back(time.count() / static_cast<double>(states.size()));
}

// Compares a contact method with the exact ring.
void compare_with_truth(Cost& cost, const std::vector<driver::DeviceState>& states) {
  std::vector<double> angles;
  double squares = 0;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const double depth = kCostRing.depth(states[i].p_WT);
    if (depth < kDeepEnough) continue;
    const Vector3d n = kCostRing.normal(states[i].p_WT);
    const Vector3d truth =
        std::max(kCostSpring.stiffness * depth - kCostSpring.damping * n.dot(states[i].v_WT), 0.0) *
        n;
    const Vector3d& felt = cost.forces[i];
    squares += (felt - truth).squaredNorm() / truth.squaredNorm();
    angles.push_back(felt.norm() > 0 ? std::acos(std::clamp(felt.normalized().dot(n), -1.0, 1.0))
                                     : 0.0);
  }
  std::sort(angles.begin(), angles.end());
  cost.error = std::sqrt(squares / static_cast<double>(angles.size()));
  cost.direction_p99 = angles[angles.size() * 99 / 100];
}

// Compares an effect with the scene without it.
void compare_with_bare(Cost& cost, const Cost& bare) {
  double squares = 0;
  std::size_t ticks = 0;
  for (std::size_t i = 0; i < bare.forces.size(); ++i) {
    if (!(bare.forces[i].norm() > 0)) continue;
    squares += (cost.forces[i] - bare.forces[i]).squaredNorm();
    ++ticks;
  }
  cost.error = std::sqrt(squares / static_cast<double>(ticks));
}

std::string csv_of(const std::vector<Cost>& costs, const Cost& bare) {
  std::ostringstream csv;
  csv << "subject,kind,ns_per_tick,ns_added,instructions_per_tick,instructions_added,bytes,"
         "force_error_percent,direction_p99_degrees,force_left_out_N\n";
  for (const Cost& cost : costs) {
    const bool contact = cost.subject->kind == CostSubject::Kind::kContact;
    csv << cost.subject->name << ',' << (contact ? "contact" : "effect") << ',' << cost.median_ns()
        << ',';
    if (!contact) csv << cost.median_ns() - bare.median_ns();
    csv << ',';
    if (cost.instructions) csv << *cost.instructions;
    csv << ',';
    if (!contact && cost.instructions) csv << *cost.instructions - *bare.instructions;
    csv << ',' << cost.bytes << ',';
    if (contact) csv << 100 * cost.error << ',' << cost.direction_p99 * 180 / M_PI << ",\n";
    if (!contact) csv << ",," << cost.error << '\n';
  }
  return csv.str();
}

struct Bar {
  std::string name;
  double ns = 0;
  std::string says;
};

// Returns a plot of bars below each other, each with its name on the left and a short text at its
// end.
report::Plot bar_plot(const std::string& name, const std::string& title, const std::string& axis,
                      const std::vector<Bar>& bars) {
  std::ostringstream text;
  double max = 1;
  text << report::quiet_style() << "$bars << EOD\n";
  for (std::size_t i = 0; i < bars.size(); ++i) {
    max = std::max(max, bars[i].ns);
    text << i << ' ' << report::number(std::max(bars[i].ns, 0.0)) << " \"" << bars[i].name
         << "\" \"" << bars[i].says << "\"\n";
  }
  const int height = 170 + 44 * static_cast<int>(bars.size());
  text << "EOD\nset title " << report::quote(title) << "\nset xlabel " << report::quote(axis)
       << '\n'
       << "set key off\nset style fill solid 0.85 noborder\nunset grid\nset grid xtics\n"
       << "set yrange [" << report::number(static_cast<double>(bars.size()) - 0.4) << ":-0.6]\n"
       << "set xrange [0:" << report::number(1.75 * max) << "]\nset ytics scale 0 noenhanced\n"
       << "plot $bars using (0):1:(0):2:($1-0.28):($1+0.28):ytic(3) with boxxyerror lc rgb '"
       << report::kForceInk
       << "', $bars using 2:1:4 with labels left offset 0.8,0 noenhanced tc rgb '" << report::kInk
       << "'\n";
  return {.name = name, .width = 1500, .height = height, .commands = text.str()};
}

std::string rounded(double value, int digits) {
  return fmt::format("{:.{}f}", value, digits);
}

driver::Result<void> draw(const std::vector<Cost>& costs, const Cost& bare,
                          const std::filesystem::path& folder) {
  std::vector<Bar> ways, effects;
  for (const Cost& cost : costs) {
    if (cost.subject == bare.subject) continue;
    const double ns = cost.median_ns();
    if (cost.subject->kind == CostSubject::Kind::kContact) {
      ways.push_back({cost.subject->name, ns,
                      rounded(ns, 0).append(" ns,  force error ") +
                          rounded(100 * cost.error, cost.error < 0.02 ? 2 : 1).append(" %")});
    } else {
      const double added = ns - bare.median_ns();
      effects.push_back(
          {cost.subject->name, added,
           rounded(added, 0).append(" ns for ") + rounded(1000 * cost.error, 0).append(" mN")});
    }
  }
  const report::Plot plots[] = {
      bar_plot("cost_of_contact",
               "Cost of a tick on a ring of 4,096 triangles, and its force error (RMS)",
               "ns per tick", ways),
      bar_plot("cost_of_effects",
               "Cost that each effect adds to a tick, and the force missing without it (RMS)",
               "ns added per tick", effects)};
  for (const report::Plot& plot : plots) {
    if (auto drawn = report::draw_plot(plot, folder); !drawn) return drawn.error();
  }
  return {};
}

std::vector<session::Figure> figures_of(const std::vector<Cost>& costs, const Cost& bare) {
  std::vector<session::Figure> figures;
  const auto add = [&](const std::string& name, double value, const std::string& unit,
                       const std::string& goal = {}) {
    figures.push_back({.name = name, .value = value, .unit = unit, .goal = goal});
  };
  for (const Cost& cost : costs) {
    const std::string& name = cost.subject->name;
    if (cost.subject->kind == CostSubject::Kind::kContact) {
      add(name + ": time", cost.median_ns(), "ns/tick");
      if (cost.instructions) add(name + ": instructions", *cost.instructions, "per tick");
      add(name + ": memory", cost.bytes / (2 * kCostAround * kCostAcross), "B/triangle");
      add(name + ": force error", 100 * cost.error, "%");
    } else {
      add(name + ": time added", cost.median_ns() - bare.median_ns(), "ns/tick");
      if (cost.instructions) {
        add(name + ": instructions added", *cost.instructions - *bare.instructions, "per tick");
      }
      add(name + ": force missing without", cost.error, "N");
    }
  }
  for (const MemoryTrade& trade : measure_memory_trades()) {
    add(trade.name + ": time", trade.ns_per_question, "ns/question");
    add(trade.name + ": memory", trade.bytes_per_triangle, "B/triangle");
    add(trade.name + ": build", trade.build_us_per_triangle, "us/triangle");
  }
  return figures;
}

// Share of the time that the strokes take; the rest is counting [chosen].
constexpr double kStrokesShare = 0.2;

/// Counts the instructions of all subjects, if valgrind is installed.
void count_all(std::vector<Cost>& costs, scene::Progress& progress) {
  std::size_t done = 0;
  for (Cost& cost : costs) {
    cost.instructions = instructions_per_tick(cost.subject->name);
    progress.set_share(kStrokesShare + (1 - kStrokesShare) * static_cast<double>(++done) /
                                           static_cast<double>(costs.size()));
    if (cost.instructions) continue;
    scene::logger().warn("Instructions are not counted: valgrind is not installed, or it failed.");
    return;
  }
}

}  // namespace

driver::Result<std::vector<session::Figure>> study_cost(const std::filesystem::path& folder) {
  const std::vector<CostSubject> subjects = cost_subjects();
  const auto states = ring_stroke(kCostRing, kStrokeTicks, 0.001);
  std::vector<Cost> costs;
  for (const CostSubject& subject : subjects) {
    Cost cost;
    cost.subject = &subject;
    const double before = heap_bytes();
    auto touch = subject.build();
    if (!touch) return driver::Error{subject.name + ": " + touch.error().message};
    cost.touch = std::move(touch).value();
    cost.bytes = heap_bytes() - before;
    cost.forces.resize(states.size());
    costs.push_back(std::move(cost));
  }
  // Subjects alternate, so that other load of the machine affects all equally.
  scene::Progress progress("study cost");
  for (int round = 0; round < kRounds; ++round) {
    for (Cost& cost : costs) stroke(cost, states);
    progress.set_share(kStrokesShare * (round + 1) / kRounds);
  }
  count_all(costs, progress);
  progress.set_share(1.0);
  const Cost& bare = *std::find_if(costs.begin(), costs.end(), [](const Cost& cost) {
    return cost.subject->name == kBareSubject;
  });
  for (Cost& cost : costs) {
    if (cost.subject->kind == CostSubject::Kind::kContact) {
      compare_with_truth(cost, states);
    } else {
      compare_with_bare(cost, bare);
    }
  }
  if (auto written = report::write_text(csv_of(costs, bare), folder / "cost.csv"); !written) {
    return written.error();
  }
  if (report::has_gnuplot()) {
    if (auto made = report::make_picture_folder(folder); !made) return made.error();
    if (auto drawn = draw(costs, bare, folder); !drawn) return drawn.error();
  }
  return figures_of(costs, bare);
}

}  // namespace thimble::studies
