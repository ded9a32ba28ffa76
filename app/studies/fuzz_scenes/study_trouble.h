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

/// How far trouble is searched for.
struct TroubleOptions {
  std::filesystem::path arm_file;
  std::size_t count = 1000;
  std::uint64_t seed = 1;
};

/// What the search found.
struct TroubleReport {
  SweepEnd end = SweepEnd::kDone;
  std::vector<session::Figure> figures;
};

/// Touches `count` random scenes by random hands (random_scene.h), and writes
/// trouble.csv and the ten worst scenes into `worst/` of the sweep's folder, listed in its
/// index.html with pages of the runs of the first. The promises: no
/// number that is none, no force above the arm's limit, no fault, no energy beyond what the hand
/// put in. Real-time: never from the servo thread.
driver::Result<TroubleReport> study_trouble(const TroubleOptions& options,
                                            const SweepOptions& sweep,
                                            const std::atomic<bool>& stop);

}  // namespace thimble::studies
