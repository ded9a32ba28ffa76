#include "recording/recording_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>
#include <system_error>

#include "recording/h5_handle.h"
#include "recording/h5_types.h"
#include "thimble/driver/fault.h"
#include "thimble/session/recording.h"

namespace thimble::session {
namespace {

// Numbers go to the file as they lie in memory.
static_assert(std::endian::native == std::endian::little);

/// One data set whose bytes lie in one piece at a place that is known from the start.
struct Laid {
  bool good = false;
  std::uint64_t place = 0;
};

Laid lay(const H5Handle& file, const char* name, hid_t type, std::span<const hsize_t> sizes,
         const char* unit, const char* about) {
  const H5Handle space(H5Screate_simple(static_cast<int>(sizes.size()), sizes.data(), nullptr),
                       H5Sclose);
  const H5Handle how(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  if (!space.good() || !how.good()) return {};
  H5Pset_layout(how.id(), H5D_CONTIGUOUS);
  H5Pset_alloc_time(how.id(), H5D_ALLOC_TIME_EARLY);
  H5Pset_fill_time(how.id(), H5D_FILL_TIME_NEVER);  // a hole in the file reads as 0
  const H5Handle set(
      H5Dcreate2(file.id(), name, type, space.id(), H5P_DEFAULT, how.id(), H5P_DEFAULT), H5Dclose);
  if (!set.good()) return {};
  for (const auto& [key, text] : {std::pair{"unit", unit}, std::pair{"about", about}}) {
    const H5Handle string(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(string.id(), std::strlen(text) + 1);
    const H5Handle scalar(H5Screate(H5S_SCALAR), H5Sclose);
    const H5Handle attribute(
        H5Acreate2(set.id(), key, string.id(), scalar.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    if (!attribute.good() || H5Awrite(attribute.id(), string.id(), text) < 0) return {};
  }
  const haddr_t place = H5Dget_offset(set.id());
  return {.good = place != HADDR_UNDEF, .place = place};
}

bool write_text(const H5Handle& file, const char* name, const std::string& text) {
  const H5Handle string(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(string.id(), text.size() + 1);
  H5Tset_cset(string.id(), H5T_CSET_UTF8);
  const H5Handle scalar(H5Screate(H5S_SCALAR), H5Sclose);
  const H5Handle set(
      H5Dcreate2(file.id(), name, string.id(), scalar.id(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
      H5Dclose);
  return set.good() &&
         H5Dwrite(set.id(), string.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, text.c_str()) >= 0;
}

template <class T>
bool write_number(const H5Handle& file, const char* name, hid_t in_file, hid_t in_memory, T value) {
  const H5Handle scalar(H5Screate(H5S_SCALAR), H5Sclose);
  const H5Handle attribute(
      H5Acreate2(file.id(), name, in_file, scalar.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  return attribute.good() && H5Awrite(attribute.id(), in_memory, &value) >= 0;
}

bool write_info(const H5Handle& file, const RecordingInfo& info) {
  std::string faults;
  for (int i = 0; i <= static_cast<int>(driver::kLastFault); ++i) {
    faults += std::to_string(i);
    faults += ' ';
    faults += name(static_cast<driver::Fault>(i));
    faults += '\n';
  }
  return write_text(file, "scene", info.scene) && write_text(file, "scene_file", info.scene_file) &&
         write_text(file, "scene_text", info.scene_text) && write_text(file, "arm", info.arm) &&
         write_text(file, "arm_file", info.arm_file) &&
         write_text(file, "arm_text", info.arm_text) && write_text(file, "device", info.device) &&
         write_text(file, "clock", info.clock) && write_text(file, "program", info.program) &&
         (info.arm_in_scene.empty() || write_text(file, "arm_in_scene", info.arm_in_scene)) &&
         (info.options.empty() || write_text(file, "options", info.options)) &&
         write_text(file, "faults", faults) &&
         write_number(file, "rate", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, info.rate) &&
         write_number(file, "seed", H5T_STD_U64LE, H5T_NATIVE_UINT64, info.seed) &&
         write_number(file, "format", H5T_STD_I32LE, H5T_NATIVE_INT, kRecordingFormat);
}

/// Returns whether there is a file with something in it that is not HDF5.
bool holds_something_else(const std::filesystem::path& path) {
  constexpr std::array<char, 8> kSignature{'\x89', 'H', 'D', 'F', '\r', '\n', '\x1a', '\n'};
  std::error_code status;
  if (!std::filesystem::is_regular_file(path, status)) return false;
  const std::uintmax_t size = std::filesystem::file_size(path, status);
  if (status || size == 0) return false;
  std::array<char, 8> begin{};
  std::ifstream(path, std::ios::binary).read(begin.data(), begin.size());
  return begin != kSignature;
}

}  // namespace

RecordingFile::RecordingFile(RecordingFile&& other) noexcept
    : path_(std::move(other.path_)),
      info_(std::move(other.info_)),
      rows_max_(other.rows_max_),
      rows_(other.rows_),
      file_(std::exchange(other.file_, -1)),
      places_(std::move(other.places_)),
      rows_place_(other.rows_place_),
      complete_place_(other.complete_place_),
      column_(std::move(other.column_)) {}

RecordingFile::~RecordingFile() {
  if (file_ >= 0) close(file_);
}

driver::Result<RecordingFile> RecordingFile::create(const std::filesystem::path& path,
                                                    const RecordingInfo& info,
                                                    std::uint64_t rows_max) {
  RecordingFile file(path, info, std::max<std::uint64_t>(rows_max, 1));
  if (auto laid = file.lay_out(); !laid) return laid.error();
  return file;
}

driver::Result<void> RecordingFile::lay_out() {
  silence_hdf5();
  if (holds_something_else(path_)) {
    return driver::Error{path_.string() +
                         ": this file is no recording, so it is not overwritten by one. Give the "
                         "recording another name, or remove the file."};
  }
  const driver::Error refused{path_.string() +
                              ": a recording cannot be written here. Is the folder there, may you "
                              "write to it, and is there room on the disk?"};
  {
    const H5Handle file(H5Fcreate(path_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT),
                        H5Fclose);
    if (!file.good() || !write_info(file, info_)) return refused;
    for (const RecordingColumn& column : recording_columns()) {
      const std::array<hsize_t, 2> sizes{rows_max_, column.width};
      const Laid laid =
          lay(file, column.name, type_in_memory(column),
              std::span(sizes).first(column.width == 1 ? 1 : 2), column.unit, column.about);
      if (!laid.good) return refused;
      places_.push_back(laid.place);
    }
    const hsize_t one = 1;
    const Laid rows = lay(file, "rows", H5T_STD_U64LE, {&one, 1}, "1",
                          "ticks recorded; what the columns hold beyond them means nothing");
    const Laid complete = lay(file, "complete", H5T_STD_U8LE, {&one, 1}, "1",
                              "1 if the recording was ended, 0 if it was cut off");
    if (!rows.good || !complete.good || H5Fflush(file.id(), H5F_SCOPE_GLOBAL) < 0) return refused;
    rows_place_ = rows.place;
    complete_place_ = complete.place;
  }
  file_ = open(path_.c_str(), O_RDWR | O_CLOEXEC);
  if (file_ < 0) return refused;
  return {};
}

driver::Result<void> RecordingFile::write_at(const void* bytes, std::size_t size,
                                             std::uint64_t place) {
  const auto* from = static_cast<const unsigned char*>(bytes);
  while (size > 0) {
    const ssize_t written = pwrite(file_, from, size, static_cast<off_t>(place));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) {
      const std::string why = std::generic_category().message(written < 0 ? errno : ENOSPC);
      return driver::Error{path_.string() + ": the recording ends after " + std::to_string(rows_) +
                           " ticks: " + why + "."};
    }
    from += written;
    size -= static_cast<std::size_t>(written);
    place += static_cast<std::uint64_t>(written);
  }
  return {};
}

driver::Result<void> RecordingFile::append(std::span<const driver::TickRecord> ticks) {
  ticks = ticks.first(std::min<std::size_t>(ticks.size(), rows_max_ - rows_));
  if (ticks.empty()) return {};
  const auto columns = recording_columns();
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const std::size_t bytes = columns[i].bytes();
    column_.resize(bytes * ticks.size());
    for (std::size_t k = 0; k < ticks.size(); ++k) {
      std::memcpy(column_.data() + k * bytes,
                  reinterpret_cast<const unsigned char*>(&ticks[k]) + columns[i].offset, bytes);
    }
    if (auto written = write_at(column_.data(), column_.size(), places_[i] + rows_ * bytes);
        !written) {
      return written;
    }
  }
  // Only now do they count.
  const std::uint64_t rows = rows_ + ticks.size();
  if (auto written = write_at(&rows, sizeof rows, rows_place_); !written) return written;
  rows_ = rows;
  return {};
}

driver::Result<void> RecordingFile::copy_rows_to(RecordingFile& other) {
  constexpr std::size_t kPiece = std::size_t{1} << 20;
  column_.resize(kPiece);
  const auto columns = recording_columns();
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const std::uint64_t size = rows_ * columns[i].bytes();
    for (std::uint64_t at = 0; at < size;) {
      const ssize_t got = pread(file_, column_.data(), std::min<std::uint64_t>(kPiece, size - at),
                                static_cast<off_t>(places_[i] + at));
      if (got <= 0) return driver::Error{path_.string() + ": cannot be read again."};
      if (auto written =
              other.write_at(column_.data(), static_cast<std::size_t>(got), other.places_[i] + at);
          !written) {
        return written;
      }
      at += static_cast<std::uint64_t>(got);
    }
  }
  other.rows_ = rows_;
  return other.write_at(&rows_, sizeof rows_, other.rows_place_);
}

driver::Result<void> RecordingFile::finish() {
  const unsigned char yes = 1;
  if (rows_ == rows_max_) return write_at(&yes, 1, complete_place_);
  // A data set in one piece cannot shrink: a shorter file takes this one's place.
  std::filesystem::path part = path_;
  part += ".part";
  auto shorter = create(part, info_, rows_);
  if (!shorter) return shorter.error();
  auto moved = copy_rows_to(*shorter);
  if (moved) moved = shorter->write_at(&yes, 1, shorter->complete_place_);
  std::error_code status;
  if (moved) std::filesystem::rename(part, path_, status);
  if (!moved || status) {
    std::filesystem::remove(part, status);
    // What was recorded is all in the longer file.
    return write_at(&yes, 1, complete_place_);
  }
  return {};
}

driver::Result<void> write_recording(const std::filesystem::path& path, const RecordingInfo& info,
                                     std::span<const driver::TickRecord> ticks) {
  auto file = RecordingFile::create(path, info, ticks.size());
  if (!file) return file.error();
  if (auto written = file->append(ticks); !written) return written;
  return file->finish();
}

std::filesystem::path file_of_arm(const std::filesystem::path& path,
                                  const std::string& arm_in_scene) {
  if (arm_in_scene.empty()) return path;
  return path.parent_path() /
         (path.stem().string() + "_" + arm_in_scene + path.extension().string());
}

}  // namespace thimble::session
