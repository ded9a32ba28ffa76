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

/// Number of ticks of a recording.
struct RecordingSize {
  std::uint64_t rows_max = 1;  ///< Ticks beyond them are left out.
  /// Room that the file begins with; it doubles whenever it is full. Not all is laid out at once:
  /// file systems without holes (FAT, exFAT) would need the space of a whole day. [chosen: two
  /// minutes at 1 kHz, 40 MB]
  std::uint64_t room = std::uint64_t{1} << 17;
};

/// Writes a recording: an HDF5 file with one data set per column (recording_columns.cpp), its unit
/// and meaning as attributes, and what the run was.
///
/// The file has its name from the first tick on, and can be opened at any moment, however this
/// process ends: what is lost is what was not yet handed over. It does not outlive a power cut
/// within the last seconds, as no file does that is not synchronised. Real-time: never from the
/// servo thread.
class RecordingFile {
 public:
  /// Makes the file. `replace`: a recording of that name is replaced; other files never are. The
  /// error says what could not be written and where.
  static driver::Result<RecordingFile> create(const std::filesystem::path& path,
                                              const RecordingInfo& info, const RecordingSize& size,
                                              bool replace = false);

  /// Adds ticks. After an error the file holds what it held before.
  driver::Result<void> append(std::span<const driver::TickRecord> ticks);

  /// Makes the file as short as the run was. It is marked as complete if `complete` and no tick was
  /// left out. The error says what could not be written.
  driver::Result<void> finish(bool complete);

  std::uint64_t rows() const noexcept { return rows_; }
  std::uint64_t rows_max() const noexcept { return rows_max_; }
  /// Returns how many ticks were left out because `rows_max` was reached.
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
  std::future<driver::Result<RecordingLayout>> making_;  // the next one
  std::optional<RecordingLayout> larger_;                // the same, once it is laid out
  std::uint64_t copied_ = 0;                             // rows in it
};

}  // namespace thimble::session
