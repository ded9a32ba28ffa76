#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "output/output_file.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/driver/tick_record.h"
#include "thimble/session/recording.h"

namespace thimble::session {

/// Recordings as outputs: they are measurements, and can be read by their owner only.
THIMBLE_EXPORT extern const output::OutputKind kRecordingOutput;

/// One HDF5 file of a recording, with room for a fixed number of ticks.
///
/// The whole file is laid out and closed by the HDF5 library before it gets its name; ticks are
/// then written straight to the places of the data sets, last of all the number of rows. So the
/// file can be opened at any moment, however this process ends. Real-time: never from the servo
/// thread.
class RecordingLayout {
 public:
  /// Lays out a recording with room for `room` ticks (> 0), under the name of the part.
  static driver::Result<RecordingLayout> create(output::OutputFile file, const RecordingInfo& info,
                                                std::uint64_t room);

  /// Writes ticks from row `row` on. They count once `set_rows` names them. Precondition: room.
  driver::Result<void> write_ticks(std::span<const driver::TickRecord> ticks, std::uint64_t row);
  /// Copies rows of another layout to the same rows of this one.
  driver::Result<void> copy_rows(const RecordingLayout& from, std::uint64_t begin,
                                 std::uint64_t end);
  driver::Result<void> set_rows(std::uint64_t rows);
  driver::Result<void> set_complete();

  std::uint64_t room() const noexcept { return room_; }
  output::OutputFile& file() noexcept { return file_; }

 private:
  RecordingLayout(output::OutputFile file, std::uint64_t room)
      : file_(std::move(file)), room_(room) {}
  driver::Result<void> lay_out(const RecordingInfo& info);
  driver::Result<void> write_at(const void* bytes, std::size_t size, std::uint64_t place);

  output::OutputFile file_;
  std::uint64_t room_;
  std::vector<std::uint64_t> places_;  // in the file, of each column
  std::uint64_t rows_place_ = 0, complete_place_ = 0;
  std::vector<unsigned char> column_;  // of the ticks being written
};

}  // namespace thimble::session
