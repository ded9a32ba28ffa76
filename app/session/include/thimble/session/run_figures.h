#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "thimble/driver/device.h"
#include "thimble/driver/export.h"
#include "thimble/driver/fault.h"
#include "thimble/driver/real_time.h"
#include "thimble/driver/safety_gate.h"
#include "thimble/driver/servo_loop.h"
#include "thimble/render/page/paging_counters.h"
#include "thimble/scene/real_arm_terms.h"
#include "thimble/session/figure.h"
#include "thimble/session/run_statistics.h"

namespace thimble::session {

/// The figures of a run: what ran, how it went and how it ended. Plain data, of which reports,
/// tables and files are made.
struct RunFigures {
  std::string scene;          ///< Its name.
  std::string object;         ///< What was touched: the names of all objects.
  std::string arm;            ///< Its name.
  bool simulated_arm = true;  ///< Whether no motor of an arm pulled.
  scene::FeelCheckState feel_check =
      scene::FeelCheckState::kSimulated;     ///< What the arm had passed before the run.
  bool virtual_time = true;                  ///< As fast as it computed.
  std::uint64_t seed = 0;                    ///< Of everything random in the simulation.
  double rate_asked = 0;                     ///< Hz
  double force_limit = 0;                    ///< The gate's, N.
  std::vector<std::string> inside_at_start;  ///< Names of the objects that the tip started in.
  std::size_t triangles = 0;                 ///< That can be touched, in memory and on the disk.
  RunStatistics statistics;                  ///< What the ticks sum up to.
  std::uint64_t lost_contacts = 0;  ///< Stretches inside an object without a force (checked after).
  double current_at_exit = 0;       ///< Largest motor current after the end, A (simulated arm).
  std::optional<render::PagingCounters> paging;  ///< Of objects on the disk, if there are any.
  driver::WireCounters wire;                     ///< What came from the arm.
  driver::GateCounters gate;                     ///< What the safety gate did.
  driver::WallCounters walls;                    ///< Pushes of the walls of the workspace.
  driver::EnergyStage energy_stage = driver::EnergyStage::kNone;  ///< Of the gate.
  double reopen = 0;                                              ///< The gate's, s.
  double carried_weight = 0;  ///< What of the requested force carried the arm, N; 0: nothing.
  /// How often gravity compensation was switched off because the tip moved along its force.
  std::uint64_t carry_withdrawn = 0;
  bool carried_by_pose = false;     ///< That hangs on the pose, and is the most over the workspace.
  bool heat_known = false;          ///< The arm file says what the motors carry for long.
  std::array<double, 3> heat{};     ///< Of the motors at the end; 1: the winding's limit.
  double heat_most = 0;             ///< The most that any motor reached.
  std::uint64_t heat_lowered = 0;   ///< Ticks in which a force was lowered because of heat.
  driver::RealTimeGrant real_time;  ///< What the kernel granted the servo's thread.
  driver::ServoEnd end = driver::ServoEnd::kDone;          ///< Why the loop ended.
  driver::Fault fault = driver::Fault::kNone;              ///< In which the device was left.
  driver::LinkState link = driver::LinkState::kConnected;  ///< In which the arm was left.
  bool home_needed = false;         ///< No force before the home pose (Device::home_needed).
  bool zero_assured = true;         ///< Whether the arm took the last zero force.
  std::uint64_t trace_stride = 1;   ///< Every n-th tick is in the trace.
  std::uint64_t trace_dropped = 0;  ///< Ticks that found no room there.
};

/// Returns the figures that a run stands for, with their goals: what figures.json holds.
THIMBLE_EXPORT std::vector<Figure> figures_of(const RunFigures& run);

/// Returns a run in plain words, about ten lines, for somebody who sees it for the first time.
THIMBLE_EXPORT std::string summary(const RunFigures& run);

}  // namespace thimble::session
