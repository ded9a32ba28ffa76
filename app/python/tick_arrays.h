#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <span>

#include "thimble/driver/tick_record.h"
#include "thimble/session/recording.h"

namespace thimble::python {

/// Copies ticks into a new numpy array, whose type has the columns of a recording.
pybind11::array array_of(std::span<const driver::TickRecord> ticks);
/// Copies one tick, as an item of such an array.
pybind11::object one(const driver::TickRecord& tick);
/// Returns the description of a run as a dict, with the names of recordings.
pybind11::dict info_of(const session::RecordingInfo& info);

}  // namespace thimble::python
