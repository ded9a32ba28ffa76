#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// The endings of the mesh files that load_mesh reads, as a person is told.
inline constexpr const char* kMeshEndings = "OFF, OBJ, STL, PLY, glTF, GLB, 3MF, DAE, AMF or 3DS";

/// What a mesh file says of itself besides its triangles.
struct MeshFileInfo {
  std::string kind;  ///< Its format by its contents: "STL", "GLTF".
  /// Metres per unit of the coordinates, where file or format names one: glTF and DAE come in m,
  /// 3MF and AMF in the unit they name (mm if none).
  std::optional<double> unit;
  char up =
      0;  ///< Axis that points up, x, y or z, where file or format names one (glTF, DAE, 3DS).
  std::vector<std::string> notes;  ///< What was left out or put right, a sentence each.
};

/// Reads a mesh file whose name has a known ending (`kMeshEndings`) as the format that its contents
/// show, else as that of the ending; splits polygons into triangles and welds vertices that lie at
/// exactly the same place (STL has no other way to share them). Parts are where the file's nodes,
/// components and instances put them; morph targets have the weights of the file; bones,
/// animations, lines and points are left out and reported. Coordinates stay in the file's unit and
/// axes, those of DAE in m. OFF, OBJ, 3MF, texts of STL and PLY and PLY with doubles are read in
/// double precision; in the others the numbers are in single precision, or Assimp reads them so:
/// where its steps at the coordinates are above 1e-6 of the mesh's size that is reported, above
/// 1e-3 it is refused.
///
/// The error names the file and, for OFF, OBJ and text of STL, the line: no such file, unknown
/// format, truncated, no triangles, a coordinate that is not a finite number or beyond 1e15 ("1mm",
/// "1,250.5"), an index out of range, a part of the format that is not read (named), such as a
/// required glTF extension. Memory grows with the file's size, not with the counts it promises.
/// glTF, 3MF and what the Assimp library reads (DAE, AMF, 3DS) are read in a separate process
/// with limits of time and memory, so that no file can crash or hang this one. Real-time: never
/// from the servo thread.
THIMBLE_EXPORT driver::Result<TriangleMesh> load_mesh(const std::filesystem::path& file,
                                                      MeshFileInfo* info = nullptr);

/// Places a mesh from its own frame O in the world W: p_WV = R_WO * (scale * p_OV) + p_WO for each
/// vertex V. `scale` turns the file's unit into m and must be finite and not 0; `R_WO` is a
/// rotation; `p_WO` is in m. A negative scale mirrors the mesh, so triangles are turned round to
/// keep their outer side outside. Real-time: never from the servo thread.
THIMBLE_EXPORT TriangleMesh placed(const TriangleMesh& mesh, double scale,
                                   const Eigen::Matrix3d& R_WO, const Eigen::Vector3d& p_WO);

/// Writes a mesh as an OFF file with 17 digits per coordinate, so that load_mesh gives the same
/// numbers back to the bit. An existing file is replaced only once the new one is complete. The
/// error names the file: another ending than .off, or a folder that cannot be written to.
/// Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<void> save_mesh(const TriangleMesh& mesh,
                                              const std::filesystem::path& file);

}  // namespace thimble::render
