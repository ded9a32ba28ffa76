#include "thimble/session/recording.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <string>
#include <system_error>

#include "recording/h5_handle.h"
#include "recording/h5_types.h"

namespace thimble::session {
namespace {

constexpr std::size_t kTextMax = std::size_t{16} << 20;      // bytes; scenes have some thousand
constexpr std::uint64_t kTicksMax = std::uint64_t{1} << 32;  // 50 days at 1 kHz

H5Handle open_set(const H5Handle& file, const char* name) {
  return {H5Lexists(file.id(), name, H5P_DEFAULT) > 0 ? H5Dopen2(file.id(), name, H5P_DEFAULT)
                                                      : H5I_INVALID_HID,
          H5Dclose};
}

/// Returns the sizes of a data set of numbers, both 0 if it is none.
std::array<hsize_t, 2> sizes_of(const H5Handle& set) {
  const H5Handle space(set.good() ? H5Dget_space(set.id()) : H5I_INVALID_HID, H5Sclose);
  std::array<hsize_t, 2> sizes{0, 1};
  const int rank = space.good() ? H5Sget_simple_extent_ndims(space.id()) : -1;
  if (rank != 1 && rank != 2) return {0, 0};
  H5Sget_simple_extent_dims(space.id(), sizes.data(), nullptr);
  return sizes;
}

std::optional<std::string> read_text(const H5Handle& file, const char* name) {
  const H5Handle set = open_set(file, name);
  if (!set.good()) return {};
  const H5Handle type(H5Dget_type(set.id()), H5Tclose);
  const H5Handle space(H5Dget_space(set.id()), H5Sclose);
  if (!type.good() || !space.good() || H5Tget_class(type.id()) != H5T_STRING ||
      H5Tis_variable_str(type.id()) != 0 || H5Sget_simple_extent_npoints(space.id()) != 1) {
    return {};
  }
  const std::size_t size = H5Tget_size(type.id());
  if (size == 0 || size > kTextMax) return {};
  std::string text(size, '\0');
  const H5Handle string(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(string.id(), size);
  H5Tset_cset(string.id(), H5Tget_cset(type.id()));
  if (H5Dread(set.id(), string.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()) < 0) return {};
  text.resize(std::strlen(text.c_str()));
  return text;
}

template <class T>
bool read_attribute(const H5Handle& file, const char* name, hid_t type, T& value) {
  if (H5Aexists(file.id(), name) <= 0) return false;
  const H5Handle attribute(H5Aopen(file.id(), name, H5P_DEFAULT), H5Aclose);
  if (!attribute.good()) return false;
  const H5Handle space(H5Aget_space(attribute.id()), H5Sclose);
  return space.good() && H5Sget_simple_extent_npoints(space.id()) == 1 &&
         H5Aread(attribute.id(), type, &value) >= 0;
}

template <class T>
bool read_one(const H5Handle& file, const char* name, hid_t type, T& value) {
  const H5Handle set = open_set(file, name);
  return sizes_of(set) == std::array<hsize_t, 2>{1, 1} &&
         H5Dread(set.id(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, &value) >= 0;
}

/// Puts a question mark for each character that would move a terminal instead of being shown.
void make_printable(std::string& text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    const auto before = static_cast<unsigned char>(i > 0 ? text[i - 1] : 0);
    const bool second_control = before == 0xC2 && c >= 0x80 && c < 0xA0;  // U+0080 to U+009F
    if (c < 0x20 || c == 0x7F || second_control) text[i] = '?';
    if (second_control) text[i - 1] = '?';
  }
}

bool read_info(const H5Handle& file, RecordingInfo& info) {
  for (const auto& [name, text] :
       {std::pair{"scene", &info.scene}, std::pair{"scene_file", &info.scene_file},
        std::pair{"scene_text", &info.scene_text}, std::pair{"arm", &info.arm},
        std::pair{"arm_file", &info.arm_file}, std::pair{"arm_text", &info.arm_text},
        std::pair{"device", &info.device}, std::pair{"clock", &info.clock},
        std::pair{"program", &info.program}}) {
    auto read = read_text(file, name);
    if (!read) return false;
    *text = std::move(*read);
  }
  info.arm_in_scene = read_text(file, "arm_in_scene").value_or("");
  info.inside_at_start = read_text(file, "inside_at_start").value_or("");
  // What a person is told of; the texts of files stay as they were.
  for (std::string* name : {&info.scene, &info.arm, &info.device, &info.clock, &info.program,
                            &info.arm_in_scene, &info.inside_at_start}) {
    make_printable(*name);
  }
  return read_attribute(file, "rate", H5T_NATIVE_DOUBLE, info.rate) && info.rate > 0 &&
         read_attribute(file, "seed", H5T_NATIVE_UINT64, info.seed);
}

/// Reads the first rows of one column into the ticks.
bool read_column(const H5Handle& file, const RecordingColumn& column,
                 std::vector<driver::TickRecord>& ticks) {
  const H5Handle set = open_set(file, column.name);
  const auto sizes = sizes_of(set);
  if (sizes[0] < ticks.size() || sizes[1] != column.width) return false;
  if (ticks.empty()) return true;
  std::vector<unsigned char> bytes(column.bytes() * ticks.size());
  const H5Handle all(H5Dget_space(set.id()), H5Sclose);
  const std::array<hsize_t, 2> begin{0, 0}, count{ticks.size(), column.width};
  if (H5Sselect_hyperslab(all.id(), H5S_SELECT_SET, begin.data(), nullptr, count.data(), nullptr) <
      0) {
    return false;
  }
  const hsize_t numbers = ticks.size() * column.width;
  const H5Handle flat(H5Screate_simple(1, &numbers, nullptr), H5Sclose);
  if (H5Dread(set.id(), type_in_memory(column), flat.id(), all.id(), H5P_DEFAULT, bytes.data()) <
      0) {
    return false;
  }
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    std::memcpy(reinterpret_cast<unsigned char*>(&ticks[i]) + column.offset,
                bytes.data() + i * column.bytes(), column.bytes());
  }
  return true;
}

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
             static_cast<unsigned>(driver::DeviceStage::kFault) &&
         byte_at(offsetof(driver::TickRecord, fault)) <=
             static_cast<unsigned>(driver::kLastFault) &&
         byte_at(offsetof(driver::TickRecord, link)) <=
             static_cast<unsigned>(driver::kLastLinkState) &&
         byte_at(offsetof(driver::TickRecord, home_needed)) <= 1;
}

}  // namespace

driver::Result<Recording> read_recording(const std::filesystem::path& path) {
  silence_hdf5();
  std::error_code status;
  if (!std::filesystem::is_regular_file(path, status)) {
    return driver::Error{path.string() + ": there is no such file."};
  }
  const auto wrong = [&](const std::string& what) {
    return driver::Error{path.string() + ": " + what};
  };
  const H5Handle file(H5Fis_hdf5(path.c_str()) > 0
                          ? H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT)
                          : H5I_INVALID_HID,
                      H5Fclose);
  int format = 0;
  if (!file.good() || !read_attribute(file, "format", H5T_NATIVE_INT, format)) {
    return wrong("this is not a recording. `thimble run SCENE --record FILE` makes one.");
  }
  if (format != kRecordingFormat) {
    return wrong("this recording has format " + std::to_string(format) + ", this program reads " +
                 std::to_string(kRecordingFormat) + ".");
  }
  Recording recording;
  if (!read_info(file, recording.info)) {
    return wrong("what the recording is of cannot be read; the file is damaged.");
  }
  std::uint64_t rows = 0;
  std::uint8_t complete = 0;
  if (!read_one(file, "rows", H5T_NATIVE_UINT64, rows) ||
      !read_one(file, "complete", H5T_NATIVE_UINT8, complete)) {
    return wrong("the number of ticks cannot be read; the file is damaged.");
  }
  // Before memory is asked for: are there so many?
  if (rows > kTicksMax || sizes_of(open_set(file, "tick"))[0] < rows) {
    return wrong("it claims " + std::to_string(rows) + " ticks and does not hold them.");
  }
  recording.complete = complete == 1;
  recording.ticks.resize(rows);
  for (const RecordingColumn& column : recording_columns()) {
    if (column.later && H5Lexists(file.id(), column.name, H5P_DEFAULT) <= 0) continue;
    if (!read_column(file, column, recording.ticks)) {
      return wrong("the column " + std::string(column.name) + " is missing or damaged.");
    }
  }
  const auto bad = std::find_if_not(recording.ticks.begin(), recording.ticks.end(), sound);
  if (bad != recording.ticks.end()) {
    return wrong("row " + std::to_string(bad - recording.ticks.begin()) + " is damaged.");
  }
  return recording;
}

}  // namespace thimble::session
