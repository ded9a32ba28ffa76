#include "meshes/object_mesh.h"

#include <Eigen/Geometry>
#include <utility>

#include "mesh/repair/orient_mesh.h"
#include "mesh/repair/touching_parts.h"
#include "thimble/render/mesh/mesh_file.h"
#include "thimble/render/mesh/repair_mesh.h"
#include "thimble/render/mesh/thicken_sheets.h"

namespace thimble::scene {
namespace {

// What a sheet needs of its triangles, without the guesses of a repair.
constexpr render::RepairOptions kCleanedOnly{.tolerance = 0,
                                             .weld = false,
                                             .drop = true,
                                             .close_seams = false,
                                             .split_vertices = false,
                                             .hole_share = 0,
                                             .orient = true};

}  // namespace

driver::Result<ObjectMesh> load_object_mesh(const SceneObject& object) {
  const auto about = [&object](const std::string& sentence) {
    return object.mesh_file.string() + ": " + sentence;
  };
  render::MeshFileInfo info;
  auto loaded = render::load_mesh(object.mesh_file, &info);
  if (!loaded) return loaded.error();
  ObjectMesh done;
  for (const std::string& note : info.notes) done.notes.push_back(about(note));
  render::TriangleMesh mesh = std::move(loaded).value();
  if (object.repair || object.sheet_thickness) {
    render::RepairedMesh repaired =
        render::repair_mesh(mesh, object.repair ? render::RepairOptions() : kCleanedOnly);
    for (const render::RepairChange& change : repaired.changes) {
      done.notes.push_back(about(render::describe(change)));
    }
    if (repaired.mesh.triangles.empty()) {
      return driver::Error{about("no triangle of it has an area.")};
    }
    mesh = std::move(repaired.mesh);
  }
  SceneObject placed = object;
  if (!placed.scale) placed.scale = info.unit;
  done.place = placement_of(mesh, placed);
  done.mesh_W = place_mesh(mesh, placed);
  if (object.sheet_thickness) {
    render::ThickenedMesh thick = render::thicken_sheets(done.mesh_W, *object.sheet_thickness);
    if (thick.report.sheets > 0) done.notes.push_back(about(render::describe(thick.report)));
    done.mesh_W = std::move(thick.mesh);
  }
  // What plans and draws must know the same outside as what touches.
  const render::OrientReport turned = render::orient_mesh(done.mesh_W);
  for (const std::string& note :
       {render::describe(turned), render::describe(render::find_touching_parts(done.mesh_W))}) {
    if (!note.empty()) done.notes.push_back(about(note));
  }
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : done.mesh_W.vertices) box.extend(vertex);
  done.size = {
      .side = box.sizes().maxCoeff(), .kind = info.kind, .has_unit = info.unit.has_value()};
  return done;
}

}  // namespace thimble::scene
