#pragma once

#include <Eigen/Core>

#include "disk_paging/paged_contact.h"
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

}  // namespace thimble::scene
