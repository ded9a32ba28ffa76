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

/// What a study of stability is asked for.
struct StabilityOptions {
  std::filesystem::path arm_file;
  double rate = 1000;             ///< Hz
  std::string hand = "arm";       ///< "arm": as its file says; "none"; or "MASS,STIFFNESS,DAMPING".
  std::vector<double> direction;  ///< Along which the wall stands, in the world; empty: the worst.
  bool coarse = false;            ///< Few points, for tests.
};

/// Reads what is asked for. The error says what to mend. Real-time: never from the servo thread.
driver::Result<StabilitySetup> stability_setup(const StabilityOptions& options);

/// What the study found.
struct StabilityReport {
  SweepEnd end = SweepEnd::kDone;
  std::vector<session::Figure> figures;
};

/// Measures where walls are stable on a simulated arm, through the whole loop from the force law
/// over gate, wire and firmware to the tip and back, beside what the laws say: K-B map,
/// restitution, limit cycles, largest stiffness. Writes pictures, tables and summary.json.
/// Real-time: never from the servo thread.
driver::Result<StabilityReport> study_stability(const StabilityOptions& options,
                                                const SweepOptions& sweep,
                                                const std::atomic<bool>& stop);

}  // namespace thimble::studies
