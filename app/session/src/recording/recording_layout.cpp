#include "recording/recording_layout.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cstring>
#include <mutex>
#include <string>
#include <utility>

#include "recording/h5_handle.h"
#include "recording/h5_types.h"
#include "system/regular_file.h"
#include "system/run_in_sandbox.h"
#include "thimble/driver/fault.h"

namespace thimble::session {
namespace {

// Numbers are written to the file in their memory layout.
static_assert(std::endian::native == std::endian::little);

/// Contiguous data set at a known position.
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
  H5Pset_fill_time(how.id(), H5D_FILL_TIME_NEVER);  // a hole in the file reads as zeros
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
         (info.inside_at_start.empty() ||
          write_text(file, "inside_at_start", info.inside_at_start)) &&
         (info.file_hashes.empty() || write_text(file, "file_hashes", info.file_hashes)) &&
         write_text(file, "faults", faults) &&
         write_number(file, "rate", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, info.rate) &&
         write_number(file, "seed", H5T_STD_U64LE, H5T_NATIVE_UINT64, info.seed) &&
         write_number(file, "format", H5T_STD_I32LE, H5T_NATIVE_INT, kRecordingFormat);
}

/// Returns file access without HDF5's locks; OutputFile has its own.
H5Handle access_without_locks() {
  H5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_file_locking(access.id(), false, true);
  return access;
}

/// Returns whether an HDF5 file contains the entries of every recording.
bool holds_recording(const std::filesystem::path& path) {
  silence_hdf5();
  if (H5Fis_hdf5(path.c_str()) <= 0) return false;
  const H5Handle access = access_without_locks();
  const H5Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.id()), H5Fclose);
  return file.good() && H5Aexists(file.id(), "format") > 0 &&
         H5Lexists(file.id(), "scene_text", H5P_DEFAULT) > 0 &&
         H5Lexists(file.id(), "rows", H5P_DEFAULT) > 0;
}

/// Returns whether an existing file is a recording; an HDF5 file of another program is not. HDF5
/// may crash on a damaged file, so a separate process examines the file.
bool is_recording(const std::filesystem::path& path) {
  if (!driver::is_regular(path)) return false;
  const std::lock_guard library(hdf5_mutex());
  const auto found = driver::run_in_sandbox(
      [&] { return std::string(holds_recording(path) ? "recording" : ""); }, {});
  return found && !found->empty();
}

}  // namespace

const output::OutputKind kRecordingOutput{.name = "a recording",
                                          .matches = is_recording,
                                          .existing = output::Existing::kReplaceForced,
                                          .owner_only = true,
                                          .needs_file = true};

driver::Result<RecordingLayout> RecordingLayout::create(output::OutputFile file,
                                                        const RecordingInfo& info,
                                                        std::uint64_t room) {
  RecordingLayout layout(std::move(file), room);
  if (auto laid = layout.lay_out(info); !laid) return layout.file_.named(laid.error());
  return layout;
}

driver::Result<void> RecordingLayout::lay_out(const RecordingInfo& info) {
  const std::lock_guard library(hdf5_mutex());
  silence_hdf5();
  const auto refused = [this] {
    return output::cannot_write(
        file_.part(),
        "there is no space for " + std::to_string(room_) +
            " ticks, or the disk has an error. Free some space, or use another disk.");
  };
  {
    const H5Handle access = access_without_locks();
    const H5Handle file(H5Fcreate(file_.part().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.id()),
                        H5Fclose);
    if (!file.good() || !write_info(file, info)) return refused();
    for (const RecordingColumn& column : recording_columns()) {
      const std::array<hsize_t, 2> sizes{room_, column.width};
      const Laid laid =
          lay(file, column.name, type_in_memory(column),
              std::span(sizes).first(column.width == 1 ? 1 : 2), column.unit, column.about);
      if (!laid.good) return refused();
      places_.push_back(laid.place);
    }
    const hsize_t one = 1;
    const Laid rows = lay(file, "rows", H5T_STD_U64LE, {&one, 1}, "1",
                          "number of recorded ticks; later entries of the columns have no meaning");
    const Laid complete =
        lay(file, "complete", H5T_STD_U8LE, {&one, 1}, "1",
            "1 if the recording was finished and no tick is missing, otherwise 0");
    if (!rows.good || !complete.good || H5Fflush(file.id(), H5F_SCOPE_GLOBAL) < 0) return refused();
    rows_place_ = rows.place;
    complete_place_ = complete.place;
  }
  // Closing extends the file to its full size, so a full disk is detected here at the latest.
  const std::uint64_t zero = 0;
  const unsigned char no = 0;
  auto written = write_at(&zero, sizeof zero, rows_place_);
  if (written) written = write_at(&no, 1, complete_place_);
  if (written) return {};
  return output::cannot_write(file_.part(),
                              written.error().message + ". Free some space, or use another disk.");
}

driver::Result<void> RecordingLayout::write_at(const void* bytes, std::size_t size,
                                               std::uint64_t place) {
  const auto* from = static_cast<const unsigned char*>(bytes);
  while (size > 0) {
    const ssize_t written = pwrite(file_.descriptor(), from, size, static_cast<off_t>(place));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) {
      return driver::Error{output::error_text(written < 0 ? errno : ENOSPC)};
    }
    from += written;
    size -= static_cast<std::size_t>(written);
    place += static_cast<std::uint64_t>(written);
  }
  return {};
}

driver::Result<void> RecordingLayout::write_ticks(std::span<const driver::TickRecord> ticks,
                                                  std::uint64_t row) {
  const auto columns = recording_columns();
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const std::size_t bytes = columns[i].bytes();
    column_.resize(bytes * ticks.size());
    for (std::size_t k = 0; k < ticks.size(); ++k) {
      std::memcpy(column_.data() + k * bytes,
                  reinterpret_cast<const unsigned char*>(&ticks[k]) + columns[i].offset, bytes);
    }
    if (auto written = write_at(column_.data(), column_.size(), places_[i] + row * bytes);
        !written) {
      return written;
    }
  }
  return {};
}

driver::Result<void> RecordingLayout::copy_rows(const RecordingLayout& from, std::uint64_t begin,
                                                std::uint64_t end) {
  constexpr std::size_t kPiece = std::size_t{1} << 20;
  column_.resize(kPiece);
  const auto columns = recording_columns();
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const std::uint64_t last = end * columns[i].bytes();
    for (std::uint64_t at = begin * columns[i].bytes(); at < last;) {
      const ssize_t got =
          pread(from.file_.descriptor(), column_.data(), std::min<std::uint64_t>(kPiece, last - at),
                static_cast<off_t>(from.places_[i] + at));
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) return driver::Error{"the recorded ticks cannot be read back"};
      if (auto written = write_at(column_.data(), static_cast<std::size_t>(got), places_[i] + at);
          !written) {
        return written;
      }
      at += static_cast<std::uint64_t>(got);
    }
  }
  return {};
}

driver::Result<void> RecordingLayout::set_rows(std::uint64_t rows) {
  return write_at(&rows, sizeof rows, rows_place_);
}

driver::Result<void> RecordingLayout::set_complete() {
  const unsigned char yes = 1;
  return write_at(&yes, 1, complete_place_);
}

}  // namespace thimble::session
