#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <future>
#include <optional>
#include <span>

#include "recording/recording_layout.h"
#include "thimble/driver/result.h"
#include "thimble/driver/tick_record.h"
#include "thimble/session/recording.h"

namespace thimble::session {

/// Sizes of a recording, ticks.
struct RecordingSize {
  std::uint64_t rows_max = 1;  ///< Largest number of ticks; further ones are omitted.
  /// Initial capacity of the file; doubled whenever it is full. The maximum is not allocated at
  /// once, because file systems without sparse files (FAT, exFAT) would need the space of a whole
  /// day. [chosen: two minutes at 1 kHz, 40 MB]
  std::uint64_t room = std::uint64_t{1} << 17;
};

/// Writes a recording: an HDF5 file with one data set per column (recording_columns.cpp), with unit
/// and meaning as attributes, and the description of the run.
///
/// The file has its name from the first tick on and can be opened at any time, however this process
/// ends. Only ticks not yet passed to `append` are lost. As any unsynchronised file, it may lose
/// the last seconds before a power failure. Real-time: never from the servo thread.
class RecordingFile {
 public:
  /// Creates the file. With `replace`, an existing recording of that name is replaced; other files
  /// never are. The error says what could not be written and where.
  static driver::Result<RecordingFile> create(const std::filesystem::path& path,
                                              const RecordingInfo& info, const RecordingSize& size,
                                              bool replace = false);

  /// Adds ticks. After an error the file has its previous contents.
  driver::Result<void> append(std::span<const driver::TickRecord> ticks);

  /// Truncates the file to the length of the run. It is marked complete if `complete` is true and
  /// no tick was omitted. The error says what could not be written.
  driver::Result<void> finish(bool complete);

  std::uint64_t rows() const noexcept { return rows_; }
  std::uint64_t rows_max() const noexcept { return rows_max_; }
  /// Returns the number of ticks omitted because `rows_max` was reached.
  std::uint64_t left_out() const noexcept { return left_out_; }
  const std::filesystem::path& path() const noexcept { return path_; }

 private:
  RecordingFile(std::filesystem::path path, RecordingInfo info, std::uint64_t rows_max,
                RecordingLayout layout);
  driver::Error ends(const driver::Error& why) const;
  void prepare_to_grow(std::uint64_t new_rows);
  driver::Result<void> grow();
  bool shorten(bool complete);

  std::filesystem::path path_;
  RecordingInfo info_;
  std::uint64_t rows_max_;
  std::uint64_t rows_ = 0, left_out_ = 0;
  RecordingLayout layout_;
  std::future<driver::Result<RecordingLayout>> making_;  // Next, larger layout in preparation.
  std::optional<RecordingLayout> larger_;                // The larger layout once it is complete.
  std::uint64_t copied_ = 0;                             // Rows copied to it.
};

}  // namespace thimble::session
