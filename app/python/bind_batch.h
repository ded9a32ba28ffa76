#pragma once

#include <pybind11/pybind11.h>

namespace thimble::python {

/// Makes the classes Meshes and Batch known to Python: what runs share, and many runs of one scene
/// stepped by one call.
void bind_batch(pybind11::module_& core);

}  // namespace thimble::python
