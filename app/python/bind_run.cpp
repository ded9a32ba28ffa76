#include "bind_run.h"

#include <pybind11/eigen.h>
#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "custom_laws.h"
#include "scene_run.h"
#include "stability/tuning.h"
#include "thimble/render/scene_touch.h"
#include "thimble/scene/arm_simulation.h"
#include "thimble/scene/scene_file.h"
#include "thimble_error.h"
#include "tick_arrays.h"

namespace py = pybind11;

namespace thimble::python {
namespace {

using driver::TickRecord;

/// A run with its Python law, if any.
struct PythonRun {
  explicit PythonRun(const RunOptions& options, const py::object& own_law)
      : run((py::gil_scoped_release(), std::make_unique<SceneRun>(options))) {
    if (own_law.is_none()) return;
    scene_law.emplace(run->session().own_law());
    law = make_law(own_law, *run);
    if (const auto set = run->session().set_law(driver::ForceLaw(*this)); !set) {
      throw ThimbleError(set.error().message);
    }
  }
  ~PythonRun() {
    const py::gil_scoped_release others;
    run.reset();
  }
  PythonRun(const PythonRun&) = delete;
  PythonRun& operator=(const PythonRun&) = delete;

  driver::ForceCommand operator()(const driver::DeviceState& state) noexcept {
    driver::ForceCommand command = (*scene_law)(state);
    law->change(state, command);
    return command;
  }
  void rethrow() {
    if (law) law->rethrow();
  }

  std::optional<driver::ForceLaw> scene_law;  // while another law replaces it
  std::unique_ptr<CustomLaw> law;
  std::unique_ptr<SceneRun> run;
};

/// Returns the run held by a Python object; null during construction.
PythonRun* python_run_of(PyObject* self) {
  auto* instance = reinterpret_cast<py::detail::instance*>(self);
  if (!instance->simple_layout) return nullptr;  // its memory is not initialised yet
  const py::detail::value_and_holder value = instance->get_value_and_holder();
  return value.holder_constructed() ? value.value_ptr<PythonRun>() : nullptr;
}

/// Shows the law of a run to the garbage collector: laws often refer to the owner of the run, and
/// such a cycle would never be freed.
py::custom_type_setup collected() {
  return py::custom_type_setup([](PyHeapTypeObject* heap_type) {
    PyTypeObject* type = &heap_type->ht_type;
    type->tp_flags |= Py_TPFLAGS_HAVE_GC;
    type->tp_traverse = [](PyObject* self, visitproc visit, void* arg) {
      Py_VISIT(Py_TYPE(self));
      const PythonRun* held = python_run_of(self);
      return held != nullptr && held->law ? held->law->traverse(visit, arg) : 0;
    };
    // Stops tracking first: the collector may run while the run ends without the GIL.
    type->tp_dealloc = [](PyObject* self) {
      PyObject_GC_UnTrack(self);
      py::detail::pybind11_object_dealloc(self);
    };
    type->tp_clear = [](PyObject* self) {
      const PythonRun* held = python_run_of(self);
      if (held != nullptr && held->law) held->law->clear();
      return 0;
    };
  });
}

void run_all(PythonRun& held) {
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

bool step_once(PythonRun& held, const std::optional<Eigen::Vector3d>& hand) {
  session::Session& session = held.run->session();
  if (hand && session.arms() > 1) {
    throw ThimbleError("hand: requires a scene with one arm; this one has " +
                       std::to_string(session.arms()) + ".");
  }
  if (hand && session.simulation() != nullptr && !session.lead_hand(*hand)) {
    throw ArgumentError("hand: the arm does not reach this point (m, world). Choose another one.");
  }
  const bool more = held.run->step();
  held.rethrow();
  return more;
}

py::tuple mesh_of(const PythonRun& held, const std::optional<std::string>& object) {
  if (held.run->running())
    throw ThimbleError("The run has not ended. Call stop() before you read its meshes.");
  const session::Session& session = held.run->session();
  int number = -1;
  if (object) {
    number = session.find_object(*object).value_or(-1);
    if (number < 0) throw ArgumentError("The scene has no object \"" + *object + "\".");
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

/// Returns the poses of the objects that move, by name: position and quaternion w x y z.
py::dict bodies_of(const PythonRun& held) {
  if (held.run->running())
    throw ThimbleError("The run has not ended. Call stop() before you read its bodies.");
  const session::Session& session = held.run->session();
  const auto& objects = session.scene().objects;
  py::dict bodies;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (!objects[i].body.motion) continue;
    const render::BodyPose pose = session.touch().object(i).pose();
    bodies[py::str(objects[i].name)] =
        py::make_tuple(py::array_t<double>(py::ssize_t{3}, pose.p_WB.data()),
                       py::array_t<double>(py::ssize_t{4}, pose.q_WB.data()));
  }
  return bodies;
}

/// Returns the index of an arm given by Python.
std::size_t arm_of(const PythonRun& held, std::size_t arm) {
  if (arm >= held.run->session().arms())
    throw ArgumentError("arm: the scene has no arm of this number.");
  return arm;
}

py::list knobs_of(const PythonRun& held) {
  py::list list;
  for (const session::Knob& knob : held.run->session().knobs()) {
    list.append(py::make_tuple(knob.name, knob.unit, knob.min, knob.max, knob.value));
  }
  return list;
}

void turn(PythonRun& held, const std::string& name, double value) {
  if (held.run->end()) throw ThimbleError("The run is over; its knobs cannot be changed.");
  const auto turned = held.run->session().turn_knob(name, value);
  if (!turned) throw ArgumentError(turned.error().message);
}

/// Returns the stability warnings of a run's scene. They depend only on its text, the arm's and the
/// rate, and take 12 ms to compute. The last scenes are cached, because scripts often run one scene
/// repeatedly.
std::vector<std::string> warnings_of(const PythonRun& held) {
  constexpr std::size_t kScenesMax = 64;                        // scenes
  static std::map<std::string, std::vector<std::string>> kept;  // guarded by the GIL
  const scene::Scene& scene = held.run->session().scene();
  const session::RecordingInfo info = held.run->session().recording_info();
  // The text contains neither the files of further arms nor the calibration of a real arm.
  if (scene.arms.size() > 1 || info.device != "sim" || info.scene_text.empty()) {
    return stability::stability_warnings(scene);
  }
  std::string key = info.scene_text;
  for (const std::string& part : {info.arm_text, std::to_string(info.rate)}) {
    key.append(1, '\0').append(part);
  }
  const auto found = kept.find(key);
  if (found != kept.end()) return found->second;
  if (kept.size() >= kScenesMax) kept.clear();
  return kept.emplace(std::move(key), stability::stability_warnings(scene)).first->second;
}

py::list figures_of(PythonRun& held, std::size_t arm) {
  py::list figures;
  for (const session::Figure& figure : session::figures_of(held.run->figures(arm_of(held, arm)))) {
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

/// Parses the argument for the ROS 2 topics: None, True, or a dict.
std::optional<ros2::RosOptionStrings> topics_of(const py::object& asked) {
  if (asked.is_none() || (py::isinstance<py::bool_>(asked) && !asked.cast<bool>())) return {};
  ros2::RosOptionStrings words;
  if (py::isinstance<py::bool_>(asked)) return words;
  for (const auto& [key, value] : asked.cast<py::dict>()) {
    const std::string name = py::str(key);
    if (name == "namespace") {
      words.name_space = py::str(value);
    } else if (name == "names") {
      words.names = py::str(value);
    } else if (name == "domain") {
      words.domain = value.cast<std::uint32_t>();
    } else if (name == "network") {
      words.network = value.cast<bool>();
    } else if (name == "force") {
      words.force = py::str(value);
    } else if (name == "limit") {
      words.force_limit = value.cast<double>();
    } else if (name == "stale_ms") {
      words.stale_ms = value.cast<double>();
    } else if (name == "frames") {
      words.frames = py::str(value);
    } else {
      throw ArgumentError(
          "ros2: expected namespace, names, domain, network, force, limit, stale_ms or frames, "
          "found \"" +
          name + "\".");
    }
  }
  return words;
}

}  // namespace

void bind_run(py::module_& core) {
  py::class_<PythonRun>(core, "Run", collected())
      .def(py::init([](const std::string& scene, const std::string& arm, const std::string& device,
                       bool agreed, bool unchecked, bool real_time, std::optional<double> seconds,
                       std::optional<std::uint64_t> seed, const std::string& quality,
                       const std::string& record, bool overwrite, const std::string& firmware,
                       const py::object& law, bool homed, const std::string& hold_to_run,
                       bool no_real_time, const py::object& ros2,
                       std::shared_ptr<scene::SharedMeshes> meshes) {
             return std::make_unique<PythonRun>(RunOptions{.scene = scene,
                                                           .arm_file = arm,
                                                           .device = device,
                                                           .unchecked = unchecked,
                                                           .agreed = agreed,
                                                           .real_time = real_time,
                                                           .seconds = seconds,
                                                           .seed = seed,
                                                           .quality = quality,
                                                           .record = record,
                                                           .overwrite = overwrite,
                                                           .firmware = firmware,
                                                           .homed = homed,
                                                           .topics = topics_of(ros2),
                                                           .hold_to_run = hold_to_run,
                                                           .no_real_time = no_real_time,
                                                           .meshes = std::move(meshes)},
                                                law);
           }),
           py::arg("scene"), py::kw_only(), py::arg("arm") = "", py::arg("device") = "sim",
           py::arg("agreed") = false, py::arg("unchecked") = false, py::arg("real_time") = false,
           py::arg("seconds") = py::none(), py::arg("seed") = py::none(),
           py::arg("quality") = "normal", py::arg("record") = "", py::arg("overwrite") = false,
           py::arg("firmware") = "", py::arg("law") = py::none(), py::arg("homed") = false,
           py::arg("hold_to_run") = "", py::arg("no_real_time") = false,
           py::arg("ros2") = py::none(), py::arg("meshes") = py::none())
      .def("topics_report", [](const PythonRun& held) { return held.run->topics_report(); })
      .def("run", &run_all)
      .def("step", &step_once, py::arg("hand") = py::none())
      .def("hold_buttons",
           [](PythonRun& held, std::uint16_t buttons) {
             return held.run->session().hold_buttons(buttons);
           })
      .def("start", [](PythonRun& held) { held.run->start(); })
      .def("stop",
           [](PythonRun& held) {
             const py::gil_scoped_release others;
             held.run->stop();
           })
      .def(
          "ticks",
          [](const PythonRun& held, std::size_t arm) {
            return array_of(held.run->ticks(arm_of(held, arm)));
          },
          py::arg("arm") = 0)
      .def(
          "latest",
          [](const PythonRun& held, std::size_t arm) -> py::object {
            TickRecord tick;
            if (!held.run->session().newest(arm_of(held, arm)).load(tick)) return py::none();
            return one(tick);
          },
          py::arg("arm") = 0)
      .def("mesh", &mesh_of, py::arg("object") = py::none())
      .def(
          "summary",
          [](PythonRun& held, std::size_t arm) {
            return session::summary(held.run->figures(arm_of(held, arm)));
          },
          py::arg("arm") = 0)
      .def("figures", &figures_of, py::arg("arm") = 0)
      .def("warnings", &warnings_of)
      .def(
          "info",
          [](const PythonRun& held, std::size_t arm) {
            return info_of(held.run->session().recording_info(arm_of(held, arm)));
          },
          py::arg("arm") = 0)
      .def("knobs", &knobs_of)
      .def("turn", &turn, py::arg("name"), py::arg("value"))
      .def_property_readonly("arms",
                             [](const PythonRun& held) {
                               const session::Session& session = held.run->session();
                               std::vector<std::string> names;
                               for (std::size_t i = 0; session.arms() > 1 && i < session.arms();
                                    ++i) {
                                 names.push_back(session.arm_name(i));
                               }
                               return names;
                             })
      .def_property_readonly("running", [](const PythonRun& held) { return held.run->running(); })
      .def_property_readonly("end",
                             [](PythonRun& held) -> py::object {
                               const auto end = held.run->end();
                               return end ? py::object(py::str(std::string(driver::name(*end))))
                                          : py::none();
                             })
      .def_property_readonly("stride",
                             [](const PythonRun& held) { return held.run->session().stride(); })
      .def_property_readonly("trackers",
                             [](const PythonRun& held) {
                               std::map<std::string, std::pair<std::string, std::string>> trackers;
                               for (const auto& one : held.run->session().trackers()) {
                                 trackers[one.object] = {one.tracker, one.reason};
                               }
                               return trackers;
                             })
      .def_property_readonly("bodies", &bodies_of)
      .def_property_readonly("objects", [](const PythonRun& held) {
        std::vector<std::string> names;
        for (const auto& object : held.run->session().scene().objects) names.push_back(object.name);
        return names;
      });
}

}  // namespace thimble::python
