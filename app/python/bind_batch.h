#pragma once

#include <pybind11/pybind11.h>

namespace thimble::python {

/// Registers the Python classes Meshes and Batch: meshes shared by runs, and many runs of one scene
/// stepped by one call.
void bind_batch(pybind11::module_& core);

}  // namespace thimble::python
