#pragma once

#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

#include "report/figure_output.h"
#include "thimble/driver/result.h"

namespace thimble::studies {

/// Options of the study of accuracy.
struct AccuracyChoice {
  std::vector<std::string> axes;  ///< Names of axes, each once; empty: all.
  bool count = true;              ///< Also counts instructions, which takes minutes.
  bool resume = false;            ///< Continues with the journal in `folder`, if there is one.
  std::filesystem::path folder;   ///< For page, pictures, tables and journal; must exist.
};

/// Result of the study of accuracy.
struct AccuracyReport {
  bool stopped = false;  ///< Stopped early; the journal contains the measured axes.
  std::vector<session::Figure> figures;
};

/// Measures the cost of accuracy: one diagram per axis, as pictures, tables and one page. Shows a
/// progress bar if standard error is a terminal. Each axis is written to the journal as soon as it
/// is measured. Ends early when `stop` is true. Fails if an axis is unknown, if a file cannot be
/// written, or if the journal is of another study. Real-time: never from the servo thread.
driver::Result<AccuracyReport> study_accuracy(const AccuracyChoice& choice,
                                              const std::atomic<bool>& stop);

}  // namespace thimble::studies
