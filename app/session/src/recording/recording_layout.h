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

/// Output kind of recordings: measurements that only their owner may read.
THIMBLE_EXPORT extern const output::OutputKind kRecordingOutput;

/// One HDF5 file of a recording, with room for a fixed number of ticks.
///
/// The HDF5 library creates and closes the whole file before the file gets its name. Ticks are then
/// written directly to the positions of the data sets, the number of rows last. So the file can be
/// opened at any time, however this process ends. Real-time: never from the servo thread.
class RecordingLayout {
 public:
  /// Creates a recording for `room` ticks (> 0), under a temporary name.
  static driver::Result<RecordingLayout> create(output::OutputFile file, const RecordingInfo& info,
                                                std::uint64_t room);

  /// Writes ticks from row `row` on. They become valid with `set_rows`. Precondition: there is
  /// room.
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
  std::vector<std::uint64_t> places_;  // Position of each column in the file.
  std::uint64_t rows_place_ = 0, complete_place_ = 0;
  std::vector<unsigned char> column_;  // Column of the ticks being written.
};

}  // namespace thimble::session
