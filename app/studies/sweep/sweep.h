#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "studies/sweep/sweep_team.h"
#include "thimble/driver/result.h"

namespace thimble::studies {

/// The numbers of each cell; an empty list for a cell that was not measured.
using CellNumbers = std::vector<std::vector<double>>;

/// A list of independent cells, each a pure function of its number. Therefore a sweep gives the
/// same bytes with any number of threads and machines, interrupted or not.
struct Sweep {
  std::string name;  ///< Name of its journal, NAME.journal.
  /// Everything on which the numbers depend, in any form: a journal with another key is refused.
  std::string key;
  std::size_t cells = 0;
  /// Measures one cell; called by several threads at once. Returns at least one number, or an
  /// error, which ends the sweep.
  std::function<driver::Result<std::vector<double>>(std::size_t cell)> measure;
};

/// Options of a sweep.
struct SweepOptions {
  std::filesystem::path folder;  ///< Folder of the journal; must exist.
  int jobs = 0;                  ///< Threads in this process; 0: one per available core.
  bool resume = false;           ///< Continues with an existing journal.
  SweepTeam* team = nullptr;     ///< The processes that share the work; nullptr: only this one.
};

/// The end of a sweep.
enum class SweepEnd {
  kDone,     ///< All cells are measured.
  kStopped,  ///< The stop flag was set; the journal contains the measured cells.
  kHelped    ///< This process helped the leading one, which has the numbers.
};

/// Result of a sweep: a list of numbers for each cell; empty lists unless it is done.
struct SweepResult {
  SweepEnd end = SweepEnd::kDone;
  CellNumbers numbers;
};

/// Measures all cells, in parallel, with a progress bar if stderr is a terminal. Every result is
/// written to the journal at once, so that a killed sweep loses only unfinished cells. At the end
/// the journal contains the cells in order. Without `resume` an older journal is kept as
/// NAME.journal.old.
///
/// Fails if the journal cannot be written or is one of another sweep, or if a cell fails.
/// Real-time: never from the servo thread.
driver::Result<SweepResult> run_sweep(const Sweep& sweep, const SweepOptions& options,
                                      const std::atomic<bool>& stop);

/// Returns the seed of one cell for the seed of a sweep, identical on every machine.
std::uint64_t cell_seed(std::uint64_t seed, std::size_t cell);

/// Returns the number of threads of this process: the cores available to it, shared with the other
/// processes on this machine.
int jobs_here();

}  // namespace thimble::studies
