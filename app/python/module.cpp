// Python's module thimble._core: what of the program Python can reach. Everything that a person
// calls has its name and its words in thimble/__init__.py.
#include <pybind11/eigen.h>
#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cstring>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "files/kept_scene.h"
#include "scene_run.h"
#include "simulator_session.h"
#include "stability/tuning.h"
#include "thimble/driver/discovery.h"
#include "thimble/driver/fault.h"
#include "thimble/render/scene_touch.h"
#include "thimble/scene/arm_simulation.h"
#include "thimble/scene/build_info.h"
#include "thimble/scene/scene_file.h"
#include "thimble/scene/shipped_files.h"
#include "thimble/session/recording.h"
#include "thimble_error.h"
#include "user_folders.h"

namespace py = pybind11;

namespace thimble::python {
namespace {

using driver::TickRecord;
using Type = session::RecordingColumn::Type;

const char* numpy_type(const session::RecordingColumn& column) {
  switch (column.type) {
    case Type::kU8:
      return "u1";
    case Type::kU16:
      return "u2";
    case Type::kI16:
      return "i2";
    case Type::kI32:
      return "i4";
    case Type::kI64:
      return "i8";
    case Type::kU64:
      return "u8";
    case Type::kF32:
      return "f4";
    case Type::kF64:
      return "f8";
  }
  return "";
}

/// Returns numpy's type of a tick: the columns of a recording, by the same names.
py::dtype tick_type() {
  py::list names, formats, offsets;
  for (const session::RecordingColumn& column : session::recording_columns()) {
    names.append(column.name);
    const py::str format = numpy_type(column);
    formats.append(column.width == 1 ? py::object(format)
                                     : py::object(py::make_tuple(format, column.width)));
    offsets.append(column.offset);
  }
  return py::dtype(names, formats, offsets, sizeof(TickRecord));
}

/// Copies ticks into an array of Python's own.
py::array array_of(std::span<const TickRecord> ticks) {
  py::array array(tick_type(), static_cast<py::ssize_t>(ticks.size()));
  if (!ticks.empty()) std::memcpy(array.mutable_data(), ticks.data(), ticks.size_bytes());
  return array;
}

py::object one(const TickRecord& tick) {
  return array_of({&tick, 1})[py::int_(0)];
}

/// A force law written in Python, on the virtual clock: there a tick may last as long as it
/// likes. Whatever goes wrong in it is zero force, the end of the run, and that error to whoever
/// ran it.
class PythonLaw {
 public:
  PythonLaw(py::function law, SceneRun& run) : law_(std::move(law)), run_(run) {}

  driver::ForceCommand operator()(const driver::DeviceState& state) noexcept {
    driver::ForceCommand command = run_.session().touch()(state);
    const py::gil_scoped_acquire python;
    try {
      if (error_) throw ThimbleError("The law has failed before.");
      const py::object answer = law_(one(driver::record_of(state, command)));
      if (!answer.is_none()) {
        const auto force = py::array_t<double, py::array::forcecast>::ensure(answer);
        if (!force || force.ndim() != 1 || force.shape(0) != 3) {
          PyErr_Clear();
          throw py::value_error(
              "The force law must answer with three numbers (N, in the world), or None for the "
              "scene's own force; it answered " +
              py::repr(answer).cast<std::string>() + ".");
        }
        command.f_T_W = {force.at(0), force.at(1), force.at(2)};
      }
    } catch (...) {
      if (!error_) error_ = std::current_exception();
      command.f_T_W.setZero();
      run_.ask_to_stop();
    }
    return command;
  }

  /// Throws what went wrong in the law.
  void rethrow() {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  py::function law_;
  SceneRun& run_;
  std::exception_ptr error_;
};

/// A run with the law that Python gave it, if it did.
struct HeldRun {
  explicit HeldRun(const RunOptions& options, const py::object& own_law)
      : run((py::gil_scoped_release(), std::make_unique<SceneRun>(options))) {
    if (own_law.is_none()) return;
    law = std::make_unique<PythonLaw>(own_law.cast<py::function>(), *run);
    if (const auto set = run->session().set_law(driver::ForceLaw(*law)); !set) {
      throw ThimbleError(set.error().message);
    }
  }
  ~HeldRun() {
    const py::gil_scoped_release others;
    run.reset();
  }
  HeldRun(const HeldRun&) = delete;
  HeldRun& operator=(const HeldRun&) = delete;

  void rethrow() {
    if (law) law->rethrow();
  }

  std::unique_ptr<PythonLaw> law;
  std::unique_ptr<SceneRun> run;
};

void run_all(HeldRun& held) {
  bool interrupted = false;
  {
    const py::gil_scoped_release others;
    held.run->run([&interrupted] {
      const py::gil_scoped_acquire python;
      return interrupted = interrupted || PyErr_CheckSignals() != 0;
    });
  }
  if (interrupted) throw py::error_already_set();
  held.rethrow();
}

bool step_once(HeldRun& held, const std::optional<Eigen::Vector3d>& hand) {
  session::Session& session = held.run->session();
  if (hand && session.simulation() != nullptr && !session.lead_hand(*hand)) {
    throw ThimbleError("The arm does not reach that point of the world (m); move the hand.");
  }
  const bool more = held.run->step();
  held.rethrow();
  return more;
}

py::tuple mesh_of(const HeldRun& held, const std::optional<std::string>& object) {
  if (held.run->running()) throw ThimbleError("The run goes on; stop() it to see its meshes.");
  const session::Session& session = held.run->session();
  int number = -1;
  if (object) {
    number = session.find_object(*object).value_or(-1);
    if (number < 0) throw ThimbleError("The scene has no object \"" + *object + "\".");
  }
  const render::TriangleMesh mesh = session.mesh_now(number);
  py::array_t<double> vertices({static_cast<py::ssize_t>(mesh.vertices.size()), py::ssize_t{3}});
  py::array_t<std::int32_t> triangles(
      {static_cast<py::ssize_t>(mesh.triangles.size()), py::ssize_t{3}});
  static_assert(sizeof(Eigen::Vector3d) == 3 * sizeof(double));
  if (!mesh.vertices.empty()) {
    std::memcpy(vertices.mutable_data(), mesh.vertices.front().data(),
                mesh.vertices.size() * sizeof(Eigen::Vector3d));
  }
  if (!mesh.triangles.empty()) {
    std::memcpy(triangles.mutable_data(), mesh.triangles.data(),
                mesh.triangles.size() * sizeof(mesh.triangles[0]));
  }
  return py::make_tuple(vertices, triangles);
}

py::dict info_of(const session::RecordingInfo& info) {
  py::dict told;
  told["scene"] = info.scene;
  told["scene_file"] = info.scene_file;
  told["scene_text"] = info.scene_text;
  told["arm"] = info.arm;
  told["arm_file"] = info.arm_file;
  told["arm_text"] = info.arm_text;
  told["device"] = info.device;
  told["clock"] = info.clock;
  told["program"] = info.program;
  told["rate"] = info.rate;
  told["seed"] = info.seed;
  return told;
}

py::list figures_of(HeldRun& held) {
  py::list figures;
  for (const session::Figure& figure : session::figures_of(held.run->figures())) {
    py::dict one;
    one["name"] = figure.name;
    one["value"] = figure.value;
    one["unit"] = figure.unit;
    if (!figure.goal.empty()) {
      one["goal"] = figure.goal;
      one["met"] = figure.met();
    }
    figures.append(one);
  }
  return figures;
}

py::list named(const std::vector<scene::ShippedFile>& files) {
  py::list list;
  for (const scene::ShippedFile& file : files) {
    list.append(py::make_tuple(file.name, file.path.string(), scene::description_of(file.path)));
  }
  return list;
}

py::list devices() {
  py::list list;
  for (const driver::FoundArm& arm : value_of(driver::find_arms())) {
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

void bind_run(py::module_& core) {
  py::class_<HeldRun>(core, "Run")
      .def(py::init([](const std::string& scene, const std::string& arm, const std::string& device,
                       bool agreed, bool unchecked, bool real_time, std::optional<double> seconds,
                       std::optional<std::uint64_t> seed, const std::string& quality,
                       const std::string& record, const std::string& firmware,
                       const py::object& law, bool homed, bool no_real_time) {
             return std::make_unique<HeldRun>(RunOptions{.scene = scene,
                                                         .arm_file = arm,
                                                         .device = device,
                                                         .unchecked = unchecked,
                                                         .agreed = agreed,
                                                         .real_time = real_time,
                                                         .seconds = seconds,
                                                         .seed = seed,
                                                         .quality = quality,
                                                         .record = record,
                                                         .firmware = firmware,
                                                         .homed = homed,
                                                         .no_real_time = no_real_time},
                                              law);
           }),
           py::arg("scene"), py::kw_only(), py::arg("arm") = "", py::arg("device") = "sim",
           py::arg("agreed") = false, py::arg("unchecked") = false, py::arg("real_time") = false,
           py::arg("seconds") = py::none(), py::arg("seed") = py::none(),
           py::arg("quality") = "normal", py::arg("record") = "", py::arg("firmware") = "",
           py::arg("law") = py::none(), py::arg("homed") = false, py::arg("no_real_time") = false)
      .def("run", &run_all)
      .def("step", &step_once, py::arg("hand") = py::none())
      .def("start", [](HeldRun& held) { held.run->start(); })
      .def("stop",
           [](HeldRun& held) {
             const py::gil_scoped_release others;
             held.run->stop();
           })
      .def("ticks", [](const HeldRun& held) { return array_of(held.run->ticks()); })
      .def("latest",
           [](const HeldRun& held) -> py::object {
             TickRecord tick;
             if (!held.run->session().newest().load(tick)) return py::none();
             return one(tick);
           })
      .def("mesh", &mesh_of, py::arg("object") = py::none())
      .def("summary", [](HeldRun& held) { return session::summary(held.run->figures()); })
      .def("figures", &figures_of)
      .def("warnings",
           [](const HeldRun& held) { return app::stability_warnings(held.run->session().scene()); })
      .def("info",
           [](const HeldRun& held) { return info_of(held.run->session().recording_info()); })
      .def_property_readonly("running", [](const HeldRun& held) { return held.run->running(); })
      .def_property_readonly("end",
                             [](HeldRun& held) -> py::object {
                               const auto end = held.run->end();
                               return end ? py::object(py::str(std::string(driver::name(*end))))
                                          : py::none();
                             })
      .def_property_readonly("stride",
                             [](const HeldRun& held) { return held.run->session().stride(); })
      .def_property_readonly("objects", [](const HeldRun& held) {
        std::vector<std::string> names;
        for (const auto& object : held.run->session().scene().objects) names.push_back(object.name);
        return names;
      });
}

void bind_simulator(py::module_& core) {
  py::class_<SimulatorSession>(core, "SimulatorSession")
      .def(py::init<const std::string&, const Eigen::Vector3d&, double, std::uint64_t>(),
           py::arg("arm"), py::arg("hand"), py::arg("rate"), py::arg("seed"))
      .def(
          "step",
          [](SimulatorSession& session, const Eigen::Vector3d& force,
             const std::optional<Eigen::Vector3d>& hand) { return one(session.step(force, hand)); },
          py::arg("force"), py::arg("hand") = py::none())
      .def("activate", &SimulatorSession::activate)
      .def_property_readonly(
          "name", [](const SimulatorSession& session) { return session.device().arm().name; })
      .def_property_readonly(
          "true_force",
          [](const SimulatorSession& session) { return session.device().simulation().f_T_W(); })
      .def_property_readonly(
          "force_max",
          [](const SimulatorSession& session) { return session.device().arm().limits.force_max; })
      .def_property_readonly("workspace", [](const SimulatorSession& session) {
        const scene::WorkspaceBox& box = session.device().arm().workspace;
        return py::make_tuple(box.min_W, box.max_W);
      });
}

}  // namespace
}  // namespace thimble::python

PYBIND11_MODULE(_core, core) {
  using namespace thimble;
  using namespace thimble::python;
  py::register_exception<ThimbleError>(core, "Error", PyExc_RuntimeError);
  core.attr("version") = std::string(scene::build_info().version);
  core.attr("program") = scene::program_name();
  core.def("scenes", [] { return named(scene::shipped_scenes()); });
  core.def("arms", [] { return named(scene::shipped_arms()); });
  core.def("find_scene",
           [](const std::string& name) { return value_of(scene::find_scene(name)).string(); });
  core.def("find_arm",
           [](const std::string& name) { return value_of(scene::find_arm_file(name)).string(); });
  core.def("keep_scene", [](const std::string& text, const std::map<std::string, std::string>& set,
                            const std::string& beside, const std::string& into) {
    std::vector<scene::SceneChange> changes;
    for (const auto& [place, value] : set) changes.push_back({place, value});
    return value_of(scene::keep_scene(text, changes, beside,
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
  core.def("fault", [](int number) {
    const auto fault = static_cast<driver::Fault>(number);
    return py::make_tuple(std::string(driver::name(fault)), std::string(driver::describe(fault)));
  });
  core.def("read_recording", [](const std::string& path) {
    const session::Recording recording = value_of(session::read_recording(path));
    return py::make_tuple(info_of(recording.info), array_of(recording.ticks), recording.complete);
  });
  bind_run(core);
  bind_simulator(core);
}
