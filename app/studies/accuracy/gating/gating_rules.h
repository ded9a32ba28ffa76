#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "thimble/driver/tick_record.h"
#include "thimble/scene/scene_file.h"

namespace thimble::studies {

/// The share by which a force may change unnoticed: half of 7 % [PHYSICS 6].
inline constexpr double kShareFelt = 0.035;

/// One effect of the simulated arm: whether this scene calls for it [PHYSICS 8, gating].
struct GateDecision {
  std::string effect;     ///< In words.
  std::string name;       ///< Without spaces: part of an argument of `thimble cost-probe`.
  std::string rule;       ///< What is compared with what, with the scene's numbers.
  bool left_out = false;  ///< May be left out.
  bool changes = true;    ///< Whether leaving it out changes the simulation at all.
  std::optional<double> change =
      {};  ///< RMS change of force without it where something is felt, of the force's RMS.
};

/// What the rules look at, found in a run of the full model.
struct SeenInRun {
  double force_rms = 0, force_max = 0;  ///< N, while something is felt
  double acceleration = 0;              ///< m/s^2, 99th percentile while something is felt
  double depth_max = 0;                 ///< m
};

/// Returns whether something is felt in a tick: a surface, or a field, which acts without contact.
bool is_felt(const driver::TickRecord& row);

/// Looks at a run with ticks of `tick` s. Real-time: never from the servo thread.
SeenInRun look_at(std::span<const driver::TickRecord> rows, double tick);

/// Decides by sizes alone which effects of the simulated arm a scene calls for.
/// Real-time: never from the servo thread.
std::vector<GateDecision> decide(const scene::Scene& scene, const SeenInRun& seen);

/// Takes an effect, named as in GateDecision, out of a scene. Real-time: never from the servo
/// thread.
void leave_out(const std::string& name, scene::Scene& scene);

}  // namespace thimble::studies
