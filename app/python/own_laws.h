#pragma once

#include <pybind11/pybind11.h>

#include <exception>
#include <memory>

#include "scene_run.h"
#include "thimble/driver/device_state.h"
#include "thimble/driver/force_law.h"

namespace thimble::python {

/// A force law in place of the scene's, on the virtual clock: there a tick may last as long as it
/// likes.
class OwnLaw {
 public:
  virtual ~OwnLaw() = default;

  /// Throws what went wrong in the law, each time that it is called.
  virtual void rethrow() {}
  /// Visits the Python objects that the law holds, for the garbage collector (tp_traverse).
  virtual int traverse(visitproc visit, void* arg) = 0;
  /// Drops those of them that may be part of a cycle (tp_clear): the run is unreachable.
  virtual void clear() {}
  /// Finds the force of a tick; `command` is the scene's own.
  virtual void change(const driver::DeviceState& state, driver::ForceCommand& command) noexcept = 0;
};

/// Makes the law that Python gave, a function of a tick or, of a compiled one, (address, data,
/// what keeps them alive).
/// Of a Python function whatever goes wrong in it is zero force, the end of the run, and that error
/// to whoever ran it. A compiled one cannot raise: a force that it leaves unset is no number, which
/// the gate answers with zero force and a fault.
std::unique_ptr<OwnLaw> make_law(const pybind11::object& law, SceneRun& run);

}  // namespace thimble::python
