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
#include "thimble/scene/arm_policy.h"
#include "thimble/session/run_statistics.h"

namespace thimble::session {

/// A measured value with its goal, from a run, report, study or benchmark.
struct THIMBLE_EXPORT Figure {
  std::string name;    ///< Name in lower_snake_case.
  double value = 0;    ///< Value in `unit`.
  std::string unit;    ///< Unit; empty for counts.
  std::string goal;    ///< Goal as a comparison (">= 20", "<= 5", "== 0", "> 1", "< 2"); empty if
                       ///< there is none.
  std::string note{};  ///< Source of the value, or why it has no goal; may be empty.

  /// Returns whether the value meets the goal; true without a goal. NaN meets no goal. A goal that
  /// is not a comparison is never met.
  bool met() const;
};

/// Figures of a run: configuration, statistics and end. Plain data for reports, tables and files.
struct RunFigures {
  /// Tracker of an object that is a mesh in memory.
  struct Tracker {
    std::string object;   ///< Name of the object.
    std::string tracker;  ///< Name of the tracker, as in a scene.
    bool chosen = false;  ///< True if the tracker was chosen, false if it was named.
    std::string reason;   ///< Reason of the choice; empty if the tracker was named.
  };

  std::string scene;          ///< Name of the scene.
  std::string object;         ///< Names of all objects of the scene.
  std::string arm;            ///< Name of the arm.
  bool simulated_arm = true;  ///< True if the arm is simulated and no real motor ran.
  /// State of the arm's feel check at the start of the run.
  scene::FeelCheckState feel_check = scene::FeelCheckState::kSimulated;
  bool virtual_time = true;                  ///< True if the run used virtual time.
  std::uint64_t seed = 0;                    ///< Seed of all random numbers in the simulation.
  double requested_rate = 0;                 ///< Requested rate of the servo loop, Hz.
  double force_limit = 0;                    ///< Force limit of the safety gate, N.
  std::vector<std::string> inside_at_start;  ///< Names of the objects in which the tip started.
  double tip_radius = 0;                     ///< Of a tip that is a ball, m; 0: a point.
  std::vector<Tracker> trackers;  ///< Trackers of meshes in memory; none under a tip with a radius.
  std::size_t triangles = 0;      ///< Number of touchable triangles, in memory and on disk.
  RunStatistics statistics;       ///< Statistics of the ticks.
  /// Intervals inside an object without a force; found after the run.
  std::uint64_t lost_contacts = 0;
  double current_at_exit = 0;  ///< Largest motor current after the end, A; simulated arm only.
  /// Disk paging counters; empty if no object is paged from disk.
  std::optional<render::PagingCounters> paging;
  driver::WireCounters wire;   ///< Counters of received messages.
  driver::GateCounters gate;   ///< Counters of the safety gate.
  driver::WallCounters walls;  ///< Counters of the workspace walls.
  int motors = 3;              ///< Number of motors of the arm.
  /// Force that an arm with one or two motors could not give.
  driver::MissingForce missing_force;
  /// Energy stage of the safety gate.
  driver::EnergyStage energy_stage = driver::EnergyStage::kNone;
  double reopen = 0;  ///< Time in which the gate reopens after a gap, s.
  /// Part of the requested force that compensates the weight of the arm, N; 0: none.
  double carried_weight = 0;
  /// Number of times gravity compensation was switched off because the tip moved along its force.
  std::uint64_t carry_withdrawn = 0;
  bool carried_by_pose = false;  ///< True if that part depends on the pose; `carried_weight` is
                                 ///< then its maximum over the workspace.
  bool heat_known = false;  ///< True if the arm file gives the continuous currents of the motors.
  std::array<double, 3> heat{};  ///< Heat of the motors at the end; 1 is the limit of the winding.
  double max_heat = 0;           ///< Largest heat of any motor during the run.
  /// Number of ticks in which a force was reduced because of heat.
  std::uint64_t heat_lowered = 0;
  /// Real-time properties that the kernel granted to the servo thread.
  driver::RealTimeGrant real_time;
  driver::ServoEnd end = driver::ServoEnd::kDone;          ///< Reason for the end of the loop.
  driver::Fault fault = driver::Fault::kNone;              ///< Fault of the device after the run.
  driver::LinkState link = driver::LinkState::kConnected;  ///< State of the link after the run.
  /// True if the home pose is required before any force (Device::home_needed).
  bool home_needed = false;
  bool zero_assured = true;         ///< True if the arm accepted the last zero force.
  std::uint64_t trace_stride = 1;   ///< The trace contains every n-th tick.
  std::uint64_t trace_dropped = 0;  ///< Number of ticks dropped because the trace was full.
};

/// Returns the figures of a run with their goals, as in figures.json.
THIMBLE_EXPORT std::vector<Figure> figures_of(const RunFigures& run);

/// Returns a summary of a run in plain text, about ten lines, for a first-time reader.
THIMBLE_EXPORT std::string summary(const RunFigures& run);

}  // namespace thimble::session
