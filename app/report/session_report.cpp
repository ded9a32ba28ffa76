#include "report/session_report.h"

#include "lost_contacts.h"

namespace thimble::app {

RunReport report_of(const session::Session& session, driver::ServoEnd end,
                    const driver::RealTimeGrant& grant) {
  RunReport report;
  report.scene = session.scene().name;
  for (const scene::SceneObject& object : session.scene().objects) {
    report.object += (report.object.empty() ? "" : ", ") + object.name;
  }
  report.arm = session.scene().arm.name;
  report.simulated_arm = session.simulation() != nullptr;
  report.feel_check = session.feel_check();
  report.virtual_time = !session.real_time();
  report.seed = session.seed();
  report.rate_asked = session.scene().rate;
  report.force_limit = session.scene().arm.limits.force_max;
  report.triangles = session.triangles();
  report.paging = session.paging();
  report.statistics = session.statistics();
  report.lost_contacts = session::count_lost_contacts(session.trace().rows(), session.touch());
  report.wire = session.device().wire_counters();
  report.gate = session.device().gate_counters();
  report.energy_stage = session.device().gate().energy_stage();
  report.reopen = session.device().gate().limits().reopen;
  report.heat_known = session.device().heat().named();
  report.heat = session.device().heat().heat();
  report.heat_most = session.device().heat().heat_most();
  report.heat_lowered = session.device().heat().lowered();
  report.real_time = grant;
  report.end = end;
  report.fault = session.device().fault();
  report.zero_assured = session.device().zero_assured();
  if (const auto* arm = session.simulation()) {
    report.current_at_exit = arm->currents().cwiseAbs().maxCoeff();
  }
  report.trace_stride = session.trace().stride();
  report.trace_dropped = session.trace().dropped();
  return report;
}

}  // namespace thimble::app
