#include <algorithm>
#include <cmath>
#include <cstring>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "recording/h5_handle.h"
#include "recording/h5_reader.h"
#include "system/printable_text.h"
#include "system/regular_file.h"
#include "system/run_in_sandbox.h"
#include "thimble/driver/tick_record.h"
#include "thimble/session/recording.h"

namespace thimble::session {
namespace {

/// Returns whether the flags of a tick are valid: a bool is 0 or 1, and an enum has a name.
/// Compares bytes, because reading an invalid bool or enum is undefined.
bool sound(const driver::TickRecord& tick) {
  const auto byte_at = [&](std::size_t offset) {
    return reinterpret_cast<const unsigned char*>(&tick)[offset];
  };
  return byte_at(offsetof(driver::TickRecord, in_contact)) <= 1 &&
         byte_at(offsetof(driver::TickRecord, fresh)) <= 1 &&
         byte_at(offsetof(driver::TickRecord, has_gripper)) <= 1 &&
         byte_at(offsetof(driver::TickRecord, stage)) <=
             static_cast<unsigned>(driver::kLastStage) &&
         byte_at(offsetof(driver::TickRecord, fault)) <=
             static_cast<unsigned>(driver::kLastFault) &&
         byte_at(offsetof(driver::TickRecord, link)) <=
             static_cast<unsigned>(driver::kLastLinkState) &&
         byte_at(offsetof(driver::TickRecord, home_needed)) <= 1;
}

/// Reads the texts of a recording; returns false if any is missing.
bool take_info(driver::SandboxReader& in, RecordingInfo& info) {
  for (const RecordingText& text : kRecordingTexts) {
    if (!in.take_array(info.*text.text)) return false;
    if (text.is_name) info.*text.text = driver::printable_name(info.*text.text);
  }
  return true;
}

bool take_ticks(const H5Head& head, std::span<const std::byte> bytes, Recording& recording) {
  const auto columns = recording_columns();
  std::uint64_t row_bytes = 0;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if ((head.columns >> i & 1) != 0) row_bytes += columns[i].bytes();
  }
  // The number of rows must match the number of bytes exactly.
  if (row_bytes == 0 || head.rows != bytes.size() / row_bytes || bytes.size() % row_bytes != 0) {
    return false;
  }
  recording.ticks.resize(head.rows);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if ((head.columns >> i & 1) == 0) continue;
    const std::size_t size = columns[i].bytes();
    for (std::size_t row = 0; row < head.rows; ++row) {
      std::memcpy(reinterpret_cast<unsigned char*>(&recording.ticks[row]) + columns[i].offset,
                  bytes.data() + row * size, size);
    }
    bytes = bytes.subspan(head.rows * size);
  }
  return true;
}

}  // namespace

driver::Result<Recording> read_recording(const std::filesystem::path& path) {
  const auto wrong = [&](const std::string& what) {
    return driver::Error{path.string() + ": " + what};
  };
  const auto file = driver::RegularFile::open(path);
  if (!file) return wrong(file.error().message);
  const std::uint64_t stored = file->stored();
  constexpr std::uint64_t kBytesPerSecond = 10'000'000;
  const driver::SandboxLimits limits{
      .seconds =
          10 + static_cast<int>(std::min<std::uint64_t>(stored / kBytesPerSecond, 1'000'000)),
      .bytes = (std::size_t{1} << 28) + max_recording_memory(stored)};
  const std::lock_guard library(hdf5_mutex());
  const auto read = driver::run_in_sandbox(
      [&](driver::SandboxWriter& out) { read_h5(file->descriptor(), file->size(), stored, out); },
      limits);
  const auto damaged = [&](const std::string& how) {
    return wrong("this recording is damaged (it " + how +
                 "); use a copy made before the damage, or record again.");
  };
  if (!read) return damaged(read.error().message);
  driver::SandboxReader in(read->bytes());
  H5Head head;
  if (!in.take(&head, sizeof head)) return damaged("crashes its reader");
  if (head.good != 1) {
    const auto left = in.left();
    return wrong(std::string(reinterpret_cast<const char*>(left.data()), left.size()));
  }
  Recording recording;
  RecordingInfo& info = recording.info;
  info.rate = head.rate;
  info.seed = head.seed;
  recording.complete = head.complete == 1;
  if (!(info.rate > 0) || !std::isfinite(info.rate)) {
    return wrong("the description of the run cannot be read; the file is damaged.");
  }
  if (!take_info(in, info) || !take_ticks(head, in.left(), recording)) {
    return damaged("crashes its reader");
  }
  const auto bad = std::find_if_not(recording.ticks.begin(), recording.ticks.end(), sound);
  if (bad != recording.ticks.end()) {
    return wrong("row " + std::to_string(bad - recording.ticks.begin()) + " is damaged.");
  }
  return recording;
}

}  // namespace thimble::session
