#pragma once

#include <pybind11/pybind11.h>

#include <exception>
#include <memory>

#include "scene_run.h"
#include "thimble/driver/device_state.h"
#include "thimble/driver/force_law.h"

namespace thimble::python {

/// A force law that replaces the scene's in virtual time, where the duration of a tick is
/// unlimited.
class CustomLaw {
 public:
  virtual ~CustomLaw() = default;

  /// Throws the error of the law, on each call.
  virtual void rethrow() {}
  /// Visits the Python objects held by the law, for the garbage collector (tp_traverse).
  virtual int traverse(visitproc visit, void* arg) = 0;
  /// Drops the objects that may be part of a cycle (tp_clear): the run is unreachable.
  virtual void clear() {}
  /// Computes the force of a tick; `command` is the scene's.
  virtual void change(const driver::DeviceState& state, driver::ForceCommand& command) noexcept = 0;
};

/// Makes a law from a Python function of a tick, or from a compiled function: (address, data,
/// objects to keep alive).
/// An exception of a Python function causes zero force and ends the run, and is raised in the code
/// that runs it. A compiled function cannot raise: a force that it does not set is NaN, for which
/// the gate sends zero force and sets a fault.
std::unique_ptr<CustomLaw> make_law(const pybind11::object& law, SceneRun& run);

}  // namespace thimble::python
