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
#include "system/run_apart.h"
#include "thimble/driver/tick_record.h"
#include "thimble/session/recording.h"

namespace thimble::session {
namespace {

/// Returns whether the flags of a tick are such as a program may look at: a bool is 0 or 1, an enum
/// has a name. Looks at the bytes, for that is what may be wrong.
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

/// Takes bytes off the front of what the reading process returned, which is not trusted.
class Parcel {
 public:
  explicit Parcel(std::span<const std::byte> bytes) : left_(bytes) {}

  /// Returns false if there are fewer bytes.
  bool take(void* into, std::size_t size) {
    if (left_.size() < size) return false;
    std::memcpy(into, left_.data(), size);
    left_ = left_.subspan(size);
    return true;
  }
  bool take(std::string& text) {
    std::uint64_t length = 0;
    if (!take(&length, sizeof length) || length > left_.size()) return false;
    text.assign(reinterpret_cast<const char*>(left_.data()), length);
    left_ = left_.subspan(length);
    return true;
  }
  std::span<const std::byte> left() const { return left_; }

 private:
  std::span<const std::byte> left_;
};

bool take_info(Parcel& parcel, RecordingInfo& info) {
  for (const RecordingText& text : kRecordingTexts) {
    if (!parcel.take(info.*text.text)) return false;
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
  // Exactly as many as there are bytes.
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
  const driver::ApartLimits limits{.seconds = 10 + static_cast<int>(std::min<std::uint64_t>(
                                                       stored / kBytesPerSecond, 1'000'000)),
                                   .bytes = (std::size_t{1} << 28) + max_recording_memory(stored)};
  const std::lock_guard library(hdf5_mutex());
  const auto read = driver::run_apart(
      [&](driver::ApartWriter& out) { read_h5(file->descriptor(), file->size(), stored, out); },
      limits);
  const auto damaged = [&](const std::string& how) {
    return wrong("this recording is damaged (it " + how +
                 "); use a copy made before the damage, or record again.");
  };
  if (!read) return damaged(read.error().message);
  Parcel parcel(read->bytes());
  H5Head head;
  if (!parcel.take(&head, sizeof head)) return damaged("breaks its reader");
  if (head.good != 1) {
    const auto left = parcel.left();
    return wrong(std::string(reinterpret_cast<const char*>(left.data()), left.size()));
  }
  Recording recording;
  RecordingInfo& info = recording.info;
  info.rate = head.rate;
  info.seed = head.seed;
  recording.complete = head.complete == 1;
  if (!(info.rate > 0) || !std::isfinite(info.rate)) {
    return wrong("what the recording is of cannot be read; the file is damaged.");
  }
  if (!take_info(parcel, info) || !take_ticks(head, parcel.left(), recording)) {
    return damaged("breaks its reader");
  }
  const auto bad = std::find_if_not(recording.ticks.begin(), recording.ticks.end(), sound);
  if (bad != recording.ticks.end()) {
    return wrong("row " + std::to_string(bad - recording.ticks.begin()) + " is damaged.");
  }
  return recording;
}

}  // namespace thimble::session
