#include "report/report.h"

#include <cstdio>
#include <nlohmann/json.hpp>
#include <string_view>
#include <system_error>

#include "printed.h"
#include "thimble/driver/heat_guard.h"
#include "thimble/scene/build_info.h"

namespace thimble::app {
namespace {

using Json = nlohmann::ordered_json;

std::string_view end_name(driver::ServoEnd end) {
  switch (end) {
    case driver::ServoEnd::kDone:
      return "done";
    case driver::ServoEnd::kStopped:
      return "stopped";
    case driver::ServoEnd::kFault:
      return "fault";
  }
  return "unknown";
}

double microseconds(double ns) {
  return ns * 1e-3;
}

Json to_json(const session::Histogram& histogram) {
  return {{"unit", "us"},
          {"count", histogram.count()},
          {"min", microseconds(static_cast<double>(histogram.min_ns()))},
          {"mean", microseconds(histogram.mean_ns())},
          {"p50", microseconds(histogram.percentile(0.5))},
          {"p99", microseconds(histogram.percentile(0.99))},
          {"p99_9", microseconds(histogram.percentile(0.999))},
          {"max", microseconds(static_cast<double>(histogram.max_ns()))}};
}

Json to_json(const session::RunFigures& report) {
  const scene::BuildInfo build = scene::build_info();
  const session::RunStatistics& run = report.statistics;
  Json json;
  json["scene"] = report.scene;
  json["object"] = report.object;
  json["triangles"] = report.triangles;
  json["arm"] = {{"name", report.arm}, {"simulated", report.simulated_arm}};
  if (!report.simulated_arm) json["arm"]["feel_check"] = scene::name(report.feel_check);
  json["build"] = {{"version", build.version},
                   {"compiler", build.compiler},
                   {"type", build.type},
                   {"revision", build.revision}};
  json["seed"] = report.seed;
  json["clock"] = report.virtual_time ? "virtual" : "wall";
  json["ticks"] = run.ticks();
  json["duration_s"] = run.duration();
  json["rate_Hz"] = {{"asked", report.rate_asked}, {"reached", run.rate()}};
  json["period"] = to_json(run.period());
  json["lateness"] = to_json(run.lateness());
  // On the virtual clock no time passes within a tick.
  if (!report.virtual_time) json["tick_time"] = to_json(run.work());
  json["contact"] = {{"touch_downs", run.contacts()},        {"lost", report.lost_contacts},
                     {"interruptions", run.interruptions()}, {"time_s", run.contact_time()},
                     {"depth_max_m", run.depth_max()},       {"hops_max", run.hops_max()}};
  json["force_N"] = {
      {"max", run.force_max()}, {"rms_in_contact", run.force_rms()}, {"limit", report.force_limit}};
  json["energy_to_hand_J"] = {{"total", run.energy_to_hand()}, {"max", run.energy_to_hand_max()}};
  if (report.paging) {
    json["paging"] = {{"pages_read", report.paging->loads},
                      {"pages_given_up", report.paging->evictions},
                      {"pages_damaged", report.paging->failures},
                      {"ticks_missing_a_page", report.paging->misses},
                      {"short_of_room", report.paging->short_of_frames}};
  }
  json["wire"] = {
      {"reports", report.wire.reports}, {"rejected", report.wire.rejected},
      {"skipped", report.wire.skipped}, {"repeated", report.wire.repeated},
      {"missing", report.wire.missing}, {"ticks_without_report", run.missing_reports()}};
  json["gate"] = {{"limited", report.gate.limited},
                  {"rise_limited", report.gate.rise_limited},
                  {"soft_started", report.gate.soft_started},
                  {"stalls", report.gate.stalls},
                  {"damped", report.gate.damped},
                  {"bounded", report.gate.bounded},
                  {"energy_least_J", report.gate.energy_least}};
  if (report.heat_known) {
    json["heat"] = {{"motors", report.heat},
                    {"most", report.heat_most},
                    {"ticks_lowered", report.heat_lowered}};
  }
  json["real_time"] = {{"fifo", report.real_time.fifo},
                       {"memory_locked", report.real_time.memory_locked},
                       {"cpu_awake", report.real_time.cpu_awake},
                       {"advice", report.real_time.advice}};
  json["end"] = {{"reason", end_name(report.end)},
                 {"fault", driver::name(report.fault)},
                 {"zero_assured", report.zero_assured},
                 {"motor_current_A", report.current_at_exit}};
  json["trace"] = {{"every", report.trace_stride}, {"dropped", report.trace_dropped}};
  return json;
}

std::string goal(const char* comparison, double bound) {
  return scene::printed("%s %g", comparison, bound);
}

}  // namespace

std::vector<Figure> figures_of(const session::RunFigures& report) {
  const session::RunStatistics& run = report.statistics;
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

std::string summary(const session::RunFigures& report) {
  const session::RunStatistics& run = report.statistics;
  const double period_us = report.rate_asked > 0 ? 1e6 / report.rate_asked : 0;
  std::string s;
  s += scene::printed(
      "The %s hand reached for %s for %.1f s with the %s %s and touched it %llu time%s,\n",
      report.simulated_arm ? "simulated" : "user's", report.object.c_str(), run.duration(),
      report.simulated_arm ? "simulated arm" : "arm", report.arm.c_str(),
      static_cast<unsigned long long>(run.contacts()), run.contacts() == 1 ? "" : "s");
  s += scene::printed("%.1f s in all. ", run.contact_time());
  s += report.lost_contacts == 0
           ? "No contact was lost on the way.\n"
           : scene::printed("%llu time%s the tip was inside without a force: a lost contact.\n",
                            static_cast<unsigned long long>(report.lost_contacts),
                            report.lost_contacts == 1 ? "" : "s");
  s += scene::printed(
      "Force     %.2f N at most (limit %.2f N), %.2f N on average (rms) while touching.\n",
      run.force_max(), report.force_limit, run.force_rms());
  s += report.triangles == 0
           ? scene::printed("Depth     %.2f mm at most; no triangles, all shapes are exact.\n",
                            1e3 * run.depth_max())
           : scene::printed(
                 "Depth     %.2f mm at most; %u triangle%s crossed in one tick at most, of %zu.\n",
                 1e3 * run.depth_max(), unsigned{run.hops_max()}, run.hops_max() == 1 ? "" : "s",
                 report.triangles);
  const double energy = 1e3 * run.energy_to_hand();
  s += scene::printed(
      "Energy    the arm %s %.2f mJ in all%s\n", energy > 0 ? "gave the hand" : "took",
      energy > 0 ? energy : -energy,
      energy > 0 ? ": more than it took." : " from the hand, as a passive surface does.");
  s += scene::printed(
      "Loop      %llu ticks, %.1f of %.1f per second asked; %s.\n",
      static_cast<unsigned long long>(run.ticks()), run.rate(), report.rate_asked,
      report.virtual_time
          ? "in virtual time, so every run is the same"
          : scene::printed("a tick came %.0f us after the last at most, %.0f us wanted",
                           microseconds(static_cast<double>(run.period().max_ns())), period_us)
                .c_str());
  s +=
      report.virtual_time
          ? std::string("Tick      not timed: on the virtual clock no time passes within a tick.\n")
          : scene::printed(
                "Tick      %.1f us of work in half of the ticks, %.1f us in 999 of 1000; there is "
                "time for "
                "%.0f us.\n",
                microseconds(run.work().percentile(0.5)),
                microseconds(run.work().percentile(0.999)), period_us);
  if (report.paging) {
    s += scene::printed(
        "Pages     %llu read from the disk, %llu given up, %llu damaged; one was missing in "
        "%llu ticks%s.\n",
        static_cast<unsigned long long>(report.paging->loads),
        static_cast<unsigned long long>(report.paging->evictions),
        static_cast<unsigned long long>(report.paging->failures),
        static_cast<unsigned long long>(report.paging->misses),
        report.paging->misses > 0 ? ", and the last plane was held" : "");
  }
  s +=
      scene::printed("Wire      %llu reports, %llu not understood, %llu ticks without a new one.\n",
                     static_cast<unsigned long long>(report.wire.reports),
                     static_cast<unsigned long long>(report.wire.rejected),
                     static_cast<unsigned long long>(report.wire.missing));
  s += scene::printed(
      "Safety    force cut to the limit in %llu ticks, rise held back in %llu, soft start in "
      "%llu.\n",
      static_cast<unsigned long long>(report.gate.limited),
      static_cast<unsigned long long>(report.gate.rise_limited),
      static_cast<unsigned long long>(report.gate.soft_started));
  if (report.energy_stage == driver::EnergyStage::kPassivity) {
    s += scene::printed(
        "Energy    watched by the gate: %.2f mJ given at most beyond what it took; damped in "
        "%llu ticks.\n",
        -1e3 * report.gate.energy_least, static_cast<unsigned long long>(report.gate.damped));
  } else if (report.energy_stage == driver::EnergyStage::kBounding) {
    s += scene::printed("Energy    bounded by the gate: force cut in %llu ticks.\n",
                        static_cast<unsigned long long>(report.gate.bounded));
  }
  if (report.heat_known && report.heat_most >= driver::HeatGuard::kWarning) {
    s += scene::printed(
        "Heat      a motor reached %.0f %% of its limit; force lowered in %llu ticks.\n",
        100 * report.heat_most, static_cast<unsigned long long>(report.heat_lowered));
  }
  if (report.gate.stalls > 0) {
    s += scene::printed(
        "Stalls    the loop stood still %llu time%s; the force came back within %.0f ms.\n",
        static_cast<unsigned long long>(report.gate.stalls), report.gate.stalls == 1 ? "" : "s",
        1e3 * report.reopen);
  }
  if (report.feel_check == scene::FeelCheckState::kUnchecked) {
    s += "Arm       UNCHECKED: it had its whole force without a passed feel check.\n";
  } else if (report.feel_check == scene::FeelCheckState::kNone) {
    s += scene::printed("Arm       without a passed feel check; its force was at most %.2f N.\n",
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

driver::Result<void> write_report(const session::RunFigures& report,
                                  const std::filesystem::path& folder) {
  std::error_code status;
  std::filesystem::create_directories(folder, status);
  if (status) {
    return driver::Error{"Cannot make the folder " + folder.string() + ": " + status.message() +
                         "."};
  }
  // Names come from files and may hold any byte; what is not UTF-8 is replaced, not thrown over.
  const std::string json =
      to_json(report).dump(2, ' ', false, nlohmann::json::error_handler_t::replace);
  if (auto done = write_text(json + "\n", folder / "report.json"); !done) return done;
  return write_figures(figures_of(report), folder / "figures.json");
}

}  // namespace thimble::app
