#pragma once

#include <string>
#include <vector>

#include "meshes/object_size.h"
#include "meshes/place_mesh.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/render/mesh/triangle_mesh.h"
#include "thimble/scene/scene_file.h"

namespace thimble::scene {

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
