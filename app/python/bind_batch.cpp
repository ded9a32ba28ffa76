#include "bind_batch.h"

#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "scene_run.h"
#include "stability/tuning.h"
#include "thimble/render/scene_touch.h"
#include "thimble/scene/scene_file.h"
#include "thimble/scene/shared_meshes.h"
#include "thimble/session/session_batch.h"
#include "thimble_error.h"
#include "tick_arrays.h"

namespace py = pybind11;

namespace thimble::python {
namespace {

using Counts = py::array_t<std::uint32_t, py::array::c_style | py::array::forcecast>;
using Places = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Seeds = py::array_t<std::uint64_t, py::array::c_style | py::array::forcecast>;

/// Many runs of one scene, held by Python. Only one thread may use it, and the GIL is released
/// during a step, so a second thread gets an error.
class PythonBatch {
 public:
  PythonBatch(RunOptions options, std::size_t count) {
    session::SessionOptions asked = session_options(options);
    asked.knobs = false;
    asked.several_arms = false;
    asked.keep = session::Keep::kNewest;
    const std::filesystem::path scene = named_by(scene::find_scene(options.scene));
    const py::gil_scoped_release others;
    batch_ = read_from(scene, session::SessionBatch::open(scene, count, asked));
  }

  std::size_t size() const { return batch_->size(); }
  const session::Session& first() const { return batch_->run(0); }

  /// Moves each hand to its row of `hands` (n, 3; m), then runs `ticks` (n,) ticks of each. Returns
  /// the newest tick of each, and which hands the arms can reach.
  py::tuple step(const Counts& ticks, const py::object& hands) {
    const auto count = static_cast<py::ssize_t>(size());
    if (ticks.size() != count) throw ArgumentError("ticks: expected one number for each arm.");
    std::vector<Eigen::Vector3d> places;
    if (!hands.is_none()) {
      const auto rows = hands.cast<Places>();
      if (rows.size() != 3 * count) throw ArgumentError("hands: expected a point for each arm.");
      for (py::ssize_t i = 0; i < count; ++i) {
        places.emplace_back(Eigen::Map<const Eigen::Vector3d>(rows.data() + 3 * i));
      }
    }
    py::array_t<std::uint8_t> reached(count);
    const std::span<std::uint8_t> answers(reached.mutable_data(), size());
    run_exclusively([&] { batch_->step({ticks.data(), size()}, places, answers); });
    return py::make_tuple(array_of(batch_->newest()), reached);
  }

  /// Restarts some of the runs, each with its seed.
  void restart(const Counts& which, const Seeds& seeds) {
    if (which.size() != seeds.size()) throw ArgumentError("seeds: expected a seed for each arm.");
    run_exclusively([&] {
      for (py::ssize_t k = 0; k < which.size(); ++k) {
        const std::size_t i = which.data()[k];
        if (i >= size()) throw ArgumentError("which: there is no arm of this number.");
        if (auto begun = batch_->restart(i, seeds.data()[k]); !begun) {
          throw ThimbleError(begun.error().message);
        }
      }
    });
  }

  /// Returns the poses of some objects in each run, (n, objects, 7): position and quaternion w x y
  /// z.
  py::array_t<double> bodies(const std::vector<std::string>& objects) const {
    if (busy_) throw ThimbleError("These arms are already being stepped.");
    std::vector<std::size_t> numbers;
    for (const std::string& name : objects) {
      const auto number = first().find_object(name);
      if (!number) throw ArgumentError("bodies: the scene has no object \"" + name + "\".");
      numbers.push_back(static_cast<std::size_t>(*number));
    }
    py::array_t<double> poses({static_cast<py::ssize_t>(size()),
                               static_cast<py::ssize_t>(objects.size()), py::ssize_t{7}});
    double* to = poses.mutable_data();
    for (std::size_t i = 0; i < size(); ++i) {
      for (const std::size_t number : numbers) {
        const render::BodyPose pose = batch_->run(i).touch().object(number).pose();
        to = std::copy(pose.p_WB.begin(), pose.p_WB.end(), to);
        to = std::copy(pose.q_WB.begin(), pose.q_WB.end(), to);
      }
    }
    return poses;
  }

 private:
  template <class Work>
  void run_exclusively(const Work& work) {
    if (busy_) throw ThimbleError("These arms are already being stepped.");
    busy_ = true;
    try {
      const py::gil_scoped_release others;
      work();
    } catch (...) {
      busy_ = false;
      throw;
    }
    busy_ = false;
  }

  std::unique_ptr<session::SessionBatch> batch_;
  bool busy_ = false;  // guarded by the GIL
};

}  // namespace

void bind_batch(py::module_& core) {
  py::class_<scene::SharedMeshes, std::shared_ptr<scene::SharedMeshes>>(core, "Meshes")
      .def(py::init<>())
      .def("drop_unused", &scene::SharedMeshes::drop_unused)
      .def_property_readonly("meshes", &scene::SharedMeshes::meshes)
      .def_property_readonly("surfaces", &scene::SharedMeshes::surfaces);
  py::class_<PythonBatch>(core, "Batch")
      .def(py::init([](const std::string& scene, std::size_t count, const std::string& arm,
                       std::optional<double> seconds, const std::string& quality,
                       std::shared_ptr<scene::SharedMeshes> meshes) {
             return std::make_unique<PythonBatch>(RunOptions{.scene = scene,
                                                             .arm_file = arm,
                                                             .seconds = seconds,
                                                             .quality = quality,
                                                             .meshes = std::move(meshes)},
                                                  count);
           }),
           py::arg("scene"), py::arg("count"), py::kw_only(), py::arg("arm") = "",
           py::arg("seconds") = py::none(), py::arg("quality") = "normal",
           py::arg("meshes") = py::none())
      .def("__len__", &PythonBatch::size)
      .def("step", &PythonBatch::step, py::arg("ticks"), py::arg("hands") = py::none())
      .def("restart", &PythonBatch::restart, py::arg("which"), py::arg("seeds"))
      .def("bodies", &PythonBatch::bodies, py::arg("objects"))
      .def_property_readonly("moving",
                             [](const PythonBatch& held) {
                               std::vector<std::string> names;
                               for (const auto& object : held.first().scene().objects) {
                                 if (object.body.motion) names.push_back(object.name);
                               }
                               return names;
                             })
      .def("warnings",
           [](const PythonBatch& held) {
             return stability::stability_warnings(held.first().scene());
           })
      .def("info", [](const PythonBatch& held) { return info_of(held.first().recording_info()); });
}

}  // namespace thimble::python
