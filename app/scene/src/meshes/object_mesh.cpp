#include "meshes/object_mesh.h"

#include <fmt/format.h>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <future>
#include <numeric>
#include <utility>

#include "mesh/file/read_off.h"  // kCoordinateMax
#include "mesh/file/weld_mesh.h"
#include "mesh/repair/certainly_valid.h"
#include "mesh/repair/orient_mesh.h"
#include "mesh/repair/touching_parts.h"
#include "mesh_maps.h"
#include "meshes/object_tracker.h"
#include "thimble/render/mesh/mesh_file.h"
#include "thimble/render/mesh/repair_mesh.h"
#include "thimble/render/mesh/thicken_sheets.h"

namespace thimble::scene {
namespace {

// Repairs that a sheet needs before it gets a thickness, without any that guess.
constexpr render::RepairOptions kCleanedOnly{.tolerance = 0,
                                             .weld = false,
                                             .drop = true,
                                             .close_seams = false,
                                             .split_vertices = false,
                                             .hole_share = 0,
                                             .orient = true};

// Below, a thread costs more than it saves [measured: 10 us against 60 ns per triangle].
constexpr std::size_t kAsyncTrianglesMin = 20000;

/// Mesh of a file with its attributes, before any repair.
struct FileMesh {
  render::TriangleMesh mesh;
  render::MeshAttributes attributes;
};

/// Returns the maps of a touched mesh that a repair has made of the triangles `origins` of a file.
std::shared_ptr<const render::SurfaceMaps> maps_of(FileMesh file, const MeshPlacement& place,
                                                   const Eigen::Matrix3d& R_WO,
                                                   std::vector<std::int32_t> origins) {
  if (origins.empty()) {
    origins.resize(file.mesh.triangles.size());
    std::iota(origins.begin(), origins.end(), 0);
  }
  // Not render::placed: it turns the triangles of a mirrored mesh, and the attributes keep theirs.
  for (Eigen::Vector3d& p : file.mesh.vertices) {
    const Eigen::Vector3d scaled = place.scale * p;
    p = R_WO * scaled + place.p_WM;
  }
  return std::make_shared<const render::SurfaceMaps>(
      render::surface_maps_of(file.mesh.vertices, file.mesh.triangles, file.attributes, origins));
}

}  // namespace

MeshPlacement placement_of(const render::TriangleMesh& mesh, const SceneObject& object) {
  // The size is that of the box of the mesh in its file, so that a rotation of the object does not
  // change it.
  Eigen::AlignedBox3d file_box;
  Eigen::AlignedBox3d turned_box;
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    file_box.extend(vertex);
    turned_box.extend(object.R_WO * vertex);
  }
  const double largest = file_box.sizes().maxCoeff();
  const double scale =
      object.size && largest > 0 ? *object.size / largest : object.scale.value_or(1);
  return {.scale = scale, .p_WM = object.p_WO - scale * turned_box.center()};
}

render::TriangleMesh place_mesh(const render::TriangleMesh& mesh, const SceneObject& object) {
  const MeshPlacement place = placement_of(mesh, object);
  return render::placed(mesh, place.scale, object.R_WO, place.p_WM);
}

render::PagedPlace place_pages(const render::PageFile& file, const SceneObject& object) {
  Eigen::Vector3d low, high;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    low[static_cast<Eigen::Index>(axis)] = double{file.whole().min[axis]};
    high[static_cast<Eigen::Index>(axis)] = double{file.whole().max[axis]};
  }
  const double step = file.lattice().step;
  const Eigen::Vector3d center = file.lattice().origin + step * 0.5 * (low + high);
  const double largest = step * (high - low).maxCoeff();
  const double scale =
      object.size && largest > 0 ? *object.size / largest : object.scale.value_or(1);
  return {
      .scale = scale, .R_WM = object.R_WO, .p_WM = object.p_WO - scale * (object.R_WO * center)};
}

double side_of_pages(const render::PageFile& file, const render::PagedPlace& place) {
  double largest = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    largest = std::max(largest, double{file.whole().max[axis]} - double{file.whole().min[axis]});
  }
  return std::abs(place.scale) * file.lattice().step * largest;
}

double reach_of(const Scene& scene) {
  const auto side = [](const ArmFile& arm) {
    return (arm.workspace.max_W - arm.workspace.min_W).maxCoeff();
  };
  double reach = 0;
  for (const SceneArm& arm : scene.arms) reach = std::max(reach, side(arm.arm));
  return reach;
}

std::string unit_advice(const std::string& kind) {
  return kind + " names no unit: set scale: 0.001 if its unit is mm, or size (m).";
}

driver::Result<std::string> judge_size(const SceneObject& object, const ObjectSize& size,
                                       double reach) {
  if (!(reach > 0)) return std::string();
  const double reaches = size.side / reach;
  const bool stated = object.size || object.scale || size.has_unit;
  const double max_reaches = stated ? kStatedReachesMax : kReachesMax;
  // Written so that NaN counts as too large.
  if (reaches <= (stated ? max_reaches : kReachesReported)) return std::string();
  const std::string sentence =
      fmt::format("{}: {:.4g} m large, {:.0f} times the reach of the arm ({:.3g} m); ",
                  object.mesh_file.string(), size.side, reaches, reach);
  if (reaches <= max_reaches) return sentence + unit_advice(size.kind);
  if (!stated) return driver::Error{sentence + unit_advice(size.kind)};
  return driver::Error{sentence +
                       fmt::format("at most {:.0f} times are supported. Set a smaller {}.",
                                   max_reaches, object.size ? "size (m)" : "scale")};
}

driver::Result<void> check_mesh_in_memory(const render::TriangleMesh& mesh) {
  if (mesh.triangles.empty()) return driver::Error{"it has no triangle; add triangles."};
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    // Written so that NaN is rejected.
    if (mesh.vertices[i].cwiseAbs().maxCoeff() <= render::kCoordinateMax &&
        !mesh.vertices[i].hasNaN()) {
      continue;
    }
    return driver::Error{fmt::format(
        "vertex {} has a coordinate that is not a number between -1e15 and 1e15; correct it.", i)};
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (const std::int32_t corner : mesh.triangles[i]) {
      if (corner >= 0 && static_cast<std::size_t>(corner) < mesh.vertices.size()) continue;
      return driver::Error{
          fmt::format("triangle {} names vertex {}, but the vertices are 0 to {}; "
                      "correct it.",
                      i, corner, static_cast<std::int64_t>(mesh.vertices.size()) - 1)};
    }
  }
  return {};
}

driver::Result<render::TriangleMesh> read_object_mesh(const SceneObject& object,
                                                      render::MeshAttributes* attributes,
                                                      render::MeshFileInfo* info) {
  if (object.mesh) {
    if (auto good = check_mesh_in_memory(**object.mesh); !good) {
      return driver::Error{object.mesh_file.string() + ": mesh: " + good.error().message};
    }
    if (info != nullptr) info->kind = "A mesh in memory";
    return render::weld_mesh(**object.mesh);
  }
  return attributes != nullptr
             ? render::load_mesh_with_attributes(object.mesh_file, *attributes, info)
             : render::load_mesh(object.mesh_file, info);
}

driver::Result<ObjectMesh> load_object_mesh(const SceneObject& object) {
  const auto about = [&object](const std::string& sentence) {
    return object.mesh_file.string() + ": " + sentence;
  };
  render::MeshFileInfo info;
  const bool with_maps = object.needs_maps();
  FileMesh file;
  auto loaded = read_object_mesh(object, with_maps ? &file.attributes : nullptr, &info);
  if (!loaded) return loaded.error();
  ObjectMesh done;
  for (const std::string& note : info.notes) done.notes.push_back(about(note));
  render::TriangleMesh mesh = std::move(loaded).value();
  if (with_maps) file.mesh = mesh;
  std::vector<std::int32_t> origins;  // empty: not repaired
  if (object.repair || object.sheet_thickness) {
    render::RepairedMesh repaired =
        render::repair_mesh(mesh, object.repair ? render::RepairOptions() : kCleanedOnly);
    for (const render::RepairChange& change : repaired.changes) {
      done.notes.push_back(about(render::describe(change)));
    }
    if (repaired.mesh.triangles.empty()) {
      return driver::Error{about("no triangle has an area; export the mesh again.")};
    }
    mesh = std::move(repaired.mesh);
    origins = std::move(repaired.origins);
  }
  SceneObject placed = object;
  if (!placed.scale) placed.scale = info.unit;
  done.place = placement_of(mesh, placed);
  done.mesh_W = place_mesh(mesh, placed);
  mesh = render::TriangleMesh();  // not needed any more, and a large mesh takes much memory
  if (with_maps) {
    done.maps = maps_of(std::move(file), done.place, object.R_WO, std::move(origins));
  }
  if (object.sheet_thickness) {
    render::ThickenedMesh thick = render::thicken_sheets(done.mesh_W, *object.sheet_thickness);
    if (thick.report.sheets > 0) done.notes.push_back(about(render::describe(thick.report)));
    done.mesh_W = std::move(thick.mesh);
  }
  // Chosen meanwhile, as if the mesh were valid.
  std::future<render::ChosenTracker> suitable;
  if (done.mesh_W.triangles.size() >= kAsyncTrianglesMin && takes_suitable_tracker(object)) {
    suitable = std::async(std::launch::async | std::launch::deferred,
                          [&done] { return render::choose_tracker(done.mesh_W); });
  }
  // Planning, drawing and contact must use the same outside.
  done.is_valid = render::certainly_valid(done.mesh_W);
  if (suitable.valid()) {
    render::ChosenTracker chosen = suitable.get();
    if (done.is_valid) done.suitable = std::move(chosen);
  }
  if (!done.is_valid) {
    const render::OrientReport turned = render::orient_mesh(done.mesh_W);
    for (const std::string& note :
         {render::describe(turned), render::describe(render::find_touching_parts(done.mesh_W))}) {
      if (!note.empty()) done.notes.push_back(about(note));
    }
  }
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : done.mesh_W.vertices) box.extend(vertex);
  done.size = {
      .side = box.sizes().maxCoeff(), .kind = info.kind, .has_unit = info.unit.has_value()};
  return done;
}

}  // namespace thimble::scene
