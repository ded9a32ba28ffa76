#pragma once

#include "recording/h5_handle.h"
#include "thimble/session/recording.h"

namespace thimble::session {

/// Returns the type in memory of a column's numbers. Real-time: never from the servo thread.
inline hid_t type_in_memory(const RecordingColumn& column) {
  switch (column.type) {
    case RecordingColumn::Type::kU8:
      return H5T_NATIVE_UINT8;
    case RecordingColumn::Type::kU16:
      return H5T_NATIVE_UINT16;
    case RecordingColumn::Type::kI16:
      return H5T_NATIVE_INT16;
    case RecordingColumn::Type::kI32:
      return H5T_NATIVE_INT32;
    case RecordingColumn::Type::kI64:
      return H5T_NATIVE_INT64;
    case RecordingColumn::Type::kU64:
      return H5T_NATIVE_UINT64;
    case RecordingColumn::Type::kF32:
      return H5T_NATIVE_FLOAT;
    case RecordingColumn::Type::kF64:
      return H5T_NATIVE_DOUBLE;
  }
  return H5I_INVALID_HID;
}

/// Version of the layout of recordings; readers reject others.
inline constexpr int kRecordingFormat = 1;

}  // namespace thimble::session
