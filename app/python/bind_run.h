#pragma once

#include <pybind11/pybind11.h>

namespace thimble::python {

/// Registers the Python class Run: a session that runs as a whole, tick by tick, or in real time.
void bind_run(pybind11::module_& core);

}  // namespace thimble::python
