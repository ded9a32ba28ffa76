// Python's module thimble._core: the functions available to Python. The public names and their
// documentation are in thimble/__init__.py.
#include <pybind11/eigen.h>
#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bind_batch.h"
#include "bind_run.h"
#include "files/kept_scene.h"
#include "simulator_session.h"
#include "thimble/driver/discovery.h"
#include "thimble/driver/fault.h"
#include "thimble/scene/arm_simulation.h"
#include "thimble/scene/build_info.h"
#include "thimble/scene/real_arm.h"
#include "thimble/scene/scene_file.h"
#include "thimble/scene/shipped_files.h"
#include "thimble/session/recording.h"
#include "thimble_error.h"
#include "tick_arrays.h"
#include "user_folders.h"

namespace py = pybind11;

namespace thimble::python {
namespace {

/// Returns a file name as Python represents it, whatever its bytes are (os.fsdecode).
py::str file_text(const std::string& name) {
  return py::reinterpret_steal<py::str>(
      PyUnicode_DecodeFSDefaultAndSize(name.data(), static_cast<py::ssize_t>(name.size())));
}

py::list named(const std::vector<scene::ShippedFile>& files) {
  py::list list;
  for (const scene::ShippedFile& file : files) {
    list.append(py::make_tuple(file_text(file.name), file_text(file.path.string()),
                               scene::description_of(file.path)));
  }
  return list;
}

using Rows = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

py::list devices() {
  py::list list;
  for (const driver::FoundArm& arm : value_of(scene::find_arms())) {
    py::dict one;
    one["name"] = arm.name();
    one["arm"] = arm.arm;
    one["bus"] = arm.bus;
    one["where"] = arm.address;
    one["node"] = arm.node;
    one["ready"] = arm.accessible && arm.trouble.empty() &&
                   (arm.certainty == driver::Certainty::kKnown ||
                    arm.certainty == driver::Certainty::kProvesItself);
    list.append(one);
  }
  return list;
}

py::tuple workspace_of(const SimulatorSession& session) {
  const scene::WorkspaceBox& box = session.device().arm().workspace;
  return py::make_tuple(box.min_W, box.max_W);
}

/// Moves all hands to their rows of `hands` (n, 3; m), if given, then steps the arms one after the
/// other, each with its row of `forces` (n, 3; N). If one arm cannot reach its point, no hand moves
/// and no arm is stepped.
py::array step_all(const std::vector<SimulatorSession*>& arms, const Rows& forces,
                   const std::optional<Rows>& hands) {
  const auto hand_of = [&hands](std::size_t i) -> Eigen::Vector3d {
    return hands->row(static_cast<Eigen::Index>(i)).transpose();
  };
  for (std::size_t i = 0; hands && i < arms.size(); ++i) {
    if (arms[i]->reaches(hand_of(i))) continue;
    throw ArgumentError("hand: arm " + std::to_string(i) +
                        " does not reach its point (m, world). Choose another one.");
  }
  for (std::size_t i = 0; hands && i < arms.size(); ++i) arms[i]->lead(hand_of(i));
  std::vector<driver::TickRecord> ticks;
  ticks.reserve(arms.size());
  for (SimulatorSession* arm : arms) {
    ticks.push_back(arm->step(forces.row(static_cast<Eigen::Index>(ticks.size())).transpose()));
  }
  return array_of(ticks);
}

void bind_simulator(py::module_& core) {
  core.def("step_all", &step_all, py::arg("arms"), py::arg("forces"),
           py::arg("hands") = py::none());
  py::class_<SimulatorSession>(core, "SimulatorSession")
      .def(py::init<const std::string&, const Eigen::Vector3d&, double, std::uint64_t>(),
           py::arg("arm"), py::arg("hand"), py::arg("rate"), py::arg("seed"))
      .def(
          "step",
          [](SimulatorSession& session, const Eigen::Vector3d& force,
             const std::optional<Eigen::Vector3d>& hand) {
            if (hand && !session.lead(*hand)) {
              throw ArgumentError(
                  "hand: the arm does not reach this point (m, world). Choose another one.");
            }
            return one(session.step(force));
          },
          py::arg("force"), py::arg("hand") = py::none())
      .def("activate", &SimulatorSession::activate)
      .def_property_readonly("in_fault", &SimulatorSession::in_fault)
      .def_property_readonly(
          "name", [](const SimulatorSession& session) { return session.device().arm().name; })
      .def_property_readonly(
          "true_force",
          [](const SimulatorSession& session) { return session.device().simulation().f_T_W(); })
      .def_property_readonly(
          "force_max",
          [](const SimulatorSession& session) { return session.device().arm().limits.force_max; })
      .def_property_readonly("workspace", &workspace_of);
}

}  // namespace
}  // namespace thimble::python

PYBIND11_MODULE(_core, core) {
  using namespace thimble;
  using namespace thimble::python;
  py::object error = py::register_exception<ThimbleError>(core, "Error", PyExc_RuntimeError);
  error.attr("__doc__") =
      "Base class of the errors of this package. The message has the problem and its remedy.";
  py::object argument_error = py::register_exception<ArgumentError>(
      core, "ArgumentError", py::make_tuple(error, py::handle(PyExc_ValueError)));
  argument_error.attr("__doc__") =
      "An argument that names nothing that exists, or is out of bounds. The message has the "
      "allowed "
      "values.";
  for (py::object& one : {std::ref(error), std::ref(argument_error)}) {
    one.attr("__module__") = "thimble";
  }
  core.attr("version") = std::string(scene::build_info().version);
  core.attr("program") = scene::program_name();
  core.attr("pybind11_version") = std::to_string(PYBIND11_VERSION_MAJOR) + "." +
                                  std::to_string(PYBIND11_VERSION_MINOR) + "." +
                                  PYBIND11_TOSTRING(PYBIND11_VERSION_PATCH);
  core.def("scenes", [] { return named(scene::shipped_scenes()); });
  core.def("arms", [] { return named(scene::shipped_arms()); });
  core.def("find_scene",
           [](const std::string& name) { return named_by(scene::find_scene(name)).string(); });
  core.def("find_arm",
           [](const std::string& name) { return named_by(scene::find_arm_file(name)).string(); });
  core.def("keep_scene", [](const std::string& text, const std::map<std::string, std::string>& set,
                            const std::string& beside, const std::string& into) {
    std::vector<scene::SceneChange> changes;
    for (const auto& [place, value] : set) changes.push_back({place, value});
    return named_by(scene::keep_scene(text, changes, beside,
                                      into.empty() ? scene::state_folder() / "scenes"
                                                   : std::filesystem::path(into)))
        .string();
  });
  core.def("devices", &devices);
  core.def("columns", [] {
    py::list list;
    for (const auto& column : session::recording_columns()) {
      list.append(py::make_tuple(column.name, column.unit, column.about));
    }
    return list;
  });
  core.def("columns_by_axis", [] {
    py::set names;
    for (const auto& column : session::recording_columns()) {
      if (column.by_axis()) names.add(column.name);
    }
    return names;
  });
  core.def("fault", [](int number) {
    const auto fault = static_cast<driver::Fault>(number);
    return py::make_tuple(std::string(driver::name(fault)), std::string(driver::describe(fault)));
  });
  core.def("read_recording", [](const std::string& path) {
    const session::Recording recording = read_from(path, session::read_recording(path));
    return py::make_tuple(info_of(recording.info), array_of(recording.ticks), recording.complete);
  });
  bind_batch(core);
  bind_run(core);
  bind_simulator(core);
}
