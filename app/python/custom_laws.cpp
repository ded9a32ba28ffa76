#include "custom_laws.h"

#include <pybind11/numpy.h>

#include <cstdint>
#include <limits>
#include <string>
#include <utility>

#include "thimble/driver/tick_record.h"
#include "thimble_error.h"
#include "tick_arrays.h"

namespace py = pybind11;

namespace thimble::python {
namespace {

/// Converts the return value of a Python law to a force (N, world).
Eigen::Vector3d force_of(const py::object& answer) {
  const auto force = py::array_t<double, py::array::forcecast>::ensure(answer);
  if (!force || force.ndim() != 1 || force.shape(0) != 3) {
    PyErr_Clear();
    throw py::value_error(
        "law: expected a return value of three numbers (N, in the world), or None for the force of "
        "the scene; found " +
        py::repr(answer).cast<std::string>() + ".");
  }
  return {force.at(0), force.at(1), force.at(2)};
}

/// Replaces the command by the force of a Python law, whose stored energy is unknown, unless it is
/// the scene's own force.
void answer_with(const Eigen::Vector3d& f_W, driver::ForceCommand& command) noexcept {
  if (f_W == command.f_T_W) return;
  command.f_T_W = command.f_program_W = f_W;
}

/// A Python exception that can be raised repeatedly.
class StoredError {
 public:
  void keep(const py::error_already_set& error) {
    type_ = error.type();
    value_ = error.value();
    trace_ = error.trace();
  }
  explicit operator bool() const { return static_cast<bool>(type_); }
  [[noreturn]] void raise() const {
    // PyErr_Restore takes ownership of its references.
    PyErr_Restore(py::object(type_).release().ptr(), py::object(value_).release().ptr(),
                  py::object(trace_).release().ptr());
    throw py::error_already_set();
  }
  int traverse(visitproc visit, void* arg) const {
    Py_VISIT(type_.ptr());
    Py_VISIT(value_.ptr());
    Py_VISIT(trace_.ptr());
    return 0;
  }
  void clear() { type_ = value_ = trace_ = py::object(); }

 private:
  py::object type_, value_, trace_;
};

class PythonLaw final : public CustomLaw {
 public:
  PythonLaw(py::function law, SceneRun& run) : law_(std::move(law)), run_(run) {}

  void change(const driver::DeviceState& state, driver::ForceCommand& command) noexcept override {
    const py::gil_scoped_acquire python;
    try {
      if (error_ || !law_) throw py::value_error("law: it has already raised an exception.");
      const py::object answer = law_(one(driver::record_of(state, command)));
      if (!answer.is_none()) answer_with(force_of(answer), command);
      return;
    } catch (const py::error_already_set& error) {
      if (!error_) error_.keep(error);
    } catch (const py::builtin_exception& error) {
      if (!error_) {
        error.set_error();
        error_.keep(py::error_already_set());
      }
    } catch (const std::exception& error) {
      if (!error_) {
        PyErr_SetString(PyExc_RuntimeError, error.what());
        error_.keep(py::error_already_set());
      }
    }
    command.f_T_W.setZero();
    command.f_program_W.setZero();
    run_.ask_to_stop();
  }

  void rethrow() override {
    if (error_) error_.raise();
  }
  int traverse(visitproc visit, void* arg) override {
    Py_VISIT(law_.ptr());
    return error_.traverse(visit, arg);
  }
  void clear() override {
    law_ = py::object();
    error_.clear();
  }

 private:
  py::object law_;  // a function; null after the garbage collector has cleared it
  SceneRun& run_;
  StoredError error_;
};

/// A function by its address.
class CompiledLaw final : public CustomLaw {
 public:
  using Function = void (*)(double time, const double tip[3], const double velocity[3],
                            const double wanted[3], double force[3], void* data);

  CompiledLaw(std::uintptr_t address, std::uintptr_t data, py::object kept)
      : function_(reinterpret_cast<Function>(address)),
        data_(reinterpret_cast<void*>(data)),
        kept_(std::move(kept)) {}

  void change(const driver::DeviceState& state, driver::ForceCommand& command) noexcept override {
    const Eigen::Vector3d wanted = command.f_T_W;
    // A function that returns early sets no force, and the gate treats NaN as no force.
    command.f_T_W.setConstant(std::numeric_limits<double>::quiet_NaN());
    function_(1e-9 * static_cast<double>(state.time_ns), state.p_WT.data(), state.v_WT.data(),
              wanted.data(), command.f_T_W.data(), data_);
    if (command.f_T_W != wanted) command.f_program_W = command.f_T_W;
  }
  // The kept objects are part of the function: they are visited, but cleared only with the run.
  int traverse(visitproc visit, void* arg) override {
    Py_VISIT(kept_.ptr());
    return 0;
  }

 private:
  Function function_;
  void* data_;
  py::object kept_;  // objects that must live as long: the compiled function, the data
};

}  // namespace

std::unique_ptr<CustomLaw> make_law(const py::object& law, SceneRun& run) {
  if (!py::isinstance<py::tuple>(law)) {
    return std::make_unique<PythonLaw>(law.cast<py::function>(), run);
  }
  const auto parts = law.cast<py::tuple>();
  return std::make_unique<CompiledLaw>(parts[0].cast<std::uintptr_t>(),
                                       parts[1].cast<std::uintptr_t>(), law);
}

}  // namespace thimble::python
