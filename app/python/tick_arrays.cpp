#include "tick_arrays.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

namespace py = pybind11;

namespace thimble::python {
namespace {

using driver::TickRecord;
using Type = session::RecordingColumn::Type;

const char* numpy_type(const session::RecordingColumn& column) {
  switch (column.type) {
    case Type::kU8:
      return "u1";
    case Type::kU16:
      return "u2";
    case Type::kI16:
      return "i2";
    case Type::kI32:
      return "i4";
    case Type::kI64:
      return "i8";
    case Type::kU64:
      return "u8";
    case Type::kF32:
      return "f4";
    case Type::kF64:
      return "f8";
  }
  return "";
}

py::dtype make_tick_type() {
  py::list names, formats, offsets;
  for (const session::RecordingColumn& column : session::recording_columns()) {
    names.append(column.name);
    const py::str format = numpy_type(column);
    formats.append(column.width == 1 ? py::object(format)
                                     : py::object(py::make_tuple(format, column.width)));
    offsets.append(column.offset);
  }
  return py::dtype(names, formats, offsets, sizeof(TickRecord));
}

/// Returns numpy's type of a tick: the columns of a recording, with the same names. It is made once
/// and never destroyed, because Python ends before C++ destructors run.
const py::dtype& tick_type() {
  static const auto* const type = new py::dtype(make_tick_type());
  return *type;
}

/// A range of bytes of a record.
struct Gap {
  std::size_t offset, size;
};

/// Returns the bytes of a tick that no column covers: padding, whose values are arbitrary.
std::vector<Gap> find_gaps() {
  std::array<bool, sizeof(TickRecord)> covered{};
  for (const session::RecordingColumn& column : session::recording_columns()) {
    // The digit of numpy's type is its size.
    const auto size = static_cast<std::size_t>(numpy_type(column)[1] - '0') * column.width;
    std::fill_n(covered.begin() + static_cast<std::ptrdiff_t>(column.offset), size, true);
  }
  std::vector<Gap> gaps;
  for (std::size_t byte = 0; byte < covered.size(); ++byte) {
    if (covered[byte]) continue;
    if (gaps.empty() || gaps.back().offset + gaps.back().size != byte) gaps.push_back({byte, 0});
    ++gaps.back().size;
  }
  return gaps;
}

}  // namespace

// The padding is cleared, so that the bytes of equal ticks are equal.
py::array array_of(std::span<const TickRecord> ticks) {
  static const std::vector<Gap> gaps = find_gaps();
  py::array array(tick_type(), static_cast<py::ssize_t>(ticks.size()));
  if (ticks.empty()) return array;
  std::memcpy(array.mutable_data(), ticks.data(), ticks.size_bytes());
  auto* bytes = static_cast<unsigned char*>(array.mutable_data());
  for (std::size_t tick = 0; tick < ticks.size(); ++tick, bytes += sizeof(TickRecord)) {
    for (const Gap& gap : gaps) std::memset(bytes + gap.offset, 0, gap.size);
  }
  return array;
}

py::object one(const TickRecord& tick) {
  return array_of({&tick, 1})[py::int_(0)];
}

py::dict info_of(const session::RecordingInfo& info) {
  py::dict info_dict;
  info_dict["scene"] = info.scene;
  info_dict["scene_file"] = info.scene_file;
  info_dict["scene_text"] = info.scene_text;
  info_dict["arm"] = info.arm;
  info_dict["arm_file"] = info.arm_file;
  info_dict["arm_text"] = info.arm_text;
  info_dict["device"] = info.device;
  info_dict["clock"] = info.clock;
  info_dict["program"] = info.program;
  info_dict["rate"] = info.rate;
  info_dict["seed"] = info.seed;
  info_dict["arm_in_scene"] = info.arm_in_scene;
  info_dict["options"] = info.options;
  info_dict["inside_at_start"] = info.inside_at_start;
  info_dict["file_hashes"] = info.file_hashes;
  return info_dict;
}

}  // namespace thimble::python
