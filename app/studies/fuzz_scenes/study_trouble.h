#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "report/figure_output.h"
#include "studies/sweep/sweep.h"
#include "thimble/driver/result.h"

namespace thimble::studies {

/// Extent of the search for trouble.
struct TroubleOptions {
  std::filesystem::path arm_file;
  std::size_t count = 1000;
  std::uint64_t seed = 1;
};

/// Result of the search.
struct TroubleReport {
  SweepEnd end = SweepEnd::kDone;
  std::vector<session::Figure> figures;
};

/// Touches `count` random scenes by random hands (random_scene.h), and writes trouble.csv and the
/// ten worst scenes into `worst/` of the sweep's folder. Its index.html lists them, with pages of
/// the runs of the first. The promises: no NaN, no force above the arm's limit, no fault, no energy
/// beyond that of the hand. Real-time: never from the servo thread.
driver::Result<TroubleReport> study_trouble(const TroubleOptions& options,
                                            const SweepOptions& sweep,
                                            const std::atomic<bool>& stop);

}  // namespace thimble::studies
