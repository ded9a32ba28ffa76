#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "disk_paging/paged_contact.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/render/build_object_touch.h"
#include "thimble/render/mesh/mesh_file.h"
#include "thimble/render/mesh/triangle_mesh.h"
#include "thimble/scene/scene_file.h"

namespace thimble::scene {

/// Placement of a mesh file in the world: p_W = p_WM + scale R_WO p, with p as in the file.
struct MeshPlacement {
  double scale = 1;               ///< Metres per unit of the file.
  Eigen::Vector3d p_WM{0, 0, 0};  ///< Position in the world, m.
};

/// Returns the placement of an object's mesh in the world. Precondition: the mesh has a vertex.
/// Real-time: never from the servo thread.
MeshPlacement placement_of(const render::TriangleMesh& mesh, const SceneObject& object);

/// Returns a mesh from a file placed in the world (m) as specified by `object`. Precondition: the
/// mesh has a vertex. Real-time: never from the servo thread.
render::TriangleMesh place_mesh(const render::TriangleMesh& mesh, const SceneObject& object);

/// Returns the placement of a mesh paged from disk, as specified by `object`. It is rotated about
/// the centre of its bounding box in the file, because the bounding box of the rotated mesh is
/// unknown. Real-time: never from the servo thread.
render::PagedPlace place_pages(const render::PageFile& file, const SceneObject& object);

/// Returns the largest side of the bounding box in the world of a mesh paged from disk, m.
double side_of_pages(const render::PageFile& file, const render::PagedPlace& place);

/// Largest size of a mesh of unknown unit, as a multiple of the reach of the arm. The unit is
/// unknown if neither the file nor the scene (size, scale) defines it. [chosen: a part of 5 mm that
/// is read in m exceeds it for every shipped arm].
inline constexpr double kReachesMax = 20;

/// Largest size of any mesh, as a multiple of the reach. The shape of a larger mesh cannot be felt.
inline constexpr double kStatedReachesMax = 100;

/// Size from which a mesh of unknown unit is reported, as a multiple of the reach.
inline constexpr double kReachesReported = 5;

/// Size of a mesh in a scene.
struct ObjectSize {
  double side = 0;       ///< Largest side of its bounding box in the world, m.
  std::string kind;      ///< File format, such as "STL"; for messages.
  bool has_unit = true;  ///< True if the file defines a unit.
};

/// Returns the reach of the arms of a scene: the largest side of their workspaces, m; 0 if no arm
/// has one. Real-time: never from the servo thread.
double reach_of(const Scene& scene);

/// Returns the fix for a format without a unit: "STL names no unit: set scale: 0.001 ...".
THIMBLE_EXPORT std::string unit_advice(const std::string& kind);

/// Returns a warning about an object that is far larger than the `reach` of the arm (m); empty if
/// it is not, or if the reach is 0. Fails if the object is too large. The error names its file, its
/// size and the keys to set. Real-time: never from the servo thread.
driver::Result<std::string> judge_size(const SceneObject& object, const ObjectSize& size,
                                       double reach);

/// Mesh of an object as it is touched and drawn, with its placement.
struct ObjectMesh {
  /// Mesh, repaired and thickened if the object specifies it; W, m.
  render::TriangleMesh mesh_W;
  MeshPlacement place;             ///< Placement of the file's coordinates in the world.
  ObjectSize size;                 ///< Size of the mesh in the world.
  std::vector<std::string> notes;  ///< Repairs, omissions and assumptions, one sentence each.
  /// Texture coordinates and vertex colours, if the object uses them.
  std::shared_ptr<const render::SurfaceMaps> maps;
  bool is_valid = false;  ///< Whether the mesh is certainly_valid.
  /// Tracker that suits the mesh alone (render::choose_tracker), if it was chosen while the mesh
  /// was checked.
  std::optional<render::ChosenTracker> suitable;
  std::string cache_key;  ///< Key in the mesh cache (MeshCache); empty: not stored.
};

/// Fails if a mesh of a program has no triangle, names a vertex that it does not have, or has a
/// coordinate that a mesh file may not have. Real-time: never from the servo thread.
driver::Result<void> check_mesh_in_memory(const render::TriangleMesh& mesh);

/// Returns the mesh of an object before any repair: of its file (render::load_mesh), or in memory,
/// checked and welded in the same way. `attributes`, if not null, get texture coordinates and
/// colours; a mesh in memory has none. The error names the file or the object. Precondition and
/// real-time safety: as `load_object_mesh`.
driver::Result<render::TriangleMesh> read_object_mesh(const SceneObject& object,
                                                      render::MeshAttributes* attributes = nullptr,
                                                      render::MeshFileInfo* info = nullptr);

/// Reads the mesh file of an object, repairs it (`repair: true`), places it in the world, and makes
/// open parts thin bodies (`open: {thickness: ...}`). The notes report parts that were inside out,
/// overlap or touch. Without size and scale the unit of the file is used. The error names the file.
/// Precondition: the object has a mesh file that is not paged from disk. Real-time: never from the
/// servo thread.
THIMBLE_EXPORT driver::Result<ObjectMesh> load_object_mesh(const SceneObject& object);

}  // namespace thimble::scene
