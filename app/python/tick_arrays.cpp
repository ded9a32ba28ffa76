#include "tick_arrays.h"

#include <pybind11/stl.h>

#include <cstring>

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

}  // namespace

py::array array_of(std::span<const TickRecord> ticks) {
  py::array array(tick_type(), static_cast<py::ssize_t>(ticks.size()));
  if (!ticks.empty()) std::memcpy(array.mutable_data(), ticks.data(), ticks.size_bytes());
  return array;
}

py::object one(const TickRecord& tick) {
  return array_of({&tick, 1})[py::int_(0)];
}

py::dict info_of(const session::RecordingInfo& info) {
  py::dict told;
  told["scene"] = info.scene;
  told["scene_file"] = info.scene_file;
  told["scene_text"] = info.scene_text;
  told["arm"] = info.arm;
  told["arm_file"] = info.arm_file;
  told["arm_text"] = info.arm_text;
  told["device"] = info.device;
  told["clock"] = info.clock;
  told["program"] = info.program;
  told["rate"] = info.rate;
  told["seed"] = info.seed;
  told["arm_in_scene"] = info.arm_in_scene;
  told["options"] = info.options;
  told["inside_at_start"] = info.inside_at_start;
  return told;
}

}  // namespace thimble::python
