#pragma once

#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

#include "report/figure_output.h"
#include "thimble/driver/result.h"

namespace thimble::studies {

/// What the study of accuracy is asked for.
struct AccuracyChoice {
  std::vector<std::string> axes;  ///< Names of axes, each once; empty: all.
  bool count = true;              ///< Counts instructions as well, which takes minutes.
  bool resume = false;            ///< Continues with the journal in `folder`, if there is one.
  std::filesystem::path folder;   ///< For page, pictures, tables and journal; exists.
};

/// What the study of accuracy found.
struct AccuracyReport {
  bool stopped = false;  ///< Stopped early; the journal holds the axes that were measured.
  std::vector<session::Figure> figures;
};

/// Measures what accuracy costs: one diagram per axis, as pictures, tables and one page. Shows a
/// progress bar if standard error is a terminal. Each axis goes into the journal as soon as it is
/// measured. Ends early once `stop` is true. Fails if an axis is not known, if a file cannot be
/// written, or if the journal is of another study. Real-time: never from the servo thread.
driver::Result<AccuracyReport> study_accuracy(const AccuracyChoice& choice,
                                              const std::atomic<bool>& stop);

}  // namespace thimble::studies
