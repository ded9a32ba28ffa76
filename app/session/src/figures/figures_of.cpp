#include "figures/figures_of.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <string>

#include "figures/lost_contacts.h"

namespace thimble::session {
namespace {

constexpr std::size_t kNamesMax = 20;  // names of objects in a sentence [chosen]

}  // namespace

std::vector<RunFigures::Tracker> trackers_of(const Setup& setup) {
  std::vector<RunFigures::Tracker> trackers;
  for (const scene::ObjectTracker& one : setup.objects().trackers()) {
    if (one.contact.tip_radius > 0) continue;
    trackers.push_back({.object = setup.scene().objects[one.object].name,
                        .tracker = std::string(
                            render::kTrackerNames[static_cast<std::size_t>(one.contact.tracker)]),
                        .chosen = one.chosen,
                        .reason = one.reason});
  }
  return trackers;
}

RunFigures figures_of(const Setup& setup, std::size_t arm, const RunRecords& records,
                      driver::ServoEnd end, const driver::RealTimeGrant& grant) {
  const driver::Device& device = setup.device(arm);
  RunFigures figures;
  figures.scene = setup.scene().name;
  const auto& objects = setup.scene().objects;
  for (std::size_t i = 0; i < std::min(objects.size(), kNamesMax); ++i) {
    figures.object += (figures.object.empty() ? "" : ", ") + objects[i].name;
  }
  if (objects.size() > kNamesMax) {
    figures.object += fmt::format(" and {} others", objects.size() - kNamesMax);
  }
  figures.arm = setup.arm_file(arm).name;
  figures.simulated_arm = setup.simulation(arm) != nullptr;
  figures.feel_check = setup.feel_check(arm);
  figures.virtual_time = !setup.real_time();
  figures.seed = setup.seed();
  figures.requested_rate = setup.scene().rate;
  figures.force_limit = setup.arm_file(arm).limits.force_max;
  figures.inside_at_start = setup.inside_at_start(arm);
  figures.tip_radius = setup.scene().tip_radius;
  figures.trackers = trackers_of(setup);
  figures.triangles = setup.objects().triangles();
  figures.paging = setup.objects().paging();
  figures.wire = device.wire_counters();
  figures.gate = device.gate_counters();
  figures.walls = device.wall_counters();
  figures.motors = setup.arm_file(arm).motors();
  figures.missing_force = device.missing_force();
  figures.energy_stage = device.gate().energy_stage();
  figures.reopen = device.gate().limits().reopen;
  figures.carried_weight = setup.arm_file(arm).max_carried_force;
  figures.carried_by_pose = !setup.arm_file(arm).carried_moments.isZero(0);
  figures.heat_known = device.heat().named();
  figures.heat = device.heat().heat();
  figures.max_heat = device.heat().max_heat();
  figures.heat_lowered = device.heat().lowered();
  figures.real_time = grant;
  figures.end = end;
  figures.fault = device.fault();
  figures.link = device.link_state();
  figures.home_needed = device.home_needed();
  figures.zero_assured = device.zero_assured();
  if (const auto* simulation = setup.simulation(arm)) {
    figures.current_at_exit = simulation->currents().cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
  }
  if (records.kept) {
    const Trace& trace = records.kept->trace;
    figures.statistics = records.kept->statistics;
    figures.lost_contacts = count_lost_contacts(trace.rows(), setup.objects().touch(arm));
    figures.trace_stride = trace.stride();
    figures.trace_dropped = trace.dropped();
  }
  return figures;
}

}  // namespace thimble::session
