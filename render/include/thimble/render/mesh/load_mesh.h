#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "thimble/driver/result.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// The endings of the mesh files that load_mesh reads, as a person is told.
inline constexpr const char* kMeshEndings = "OFF, OBJ, STL, PLY, glTF, GLB, 3MF, DAE, AMF or 3DS";

/// What a mesh file says of itself besides its triangles.
struct MeshFileInfo {
  /// Metres per unit of the coordinates, where file or format names one: glTF and DAE come in m,
  /// 3MF and AMF in the unit they name (mm if none).
  std::optional<double> unit;
  char up =
      0;  ///< Axis that points up, x, y or z, where file or format names one (glTF, DAE, 3DS).
  std::vector<std::string> notes;  ///< What was left out or put right, a sentence each.
};

/// Reads a mesh file (`kMeshEndings`, told by its name's ending), splits polygons into triangles
/// and welds vertices that lie at exactly the same place (STL has no other way to share them).
/// Parts stand where the file's nodes, components and instances put them; bones, animations,
/// lines and points are left out, and told. Coordinates stay in the file's unit and axes, those of
/// DAE in m; OFF and PLY keep what precision the file has, all others are read in single precision.
/// A byte order mark, bytes after the last triangle of an STL file and `SOLID` in capitals are
/// taken in.
///
/// The error names the file and, for OFF, the line: no such file, unknown ending, truncated, no
/// triangles, a coordinate that is not a finite number or beyond 1e15, an index out of range.
/// Memory grows with the file's size, not with the counts it promises. What the Assimp library
/// reads (all but OFF and PLY) is read by a process of its own with limits of time and memory, so
/// that no file can crash or hang this one. Real-time: never from the servo thread.
driver::Result<TriangleMesh> load_mesh(const std::filesystem::path& file,
                                       MeshFileInfo* info = nullptr);

}  // namespace thimble::render
