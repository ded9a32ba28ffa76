#include "thimble/session/run_figures.h"

#include <fmt/format.h>

#include <cmath>

#include "thimble/driver/fault.h"
#include "thimble/driver/heat_guard.h"
#include "wall_side.h"

namespace thimble::session {
namespace {

double microseconds(double ns) {
  return ns * 1e-3;
}

std::string goal(const char* comparison, double bound) {
  return fmt::format("{} {:g}", comparison, bound);
}

}  // namespace

std::vector<Figure> figures_of(const RunFigures& report) {
  const RunStatistics& run = report.statistics;
  std::vector<Figure> figures{
      {"ticks", static_cast<double>(run.ticks()), "", ""},
      {"rate", run.rate(), "Hz", goal(">=", 0.999 * report.rate_asked)},
      {"period_p99_9", microseconds(run.period().percentile(0.999)), "us", ""},
      {"period_max", microseconds(static_cast<double>(run.period().max_ns())), "us", ""},
      {"touch_downs", static_cast<double>(run.contacts()), "", ""},
      {"lost_contacts", static_cast<double>(report.lost_contacts), "", "== 0"},
      {"force_max", run.force_max(), "N", goal("<=", report.force_limit)},
      {"force_rms", run.force_rms(), "N", ""},
      {"depth_max", 1e3 * run.depth_max(), "mm", ""},
      {"energy_to_hand", 1e3 * run.energy_to_hand(), "mJ", ""},
      {"reports_missing", static_cast<double>(report.wire.missing), "", ""},
      {"fault_ticks", static_cast<double>(run.fault_ticks()), "", "== 0"},
      {"current_at_exit", report.current_at_exit, "A", "== 0"},
  };
  if (report.paging) {
    figures.push_back({"page_misses", static_cast<double>(report.paging->misses), "", "== 0"});
    figures.push_back({"pages_damaged", static_cast<double>(report.paging->failures), "", "== 0"});
  }
  if (!report.virtual_time) {
    figures.push_back({"tick_time_p50", microseconds(run.work().percentile(0.5)), "us", ""});
    figures.push_back({"tick_time_p99_9", microseconds(run.work().percentile(0.999)), "us", ""});
  }
  return figures;
}

std::string summary(const RunFigures& report) {
  const RunStatistics& run = report.statistics;
  const double period_us = report.rate_asked > 0 ? 1e6 / report.rate_asked : 0;
  std::string s;
  s += fmt::format(
      "The {} hand reached for {} for {:.1f} s with the {} {} and touched it {} time{},\n",
      report.simulated_arm ? "simulated" : "user's", report.object, run.duration(),
      report.simulated_arm ? "simulated arm" : "arm", report.arm, run.contacts(),
      run.contacts() == 1 ? "" : "s");
  s += fmt::format("{:.1f} s in all. ", run.contact_time());
  s += report.lost_contacts == 0
           ? "No contact was lost on the way.\n"
           : fmt::format("{} time{} the tip was inside without a force: a lost contact.\n",
                         report.lost_contacts, report.lost_contacts == 1 ? "" : "s");
  if (!report.inside_at_start.empty()) {
    s += fmt::format("Start     the tip was inside {}, so no surface was felt there at first.\n",
                     fmt::join(report.inside_at_start, ", "));
  }
  s +=
      fmt::format("Force     {:.2f} N at most (limit {:.2f} N), {:.2f} N on average (rms) {}.\n",
                  run.force_max(), report.force_limit,
                  run.contacts() > 0 ? run.force_rms() : run.force_rms_of_run(),
                  run.contacts() > 0 ? "while touching" : "over the run, which touched no surface");
  s += report.triangles == 0
           ? fmt::format("Depth     {:.2f} mm at most; no triangles, all shapes are exact.\n",
                         1e3 * run.depth_max())
           : fmt::format(
                 "Depth     {:.2f} mm at most; {} triangle{} crossed in one tick at most, of {}.\n",
                 1e3 * run.depth_max(), unsigned{run.hops_max()}, run.hops_max() == 1 ? "" : "s",
                 report.triangles);
  const double energy = 1e3 * run.energy_to_hand();
  s += fmt::format(
      "Energy    the arm {} {:.2f} mJ in all{}\n", energy > 0 ? "gave the hand" : "took",
      std::abs(energy),
      energy > 0 ? ": more than it took." : " from the hand, as a passive surface does.");
  s += fmt::format(
      "Loop      {} ticks, {:.1f} of {:.1f} per second asked; {}.\n", run.ticks(), run.rate(),
      report.rate_asked,
      report.virtual_time
          ? "in virtual time, so every run is the same"
          : fmt::format("a tick came {:.0f} us after the last at most, {:.0f} us wanted",
                        microseconds(static_cast<double>(run.period().max_ns())), period_us));
  s +=
      report.virtual_time
          ? std::string("Tick      not timed: on the virtual clock no time passes within a tick.\n")
          : fmt::format(
                "Tick      {:.1f} us of work in half of the ticks, {:.1f} us in 999 of 1000; there "
                "is time for {:.0f} us.\n",
                microseconds(run.work().percentile(0.5)),
                microseconds(run.work().percentile(0.999)), period_us);
  if (report.paging) {
    s += fmt::format(
        "Pages     {} read from the disk, {} given up, {} damaged; one was missing in {} "
        "ticks{}.\n",
        report.paging->loads, report.paging->evictions, report.paging->failures,
        report.paging->misses, report.paging->misses > 0 ? ", and the last plane was held" : "");
  }
  s += fmt::format("Wire      {} reports, {} not understood, {} ticks without a new one.\n",
                   report.wire.reports, report.wire.rejected, report.wire.missing);
  s += fmt::format(
      "Safety    force cut to the limit in {} ticks, rise held back in {}, soft start in {}.\n",
      report.gate.limited, report.gate.rise_limited, report.gate.soft_started);
  if (report.carried_weight > 0) {
    s += fmt::format(
        "Gravity   the motors carried {}{:.3g} N of the arm beside the scene's forces.\n",
        report.carried_by_pose ? "up to " : "", report.carried_weight);
  }
  if (report.carry_withdrawn > 0) {
    s += fmt::format(
        "Gravity   compensation is not trusted: it was switched off {} time{} because the tip "
        "moved along its force. If no hand moved it, correct gravity_compensation of the arm "
        "file: see `thimble identify`.\n",
        report.carry_withdrawn, report.carry_withdrawn == 1 ? "" : "s");
  }
  if (report.walls.pushed > 0) {
    s += fmt::format(
        "Walls     the tip left the workspace of the arm file: walls pushed in {} ticks, with "
        "{:.2f} N at most ({} wall).\n",
        report.walls.pushed, report.walls.f_strongest_W.norm(),
        wall_side(report.walls.f_strongest_W));
  }
  if (report.energy_stage == driver::EnergyStage::kPassivity) {
    s += fmt::format(
        "Gate      energy watched: {:.2f} mJ given at most beyond what it took; damped in {} "
        "ticks.\n",
        0 - 1e3 * report.gate.energy_least, report.gate.damped);  // no -0.00
  } else if (report.energy_stage == driver::EnergyStage::kBounding) {
    s += fmt::format("Gate      energy bounded: force cut in {} ticks.\n", report.gate.bounded);
  }
  if (report.gate.power_limited > 0) {
    s += fmt::format(
        "Power     {:.2f} W given to the hand on average at most; force lowered in {} ticks "
        "(power_max of the arm file).\n",
        report.gate.power_max, report.gate.power_limited);
  }
  if (report.gate.oscillations > 0) {
    s += fmt::format(
        "Program   its force oscillated and grew {} time{}, at {:.0f} Hz at last: it was lowered "
        "in {} ticks. Its spring or damper is too stiff for this arm and loop.\n",
        report.gate.oscillations, report.gate.oscillations == 1 ? "" : "s",
        report.gate.oscillation_frequency, report.gate.calmed);
  }
  if (report.heat_known && report.heat_most >= driver::HeatGuard::kWarning) {
    s +=
        fmt::format("Heat      a motor reached {:.0f} % of its limit; force lowered in {} ticks.\n",
                    100 * report.heat_most, report.heat_lowered);
  }
  if (report.gate.stalls > 0) {
    s += fmt::format(
        "Stalls    the loop stood still {} time{}; the force came back within {:.0f} ms.\n",
        report.gate.stalls, report.gate.stalls == 1 ? "" : "s", 1e3 * report.reopen);
  }
  if (report.feel_check == scene::FeelCheckState::kUnchecked) {
    s += "Arm       UNCHECKED: it had its whole force without a passed feel check.\n";
  } else if (report.feel_check == scene::FeelCheckState::kNone) {
    s += fmt::format("Arm       without a passed feel check; its force was at most {:.2f} N.\n",
                     report.force_limit);
  }
  const std::string left = report.zero_assured ? "the arm was left with zero force.\n"
                                               : "the arm did not take the last zero force.\n";
  switch (report.end) {
    case driver::ServoEnd::kDone:
      s += "End       the scene was over; " + left;
      break;
    case driver::ServoEnd::kStopped:
      s += "End       it was stopped early; " + left;
      break;
    case driver::ServoEnd::kFault:
      s += "End       the force went off: " + std::string(driver::describe(report.fault)) + "\n";
      break;
  }
  // A loop with a real arm outlives its faults.
  if (report.end != driver::ServoEnd::kFault && report.fault != driver::Fault::kNone) {
    s += "Fault     the force was off at the end: " + std::string(driver::describe(report.fault)) +
         "\n";
  }
  if (report.link != driver::LinkState::kConnected) {
    s += std::string("Link      the arm was ") +
         (report.link == driver::LinkState::kLost ? "gone from the wire" : "silent") +
         " at the end.\n";
  }
  if (!report.zero_assured) {
    s += "DANGER    A force may still stand at the arm: its own watchdog must switch the motors "
         "off. "
         "See that nothing pulls any more, and switch it off.\n";
  }
  if (!report.virtual_time && !report.real_time.advice.empty()) {
    s += "Advice    " + report.real_time.advice + "\n";
  }
  return s;
}

}  // namespace thimble::session
