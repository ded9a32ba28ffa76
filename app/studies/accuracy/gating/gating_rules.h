#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "thimble/driver/tick_record.h"
#include "thimble/scene/scene_file.h"

namespace thimble::studies {

/// Fraction of a force whose change is not noticed: half of 7 % [PHYSICS 6].
inline constexpr double kShareFelt = 0.035;

/// One effect of the simulated arm, and whether a scene needs it [PHYSICS 8, gating].
struct GateDecision {
  std::string effect;     ///< In words.
  std::string name;       ///< Without spaces: part of an argument of `thimble cost-probe`.
  std::string rule;       ///< The comparison, with the scene's numbers.
  bool left_out = false;  ///< May be omitted.
  bool changes = true;    ///< Whether omitting it changes the simulation at all.
  std::optional<double> change =
      {};  ///< RMS change of force without it while there is a force, relative to the force's RMS.
};

/// Inputs of the rules, from a run of the full model.
struct RunObservations {
  double force_rms = 0, force_max = 0;  ///< N, while there is a force
  double acceleration = 0;              ///< m/s^2, 99th percentile while there is a force
  double depth_max = 0;                 ///< m
};

/// Returns whether a tick has a force of a surface, or of a field, which acts without contact.
bool is_felt(const driver::TickRecord& row);

/// Evaluates a run with ticks of `tick` s. Real-time: never from the servo thread.
RunObservations look_at(std::span<const driver::TickRecord> rows, double tick);

/// Decides only by magnitudes which effects of the simulated arm a scene needs.
/// Real-time: never from the servo thread.
std::vector<GateDecision> decide(const scene::Scene& scene, const RunObservations& seen);

/// Removes an effect, named as in GateDecision, from a scene. Real-time: never from the servo
/// thread.
void leave_out(const std::string& name, scene::Scene& scene);

}  // namespace thimble::studies
