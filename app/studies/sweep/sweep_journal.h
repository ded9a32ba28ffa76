#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "output/folder_lock.h"
#include "studies/sweep/sweep.h"
#include "thimble/driver/result.h"

namespace thimble::studies {

/// The file with the results of a sweep: one line per cell, bit-identical, with a check sum, each
/// written by one call. However the program ends, at most the last line is incomplete; `open`
/// removes it.
class SweepJournal {
 public:
  /// Opens a journal for `cells` cells of a sweep with this key. With `resume` and an existing
  /// file, its results go into `numbers`; otherwise a new file is begun, and an old one is kept as
  /// FILE.old. Fails if the file is of another sweep, cannot be written, or another process uses a
  /// journal in its folder. Real-time: never from the servo thread.
  static driver::Result<std::unique_ptr<SweepJournal>> open(const std::filesystem::path& file,
                                                            const std::string& key,
                                                            std::size_t cells, bool resume,
                                                            CellNumbers& numbers);

  SweepJournal(const SweepJournal&) = delete;
  SweepJournal& operator=(const SweepJournal&) = delete;
  ~SweepJournal();

  /// Adds the result of one cell; false if it cannot be written. Only one thread at a time.
  bool add(std::size_t cell, std::span<const double> numbers);

  /// Replaces the file by one with all cells in order, atomically.
  driver::Result<void> finish(const CellNumbers& numbers);

 private:
  SweepJournal(output::FolderLock lock, std::filesystem::path file, std::string heading,
               int descriptor)
      : lock_(std::move(lock)),
        file_(std::move(file)),
        heading_(std::move(heading)),
        descriptor_(descriptor) {}

  output::FolderLock lock_;
  std::filesystem::path file_;
  std::string heading_;
  int descriptor_;
};

}  // namespace thimble::studies
