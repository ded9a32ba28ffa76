#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "page/paged_surface.h"
#include "report/figure.h"
#include "thimble/driver/device.h"
#include "thimble/driver/fault.h"
#include "thimble/driver/real_time.h"
#include "thimble/driver/result.h"
#include "thimble/driver/safety_gate.h"
#include "thimble/driver/servo_loop.h"
#include "thimble/scene/real_arm_terms.h"
#include "thimble/session/run_statistics.h"

namespace thimble::app {

/// Is everything a report tells of a run; the session fills it.
struct RunReport {
  std::string scene;
  std::string object;  ///< What was touched.
  std::string arm;
  bool simulated_arm = true;
  scene::FeelCheckState feel_check =
      scene::FeelCheckState::kSimulated;  ///< What it had passed before the run.
  bool virtual_time = true;
  std::uint64_t seed = 0;
  double rate_asked = 0;   ///< Hz
  double force_limit = 0;  ///< The gate's, N.
  std::size_t triangles = 0;
  session::RunStatistics statistics;
  std::uint64_t lost_contacts =
      0;                       ///< Stretches inside the object without a force (checked after).
  double current_at_exit = 0;  ///< Largest motor current after the end, A (simulated arm).
  std::optional<render::PagingCounters> paging;  ///< Of objects on the disk, if there are any.
  driver::WireCounters wire;
  driver::GateCounters gate;
  driver::EnergyStage energy_stage = driver::EnergyStage::kNone;
  double reopen = 0;               ///< The gate's, s.
  bool heat_known = false;         ///< The arm file says what the motors carry for long.
  std::array<double, 3> heat{};    ///< Of the motors at the end; 1: the winding's limit.
  double heat_most = 0;            ///< The most that any motor reached.
  std::uint64_t heat_lowered = 0;  ///< Ticks in which a force was lowered because of heat.
  driver::RealTimeGrant real_time;
  driver::ServoEnd end = driver::ServoEnd::kDone;
  driver::Fault fault = driver::Fault::kNone;
  bool zero_assured = true;         ///< Whether the arm took the last zero force.
  std::uint64_t trace_stride = 1;   ///< Every n-th tick is in the pictures.
  std::uint64_t trace_dropped = 0;  ///< Rows that found no room.
};

/// Tells the figures a run stands for, with their goals (DESIGN.md, Figures).
std::vector<Figure> run_figures(const RunReport& report);

/// Tells a run in plain words, about ten lines, for somebody who sees it for the first time.
std::string summary(const RunReport& report);

/// Writes report.json and figures.json into the folder, which is made if need be. Fails, naming the
/// file, if that cannot be done. Real-time: never from the servo thread.
driver::Result<void> write_report(const RunReport& report, const std::filesystem::path& folder);

}  // namespace thimble::app
