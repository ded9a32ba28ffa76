#include "recording/h5_reader.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

#include "recording/h5_handle.h"
#include "recording/h5_types.h"

namespace thimble::session {
namespace {

constexpr std::size_t kTextMax = std::size_t{16} << 20;      // bytes; scenes have a few thousand
constexpr std::uint64_t kTicksMax = std::uint64_t{1} << 32;  // 50 days at 1 kHz
// Largest expansion factor of a deflate stream (zlib's technical details: 1032:1).
constexpr std::uint64_t kDeflateMax = 1032;
// Recordings up to 1 GiB may have any content; larger ones at most this factor times their bytes on
// disk. [chosen: allows columns of zeros that a copy stored as holes, and a compressed column]
constexpr std::uint64_t kMemoryFree = std::uint64_t{1} << 30, kMemoryPerByte = 64;

/// Recording that is being read.
struct Source {
  H5Handle file;
  std::uint64_t size;    // Size of the file, bytes.
  std::uint64_t stored;  // Bytes stored on disk.
};

/// Returns the factor by which a data set may be larger than its bytes on disk. Returns 0 if its
/// bytes are not in this file, or pass through a filter that is not built into the library.
std::uint64_t growth_of(const H5Handle& set) {
  const H5Handle how(H5Dget_create_plist(set.id()), H5Pclose);
  if (!how.good() || H5Pget_external_count(how.id()) != 0) return 0;
  const H5D_layout_t layout = H5Pget_layout(how.id());
  if (layout != H5D_CONTIGUOUS && layout != H5D_CHUNKED && layout != H5D_COMPACT) return 0;
  const int filters = H5Pget_nfilters(how.id());
  if (filters < 0) return 0;
  std::uint64_t growth = 1;
  for (int i = 0; i < filters; ++i) {
    unsigned flags = 0, config = 0;
    std::size_t values = 0;
    const H5Z_filter_t filter = H5Pget_filter2(how.id(), static_cast<unsigned>(i), &flags, &values,
                                               nullptr, 0, nullptr, &config);
    if (filter == H5Z_FILTER_DEFLATE && growth == 1) {
      growth = kDeflateMax;
    } else if (filter != H5Z_FILTER_SHUFFLE && filter != H5Z_FILTER_FLETCHER32) {
      return 0;
    }
  }
  return growth;
}

/// Opens a data set that is in the file itself, not behind a link.
H5Handle open_set(const Source& source, const char* name) {
  const hid_t file = source.file.id();
  H5L_info_t link{};
  const bool here = H5Lexists(file, name, H5P_DEFAULT) > 0 &&
                    H5Lget_info(file, name, &link, H5P_DEFAULT) >= 0 && link.type == H5L_TYPE_HARD;
  return {here ? H5Dopen2(file, name, H5P_DEFAULT) : H5I_INVALID_HID, H5Dclose};
}

/// Returns whether the file contains the given number of bytes of a data set.
bool stores(const Source& source, const H5Handle& set, std::uint64_t bytes) {
  const std::uint64_t growth = growth_of(set);
  const std::uint64_t stored = H5Dget_storage_size(set.id());
  const H5Handle how(H5Dget_create_plist(set.id()), H5Pclose);
  if (growth == 0 || !how.good() || stored > source.size) return false;
  if (H5Pget_layout(how.id()) == H5D_CONTIGUOUS) {
    const haddr_t place = H5Dget_offset(set.id());
    return place != HADDR_UNDEF && place <= source.size && bytes <= source.size - place &&
           bytes <= stored;
  }
  return bytes / growth <= stored;
}

/// Returns the sizes of a data set with one or two dimensions; both are 0 otherwise.
std::array<hsize_t, 2> sizes_of(const H5Handle& set) {
  const H5Handle space(set.good() ? H5Dget_space(set.id()) : H5I_INVALID_HID, H5Sclose);
  std::array<hsize_t, 2> sizes{0, 1};
  const int rank = space.good() ? H5Sget_simple_extent_ndims(space.id()) : -1;
  if (rank != 1 && rank != 2) return {0, 0};
  H5Sget_simple_extent_dims(space.id(), sizes.data(), nullptr);
  return sizes;
}

std::optional<std::string> read_text(const Source& source, const char* name) {
  const H5Handle set = open_set(source, name);
  if (!set.good()) return {};
  const H5Handle type(H5Dget_type(set.id()), H5Tclose);
  const H5Handle space(H5Dget_space(set.id()), H5Sclose);
  if (!type.good() || !space.good() || H5Tget_class(type.id()) != H5T_STRING ||
      H5Tis_variable_str(type.id()) != 0 || H5Sget_simple_extent_npoints(space.id()) != 1) {
    return {};
  }
  const std::size_t size = H5Tget_size(type.id());
  if (size == 0 || size > kTextMax || !stores(source, set, size)) return {};
  std::string text(size, '\0');
  const H5Handle string(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(string.id(), size);
  H5Tset_cset(string.id(), H5Tget_cset(type.id()));
  if (H5Dread(set.id(), string.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()) < 0) return {};
  text.resize(std::strlen(text.c_str()));
  return text;
}

template <class T>
bool read_attribute(const Source& source, const char* name, hid_t type, T& value) {
  if (H5Aexists(source.file.id(), name) <= 0) return false;
  const H5Handle attribute(H5Aopen(source.file.id(), name, H5P_DEFAULT), H5Aclose);
  if (!attribute.good()) return false;
  const H5Handle space(H5Aget_space(attribute.id()), H5Sclose);
  return space.good() && H5Sget_simple_extent_npoints(space.id()) == 1 &&
         H5Aread(attribute.id(), type, &value) >= 0;
}

template <class T>
bool read_one(const Source& source, const char* name, hid_t type, T& value) {
  const H5Handle set = open_set(source, name);
  return sizes_of(set) == std::array<hsize_t, 2>{1, 1} && stores(source, set, 1) &&
         H5Dread(set.id(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, &value) >= 0;
}

/// Reads the first rows of one column; empty if it does not contain them.
std::optional<std::vector<unsigned char>> read_column(const Source& source,
                                                      const RecordingColumn& column,
                                                      std::uint64_t rows) {
  const H5Handle set = open_set(source, column.name);
  const auto sizes = sizes_of(set);
  if (sizes[0] < rows || sizes[1] != column.width) return {};
  if (rows == 0) return std::vector<unsigned char>();
  const H5Handle type(H5Dget_type(set.id()), H5Tclose);
  const std::uint64_t element = type.good() ? H5Tget_size(type.id()) : 0;
  // Numbers in the file may have a smaller type; HDF5 converts them.
  if (element == 0 || element > 16 || !stores(source, set, rows * column.width * element)) {
    return {};
  }
  std::vector<unsigned char> bytes(column.bytes() * rows);
  const H5Handle all(H5Dget_space(set.id()), H5Sclose);
  const std::array<hsize_t, 2> begin{0, 0}, count{rows, column.width};
  if (H5Sselect_hyperslab(all.id(), H5S_SELECT_SET, begin.data(), nullptr, count.data(), nullptr) <
      0) {
    return {};
  }
  const hsize_t numbers = rows * column.width;
  const H5Handle flat(H5Screate_simple(1, &numbers, nullptr), H5Sclose);
  if (H5Dread(set.id(), type_in_memory(column), flat.id(), all.id(), H5P_DEFAULT, bytes.data()) <
      0) {
    return {};
  }
  return bytes;
}

/// Returns whether the file can contain the given number of ticks, and memory suffices. Each tick
/// has a different number, so the column "tick" contains no holes.
bool can_hold(const Source& source, std::uint64_t rows) {
  std::uint64_t row_bytes = sizeof(driver::TickRecord);
  for (const RecordingColumn& column : recording_columns()) row_bytes += column.bytes();
  const H5Handle ticks = open_set(source, "tick");
  if (rows > kTicksMax || sizes_of(ticks)[0] < rows) return false;
  return rows == 0 ||
         (rows * sizeof(std::uint64_t) / std::max<std::uint64_t>(growth_of(ticks), 1) <=
              source.stored &&
          rows * row_bytes <= max_recording_memory(source.stored));
}

void write_error(driver::SandboxWriter& out, const std::string& sentence) {
  const H5Head head;
  out.write(&head, sizeof head);
  out.write(sentence.data(), sentence.size());
}

H5Handle open_file(int descriptor) {
  // The library opens files by name; this name refers to the descriptor, which is known to be a
  // regular file.
  const std::string name = "/proc/self/fd/" + std::to_string(descriptor);
  const H5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  // A recording can be read while it grows, so the writer's lock is ignored.
  H5Pset_file_locking(access.id(), false, true);
  return {H5Fopen(name.c_str(), H5F_ACC_RDONLY, access.id()), H5Fclose};
}

}  // namespace

std::uint64_t max_recording_memory(std::uint64_t stored) noexcept {
  return std::max(kMemoryFree, kMemoryPerByte * std::min(stored, ~std::uint64_t{0} / 128));
}

void read_h5(int descriptor, std::uint64_t size, std::uint64_t stored, driver::SandboxWriter& out) {
  silence_hdf5();
  H5PLset_loading_state(0);  // loads no plugins from folders that a file may name
  const Source source{open_file(descriptor), size, stored};
  const rlimit none{0, 0};
  setrlimit(RLIMIT_NOFILE, &none);  // no other file can be opened, whatever this one contains
  int format = 0;
  if (!source.file.good() || !read_attribute(source, "format", H5T_NATIVE_INT, format)) {
    return write_error(out,
                       "this is not a recording. Make one with `thimble run SCENE --record FILE`.");
  }
  if (format != kRecordingFormat) {
    return write_error(out, "this recording has format " + std::to_string(format) +
                                ", this program reads " + std::to_string(kRecordingFormat) + ".");
  }
  H5Head head{.good = 1, .rows = 0, .columns = 0, .complete = 0, .seed = 0, .rate = 0};
  std::vector<std::string> texts;
  bool known = read_attribute(source, "rate", H5T_NATIVE_DOUBLE, head.rate) &&
               read_attribute(source, "seed", H5T_NATIVE_UINT64, head.seed);
  for (const RecordingText& text : kRecordingTexts) {
    auto read = read_text(source, text.name);
    known = known && (read || text.later);
    texts.push_back(std::move(read).value_or(""));
  }
  if (!known) {
    return write_error(out, "the description of the run cannot be read; the file is damaged.");
  }
  std::uint8_t complete = 0;
  if (!read_one(source, "rows", H5T_NATIVE_UINT64, head.rows) ||
      !read_one(source, "complete", H5T_NATIVE_UINT8, complete)) {
    return write_error(out, "the number of ticks cannot be read; the file is damaged.");
  }
  head.complete = complete;
  if (!can_hold(source, head.rows)) {
    return write_error(out, "its header states " + std::to_string(head.rows) +
                                " ticks, but it does not contain them; the file is damaged.");
  }
  const auto columns = recording_columns();
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const bool absent =
        columns[i].later && H5Lexists(source.file.id(), columns[i].name, H5P_DEFAULT) <= 0;
    if (!absent) head.columns |= std::uint64_t{1} << i;
  }
  out.write(&head, sizeof head);
  for (const std::string& text : texts) {
    out.write_array(text.data(), text.size());
  }
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if ((head.columns >> i & 1) == 0) continue;
    const auto bytes = read_column(source, columns[i], head.rows);
    if (!bytes) {
      out.restart();
      return write_error(out,
                         "the column " + std::string(columns[i].name) + " is missing or damaged.");
    }
    out.write(bytes->data(), bytes->size());
  }
}

}  // namespace thimble::session
