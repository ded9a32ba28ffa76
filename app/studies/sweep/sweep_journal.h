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

/// The file that keeps what a sweep has measured: one line per cell, to the bit, with a check
/// sum, each written by one call. Whatever ends the program, at most the last line is torn; `open`
/// cuts it off.
class SweepJournal {
 public:
  /// Opens a journal for `cells` cells of a sweep with this key. With `resume` and a file there,
  /// its results go into `numbers`; else a new one is begun, and an old file is kept as FILE.old.
  /// Fails if the file is of another sweep, cannot be written, or another process keeps a journal
  /// in its folder. Real-time: never from the servo thread.
  static driver::Result<std::unique_ptr<SweepJournal>> open(const std::filesystem::path& file,
                                                            const std::string& key,
                                                            std::size_t cells, bool resume,
                                                            CellNumbers& numbers);

  SweepJournal(const SweepJournal&) = delete;
  SweepJournal& operator=(const SweepJournal&) = delete;
  ~SweepJournal();

  /// Adds the result of one cell; false if it cannot be written. For one thread at a time.
  bool add(std::size_t cell, std::span<const double> numbers);

  /// Writes the file anew with all cells in order, in one step that cannot be seen half done.
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
