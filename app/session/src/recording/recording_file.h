#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "thimble/driver/result.h"
#include "thimble/driver/tick_record.h"
#include "thimble/session/recording.h"

namespace thimble::session {

/// Writes a recording: an HDF5 file with one data set per column (recording_columns.h), its unit
/// and meaning as attributes, and what the run was.
///
/// The whole file is laid out and closed by the HDF5 library before the first tick; ticks are then
/// written straight to the places of the data sets, last of all the number of rows. So the file can
/// be opened at any moment, whatever becomes of this process: what is lost is what was not yet
/// handed over. It does not outlive a power cut within the last seconds, as no file does that is
/// not synchronised. Real-time: never from the servo thread.
class RecordingFile {
 public:
  /// Makes the file, for at most `rows_max` ticks (> 0; the room is taken as it is needed).
  /// A file of that name is replaced. The error says what could not be written and where.
  static driver::Result<RecordingFile> create(const std::filesystem::path& path,
                                              const RecordingInfo& info, std::uint64_t rows_max);
  RecordingFile(RecordingFile&& other) noexcept;
  RecordingFile& operator=(RecordingFile&&) = delete;
  RecordingFile(const RecordingFile&) = delete;
  RecordingFile& operator=(const RecordingFile&) = delete;
  ~RecordingFile();

  /// Adds ticks; what is beyond `rows_max` is left out. After an error the file holds what it held
  /// before.
  driver::Result<void> append(std::span<const driver::TickRecord> ticks);

  /// Makes the file as short as the run was, and marks it as complete.
  driver::Result<void> finish();

  std::uint64_t rows() const noexcept { return rows_; }
  std::uint64_t rows_max() const noexcept { return rows_max_; }
  const std::filesystem::path& path() const noexcept { return path_; }

 private:
  RecordingFile(std::filesystem::path path, RecordingInfo info, std::uint64_t rows_max)
      : path_(std::move(path)), info_(std::move(info)), rows_max_(rows_max) {}
  driver::Result<void> lay_out();
  driver::Result<void> write_at(const void* bytes, std::size_t size, std::uint64_t place);
  driver::Result<void> copy_rows_to(RecordingFile& other);

  std::filesystem::path path_;
  RecordingInfo info_;
  std::uint64_t rows_max_;
  std::uint64_t rows_ = 0;
  int file_ = -1;
  std::vector<std::uint64_t> places_;  // in the file, of each column
  std::uint64_t rows_place_ = 0, complete_place_ = 0;
  std::vector<unsigned char> column_;  // of the ticks being written
};

}  // namespace thimble::session
