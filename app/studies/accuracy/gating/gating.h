#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "report/figure_output.h"
#include "studies/accuracy/gating/gating_rules.h"
#include "thimble/driver/result.h"

namespace thimble::studies {

/// Result of the decisions.
struct GatingReport {
  std::vector<GateDecision> decisions;
  double force = 0;   ///< RMS force in contact of the full model, N.
  double change = 0;  ///< RMS change of force without all unneeded effects, as a fraction.
  bool holds = true;  ///< The change is at most half of the just noticeable difference.
  double full_ns = 0, reduced_ns = 0;                             ///< Time of a whole tick, median.
  std::optional<double> full_instructions, reduced_instructions;  ///< Per tick.
};

/// Decides which effects of the simulated arm a scene needs. Runs the scene with all effects and
/// without the others, in virtual time with the same hand, and compares. `count`: also counts
/// instructions. The error describes what is wrong with the scene. Real-time: never from the servo
/// thread.
driver::Result<GatingReport> decide_gating(const std::filesystem::path& scene, bool count);

/// Returns the report as text, with a decision per line.
std::string gating_text(const GatingReport& report);
/// Returns the report as figures.
std::vector<session::Figure> figures_of(const GatingReport& report);

/// Runs the scene of `full/FILE` or `reduced/FILE` once, for callgrind; false if that is no scene.
bool probe_gating(const std::string& subject);

}  // namespace thimble::studies
