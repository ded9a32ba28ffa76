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

/// The numbers of each cell that was measured; an empty list stands for a cell that was not.
using CellNumbers = std::vector<std::vector<double>>;

/// A list of independent cells, each a pure function of its number. That is what makes a sweep
/// give the same bytes with any number of threads and machines, interrupted or not.
struct Sweep {
  std::string name;  ///< Of its journal, NAME.journal.
  /// Everything that the numbers depend on, in any form: a journal of another key is refused.
  std::string key;
  std::size_t cells = 0;
  /// Measures one cell, by several threads at once: at least one number, or why there is none,
  /// which ends the sweep.
  std::function<driver::Result<std::vector<double>>(std::size_t cell)> measure;
};

/// How a sweep is run.
struct SweepOptions {
  std::filesystem::path folder;  ///< Where the journal lies; exists.
  int jobs = 0;                  ///< Threads in this process; 0: one per core that it may use.
  bool resume = false;           ///< Goes on with the journal that lies there, if one does.
  SweepTeam* team = nullptr;     ///< The processes that share the work; nullptr: this one alone.
};

/// How a sweep ended.
enum class SweepEnd {
  kDone,     ///< All numbers are there.
  kStopped,  ///< Somebody set the stop flag; the journal holds what was done.
  kHelped    ///< This process helped the one that has the numbers.
};

/// What a sweep gave: a list of numbers for each cell; empty lists unless it is done.
struct SweepResult {
  SweepEnd end = SweepEnd::kDone;
  CellNumbers numbers;
};

/// Measures all cells, in parallel, with a progress bar if stderr is a terminal. Every result goes
/// into the journal at once, so that a killed sweep loses only the cells it was at. In the end the
/// journal holds the cells in order. Without `resume` an older journal is kept beside the new one
/// as NAME.journal.old.
///
/// Fails if the journal cannot be written or is one of another sweep, or if a cell fails.
/// Real-time: never from the servo thread.
driver::Result<SweepResult> run_sweep(const Sweep& sweep, const SweepOptions& options,
                                      const std::atomic<bool>& stop);

/// Draws the seed of one cell out of that of a sweep, alike on every machine.
std::uint64_t cell_seed(std::uint64_t seed, std::size_t cell);

/// Returns how many threads this process should run: the cores it may use, shared with the
/// processes beside it on this machine.
int jobs_here();

}  // namespace thimble::studies
