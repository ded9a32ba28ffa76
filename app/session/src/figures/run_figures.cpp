#include "thimble/session/run_figures.h"

#include <fmt/format.h>

#include <cmath>

#include "text/counted.h"
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
      {"rate", run.rate(), "Hz", goal(">=", 0.999 * report.requested_rate)},
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
  const double period_us = report.requested_rate > 0 ? 1e6 / report.requested_rate : 0;
  std::string s;
  s += fmt::format("The {} hand explored {} for {:.1f} s with the {} {}: {} contact{},\n",
                   report.simulated_arm ? "simulated" : "user's", report.object, run.duration(),
                   report.simulated_arm ? "simulated arm" : "arm", report.arm, run.contacts(),
                   run.contacts() == 1 ? "" : "s");
  s += fmt::format("{:.1f} s in total. ", run.contact_time());
  s += report.lost_contacts == 0
           ? "No contact was lost.\n"
           : fmt::format("The tip was inside without a force {} time{}: lost contacts.\n",
                         report.lost_contacts, report.lost_contacts == 1 ? "" : "s");
  if (!report.inside_at_start.empty()) {
    s += fmt::format(
        "Start     the tip started inside {}; its surface is felt once the tip has been outside.\n",
        fmt::join(report.inside_at_start, ", "));
  }
  s += fmt::format("Force     {:.2f} N maximum (limit {:.2f} N), {:.2f} N RMS {}.\n",
                   run.force_max(), report.force_limit,
                   run.contacts() > 0 ? run.force_rms() : run.force_rms_of_run(),
                   run.contacts() > 0 ? "in contact" : "over the run, which had no contact");
  s += report.triangles == 0
           ? fmt::format("Depth     {:.2f} mm maximum; no triangles, all shapes are exact.\n",
                         1e3 * run.depth_max())
           : fmt::format(
                 "Depth     {:.2f} mm maximum; at most {} triangle{} crossed per tick, of {}.\n",
                 1e3 * run.depth_max(), unsigned{run.hops_max()}, run.hops_max() == 1 ? "" : "s",
                 report.triangles);
  const double energy = 1e3 * run.energy_to_hand();
  s += fmt::format("Energy    the arm {} {:.2f} mJ net{}\n", energy > 0 ? "gave the hand" : "took",
                   std::abs(energy),
                   energy > 0 ? "." : " from the hand, as a passive surface does.");
  s += fmt::format(
      "Loop      {}, {:.1f} of the requested {:.1f} per second; {}.\n",
      scene::counted(run.ticks(), "tick"), run.rate(), report.requested_rate,
      report.virtual_time
          ? "virtual time, bit-identical in every run"
          : fmt::format("longest period {:.0f} us, requested {:.0f} us",
                        microseconds(static_cast<double>(run.period().max_ns())), period_us));
  s += report.virtual_time
           ? std::string("Tick      not timed: in virtual time a tick takes no time.\n")
           : fmt::format(
                 "Tick      {:.1f} us of work (median), {:.1f} us (99.9 %); the period is {:.0f} "
                 "us.\n",
                 microseconds(run.work().percentile(0.5)),
                 microseconds(run.work().percentile(0.999)), period_us);
  if (report.paging) {
    s += fmt::format(
        "Pages     {} read from disk, {} evicted, {} damaged; a page was missing in {}{}.\n",
        report.paging->loads, report.paging->evictions, report.paging->failures,
        scene::counted(report.paging->misses, "tick"),
        report.paging->misses > 0 ? ", and the last plane was kept" : "");
  }
  s += fmt::format("Wire      {}, {} invalid, {} without a new report.\n",
                   scene::counted(report.wire.reports, "report"), report.wire.rejected,
                   scene::counted(report.wire.missing, "tick"));
  s += fmt::format("Safety    force limited in {}, rise limited in {}, soft start in {}.\n",
                   scene::counted(report.gate.limited, "tick"), report.gate.rise_limited,
                   report.gate.soft_started);
  if (report.carried_weight > 0) {
    s += fmt::format("Gravity   the motors also carried {}{:.3g} N of the arm's weight.\n",
                     report.carried_by_pose ? "up to " : "", report.carried_weight);
  }
  if (report.carry_withdrawn > 0) {
    s += fmt::format(
        "Gravity   compensation is not trusted: it was switched off {} time{} because the tip "
        "moved along its force. If no hand moved it, correct gravity_compensation in the arm file: "
        "see `thimble identify`.\n",
        report.carry_withdrawn, report.carry_withdrawn == 1 ? "" : "s");
  }
  if (report.walls.pushed > 0) {
    s += fmt::format(
        "Walls     the tip left the workspace: walls pushed in {}, with at most {:.2f} N ({} "
        "wall).\n",
        scene::counted(report.walls.pushed, "tick"), report.walls.f_strongest_W.norm(),
        wall_side(report.walls.f_strongest_W));
  }
  if (report.motors < 3) {
    const Eigen::Vector3d& f_W = report.missing_force.f_strongest_W;
    s += fmt::format(
        "Axes      the arm has {}: its tip stays {}. In {} a part of the force could not be given, "
        "at most {:.2f} N ({:.2f}, {:.2f}, {:.2f}).\n",
        scene::counted(static_cast<std::uint64_t>(report.motors), "motor"),
        report.motors == 1 ? "on a line" : "in a plane",
        scene::counted(report.missing_force.ticks, "tick"), f_W.norm(), f_W.x(), f_W.y(), f_W.z());
  }
  if (report.energy_stage == driver::EnergyStage::kPassivity) {
    s += fmt::format(
        "Gate      passivity: at most {:.2f} mJ given beyond the energy taken; damping in {}.\n",
        0 - 1e3 * report.gate.min_energy,
        scene::counted(report.gate.damped, "tick"));  // avoids -0.00
  } else if (report.energy_stage == driver::EnergyStage::kBounding) {
    s += fmt::format("Gate      energy bound: force limited in {}.\n",
                     scene::counted(report.gate.bounded, "tick"));
  }
  if (report.gate.power_limited > 0) {
    s += fmt::format(
        "Power     {:.2f} W maximum mean power; force reduced in {} (power_max in the arm "
        "file).\n",
        report.gate.power_max, scene::counted(report.gate.power_limited, "tick"));
  }
  if (report.gate.oscillations > 0) {
    s += fmt::format(
        "Program   its force oscillated and grew {} time{}, last at {:.0f} Hz: it was reduced in "
        "{}. Its spring or damper is too stiff for this arm and loop.\n",
        report.gate.oscillations, report.gate.oscillations == 1 ? "" : "s",
        report.gate.oscillation_frequency, scene::counted(report.gate.calmed, "tick"));
  }
  if (report.heat_known && report.max_heat >= driver::HeatGuard::kWarning) {
    s += fmt::format("Heat      a motor reached {:.0f} % of its limit; force reduced in {}.\n",
                     100 * report.max_heat, scene::counted(report.heat_lowered, "tick"));
  }
  if (report.gate.stalls > 0) {
    s += fmt::format(
        "Stalls    the loop was blocked {} time{}; the force returned within {:.0f} ms.\n",
        report.gate.stalls, report.gate.stalls == 1 ? "" : "s", 1e3 * report.reopen);
  }
  if (report.feel_check == scene::FeelCheckState::kUnchecked) {
    s += "Arm       UNCHECKED: full force without a passed feel check.\n";
  } else if (report.feel_check == scene::FeelCheckState::kNone) {
    s += fmt::format("Arm       no passed feel check; its force was limited to {:.2f} N.\n",
                     report.force_limit);
  }
  const std::string left = report.zero_assured ? "the arm accepted zero force.\n"
                                               : "the arm did not accept the last zero force.\n";
  switch (report.end) {
    case driver::ServoEnd::kDone:
      s += "End       the scene ended; " + left;
      break;
    case driver::ServoEnd::kStopped:
      s += "End       stopped early; " + left;
      break;
    case driver::ServoEnd::kFault:
      s += "End       the force was switched off: " + std::string(driver::describe(report.fault)) +
           "\n";
      break;
  }
  // With a real arm the loop continues after a fault.
  if (report.end != driver::ServoEnd::kFault && report.fault != driver::Fault::kNone) {
    s += "Fault     the force was off at the end: " + std::string(driver::describe(report.fault)) +
         "\n";
  }
  if (report.link != driver::LinkState::kConnected) {
    s += std::string("Link      the arm was ") +
         (report.link == driver::LinkState::kLost ? "disconnected" : "silent") + " at the end.\n";
  }
  if (!report.zero_assured) {
    s += "DANGER    The arm may still apply a force: its watchdog must switch the motors off. "
         "Check that nothing pulls, then switch the arm off.\n";
  }
  if (!report.virtual_time && !report.real_time.advice.empty()) {
    s += "Advice    " + report.real_time.advice + "\n";
  }
  return s;
}

}  // namespace thimble::session
