#pragma once

#include <pybind11/pybind11.h>

namespace thimble::python {

/// Makes the class Run known to Python: a session, run at once, tick by tick, or in real time.
void bind_run(pybind11::module_& core);

}  // namespace thimble::python
