#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "disk_paging/paged_contact.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/render/mesh/triangle_mesh.h"
#include "thimble/scene/scene_file.h"

namespace thimble::scene {

/// How a mesh file stands in the world: p_W = p_WM + scale R_WO p, with p as in the file.
struct MeshPlacement {
  double scale = 1;               ///< m per unit of the file
  Eigen::Vector3d p_WM{0, 0, 0};  ///< m
};

/// Returns how the mesh of an object stands in the world. Precondition: the mesh has a vertex.
/// Real-time: never from the servo thread.
MeshPlacement placement_of(const render::TriangleMesh& mesh, const SceneObject& object);

/// Returns a mesh as its file holds it, put into the world (m) as `object` says.
/// Precondition: the mesh has a vertex. Real-time: never from the servo thread.
render::TriangleMesh place_mesh(const render::TriangleMesh& mesh, const SceneObject& object);

/// Returns where a mesh on the disk stands in the world, as `object` says; it turns about the
/// centre of its box in the file, for the box of the turned mesh is not known. Real-time: never
/// from the servo thread.
render::PagedPlace place_pages(const render::PageFile& file, const SceneObject& object);

/// Returns the largest side of the box of a mesh on the disk where it stands in the world, m.
double side_of_pages(const render::PageFile& file, const render::PagedPlace& place);

/// How many times the reach of the arm a mesh may be large whose unit is not known, because neither
/// its file nor the scene (size, scale) names one [chosen: a part of 5 mm that is read in m exceeds
/// it for every shipped arm].
inline constexpr double kReachesMax = 20;

/// The same of any mesh. What is larger cannot be felt as a shape.
inline constexpr double kStatedReachesMax = 100;

/// From how many times on it is reported where the unit is not known.
inline constexpr double kReachesReported = 5;

/// What is known of the size of a mesh in a scene.
struct ObjectSize {
  double side = 0;       ///< The largest side of its box in the world, m.
  std::string kind;      ///< Its format, "STL"; for messages.
  bool has_unit = true;  ///< Whether its file names a unit.
};

/// Returns the reach of the arms of a scene: the largest side of their workspaces, m; 0 if no arm
/// has one. Real-time: never from the servo thread.
double reach_of(const Scene& scene);

/// Returns what to do about a format without a unit: "STL names no unit: set scale: 0.001 ...".
THIMBLE_EXPORT std::string unit_advice(const std::string& kind);

/// Returns a sentence about an object that is far larger than the `reach` of the arm (m), empty if
/// it is not or if the reach is 0. The error is that of an object that is too large: its file, how
/// large it is, and what to set. Real-time: never from the servo thread.
driver::Result<std::string> judge_size(const SceneObject& object, const ObjectSize& size,
                                       double reach);

/// The mesh of an object as it is touched and drawn, and where it stands.
struct ObjectMesh {
  render::TriangleMesh mesh_W;     ///< Repaired and thickened if the object says so; W, m.
  MeshPlacement place;             ///< Of the file's own coordinates in the world.
  ObjectSize size;                 ///< Of the mesh in the world.
  std::vector<std::string> notes;  ///< What was put right, left out or guessed, a sentence each.
};

/// Reads the mesh file of an object, repairs it (`repair: true`), puts it into the world, and makes
/// thin bodies of what is open (`open: {thickness: ...}`). Parts that were inside out, and parts
/// that overlap or touch, are reported in the notes. An object without size and scale has the unit
/// that its file names. The error names the file. Precondition: the object has a mesh file that is
/// not in pages. Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<ObjectMesh> load_object_mesh(const SceneObject& object);

}  // namespace thimble::scene
