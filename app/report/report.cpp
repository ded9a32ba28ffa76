#include "report/report.h"

#include <nlohmann/json.hpp>
#include <system_error>

#include "report/figure_output.h"
#include "report/json_text.h"
#include "text_file.h"
#include "thimble/scene/build_info.h"
#include "wall_side.h"

namespace thimble::report {
namespace {

using Json = nlohmann::ordered_json;

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

}  // namespace

Json report_json(const session::RunFigures& report) {
  const scene::BuildInfo build = scene::build_info();
  const session::RunStatistics& run = report.statistics;
  Json json;
  json["scene"] = report.scene;
  json["object"] = report.object;
  json["triangles"] = report.triangles;
  json["tip_radius_m"] = report.tip_radius;
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
  json["rate_Hz"] = {{"asked", report.requested_rate}, {"reached", run.rate()}};
  json["period"] = to_json(run.period());
  json["lateness"] = to_json(run.lateness());
  // In virtual time, a tick has no duration.
  if (!report.virtual_time) json["tick_time"] = to_json(run.work());
  json["contact"] = {{"touch_downs", run.contacts()},        {"lost", report.lost_contacts},
                     {"interruptions", run.interruptions()}, {"time_s", run.contact_time()},
                     {"depth_max_m", run.depth_max()},       {"hops_max", run.hops_max()}};
  json["contact"]["inside_at_start"] = report.inside_at_start;
  json["contact"]["trackers"] = Json::array();
  for (const session::RunFigures::Tracker& one : report.trackers) {
    json["contact"]["trackers"].push_back({{"object", one.object},
                                           {"tracker", one.tracker},
                                           {"chosen", one.chosen},
                                           {"reason", one.reason}});
  }
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
                  {"energy_least_J", report.gate.min_energy},
                  {"power_limited", report.gate.power_limited},
                  {"power_max_W", report.gate.power_max},
                  {"oscillations", report.gate.oscillations},
                  {"oscillation_Hz", report.gate.oscillation_frequency},
                  {"calmed", report.gate.calmed}};
  json["walls"] = {{"ticks", report.walls.pushed},
                   {"force_max_N", report.walls.f_strongest_W.norm()}};
  if (report.walls.pushed > 0) {
    json["walls"]["side"] = session::wall_side(report.walls.f_strongest_W);
  }
  if (report.motors < 3) {
    const Eigen::Vector3d& f_W = report.missing_force.f_strongest_W;
    json["motors"] = report.motors;
    json["force_not_given"] = {{"ticks", report.missing_force.ticks},
                               {"max_N", f_W.norm()},
                               {"strongest_N", {f_W.x(), f_W.y(), f_W.z()}}};
  }
  if (report.carried_weight > 0) {
    json["carried_weight_N"] = report.carried_weight;
    json["gravity_compensation"] = {{"trusted", report.carry_withdrawn == 0},
                                    {"withdrawn", report.carry_withdrawn}};
  }
  if (report.heat_known) {
    json["heat"] = {
        {"motors", report.heat}, {"most", report.max_heat}, {"ticks_lowered", report.heat_lowered}};
  }
  json["real_time"] = {{"fifo", report.real_time.fifo},
                       {"memory_locked", report.real_time.memory_locked},
                       {"cpu_awake", report.real_time.cpu_awake},
                       {"advice", report.real_time.advice}};
  json["end"] = {
      {"reason", driver::name(report.end)},  {"fault", driver::name(report.fault)},
      {"link", driver::name(report.link)},   {"home_needed", report.home_needed},
      {"zero_assured", report.zero_assured}, {"motor_current_A", report.current_at_exit}};
  json["trace"] = {{"every", report.trace_stride}, {"dropped", report.trace_dropped}};
  return json;
}

driver::Result<void> write_report(const session::RunFigures& report,
                                  const std::filesystem::path& folder) {
  std::error_code status;
  std::filesystem::create_directories(folder, status);
  if (status) {
    return driver::Error{"Cannot create the folder " + folder.string() + ": " + status.message() +
                         "."};
  }
  if (auto done = write_json(report_json(report), folder / "report.json"); !done) return done;
  return write_figures(session::figures_of(report), folder / "figures.json");
}

}  // namespace thimble::report
