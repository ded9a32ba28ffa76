#pragma once

#include <Eigen/Core>
#include <atomic>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "report/figure_output.h"
#include "studies/stability/stability_plan.h"
#include "studies/sweep/sweep.h"
#include "thimble/driver/result.h"

namespace thimble::studies {

/// Options of a study of stability.
struct StabilityOptions {
  std::filesystem::path arm_file;
  double rate = 1000;             ///< Hz
  std::string hand = "arm";       ///< "arm": that of its file; "none"; or "MASS,STIFFNESS,DAMPING".
  std::vector<double> direction;  ///< Normal of the wall in the world; empty: the worst direction.
  bool coarse = false;            ///< Few points, for tests.
};

/// Checks the options. The error says what to correct. Real-time: never from the servo thread.
driver::Result<StabilitySetup> stability_setup(const StabilityOptions& options);

/// Result of the study.
struct StabilityReport {
  SweepEnd end = SweepEnd::kDone;
  std::vector<session::Figure> figures;
};

/// Measures the region of stable walls on a simulated arm and compares it with the laws: K-B map,
/// restitution, limit cycles, largest stiffness. The measurement includes the whole loop from the
/// force law over gate, wire and firmware to the tip and back. Writes pictures, tables and
/// summary.json. Real-time: never from the servo thread.
driver::Result<StabilityReport> study_stability(const StabilityOptions& options,
                                                const SweepOptions& sweep,
                                                const std::atomic<bool>& stop);

}  // namespace thimble::studies
