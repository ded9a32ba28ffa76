#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "report/figure_output.h"
#include "studies/accuracy/gating/gating_rules.h"
#include "thimble/driver/result.h"

namespace thimble::studies {

/// What the decisions come to.
struct GatingReport {
  std::vector<GateDecision> decisions;
  double force = 0;   ///< RMS force in contact of the full model, N.
  double change = 0;  ///< RMS change of force with all left out that may be, as a share.
  bool holds = true;  ///< No more than half of what can be told apart.
  double full_ns = 0, reduced_ns = 0;                             ///< Of a whole tick, median.
  std::optional<double> full_instructions, reduced_instructions;  ///< Per tick.
};

/// Decides which effects of the simulated arm a scene calls for, runs the scene with all of them
/// and without those, on the virtual clock with the same hand, and compares. `count`: instructions
/// too. The error names what is wrong with the scene. Real-time: never from the servo thread.
driver::Result<GatingReport> decide_gating(const std::filesystem::path& scene, bool count);

/// Lays the report out as text, with a decision per line.
std::string gating_text(const GatingReport& report);
/// Returns it as figures.
std::vector<session::Figure> figures_of(const GatingReport& report);

/// Runs the scene of `full/FILE` or `reduced/FILE` once, for callgrind; false if that is no scene.
bool probe_gating(const std::string& subject);

}  // namespace thimble::studies
