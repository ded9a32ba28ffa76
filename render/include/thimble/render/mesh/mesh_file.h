#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// File formats that load_mesh reads, as listed in messages.
inline constexpr const char* kMeshEndings = "OFF, OBJ, STL, PLY, glTF, GLB, 3MF, DAE, AMF or 3DS";

/// Properties of a mesh file in addition to its triangles.
struct MeshFileInfo {
  std::string kind;  ///< Format detected from the contents: "STL", "GLTF".
  /// Metres per unit of the coordinates, if the file or format defines it. glTF and DAE are read in
  /// m; 3MF and AMF in the unit that they name (mm if none).
  std::optional<double> unit;
  /// Up axis, x, y or z, if the file or format defines it (glTF, DAE, 3DS).
  char up = 0;
  std::vector<std::string> notes;  ///< Omissions and repairs, one sentence each.
};

/// Texture coordinates and vertex colours of a mesh file. They belong to the corners of triangles,
/// because a file may give one vertex several of them. Each list has one entry per triangle of the
/// mesh, in its order and winding, or is empty if the file has no such data. A corner without a
/// value has NaN.
struct MeshAttributes {
  /// Texture coordinates: (0, 0) is the lower left corner of a picture, (1, 1) the upper right one.
  std::vector<std::array<Eigen::Vector2d, 3>> uv;
  /// Red, green and blue, each from 0 to 1.
  std::vector<std::array<Eigen::Vector3d, 3>> colours;
};

/// Reads a mesh file with a known extension (`kMeshEndings`). The contents determine the format; if
/// they are inconclusive, the extension does. Polygons are split into triangles, and vertices at
/// exactly the same position are merged (STL cannot share vertices). Parts are placed as the file's
/// nodes, components and instances specify, and morph targets have the weights in the file. Bones,
/// animations, lines and points are omitted and reported. Coordinates stay in the file's unit and
/// axes; those of DAE are in m. OFF, OBJ, 3MF, text STL, text PLY and PLY with doubles are read in
/// double precision. Other files contain single precision, or Assimp reads them so. If its step at
/// the coordinates is above 1e-6 of the mesh's size, it is reported; above 1e-3, the file is
/// rejected.
///
/// The error names the file and, for OFF, OBJ and text STL, the line. It reports a missing or
/// truncated file, an unknown format, a mesh without triangles, and an index out of range. It also
/// reports a coordinate that is not a finite number or is beyond 1e15 ("1mm", "1,250.5"), and an
/// unsupported part of the format, such as a required glTF extension. Memory grows with the file's
/// size, not with the counts in its header. glTF, 3MF and the formats of the Assimp library (DAE,
/// AMF, 3DS) are read in a separate process with limits of time and memory. So no file can crash or
/// block this process. Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<TriangleMesh> load_mesh(const std::filesystem::path& file,
                                                      MeshFileInfo* info = nullptr);

/// Reads a mesh file as load_mesh does, and its texture coordinates and vertex colours: of OBJ (vt,
/// and colours after the coordinates of v), PLY (s and t, u and v, or texture_u and texture_v of
/// vertices, or the list texcoord of faces; red, green and blue) and glTF (TEXCOORD_0, COLOR_0).
/// Other formats have none. The mesh is bit-identical to that of load_mesh. The error also reports
/// a texture coordinate or colour that is not a finite number or does not exist, colours of an OBJ
/// file with two possible meanings, and a required KHR_texture_transform. Real-time: never from the
/// servo thread.
THIMBLE_EXPORT driver::Result<TriangleMesh> load_mesh_with_attributes(
    const std::filesystem::path& file, MeshAttributes& attributes, MeshFileInfo* info = nullptr);

/// Transforms a mesh from its own frame O into the world W: p_WV = R_WO * (scale * p_OV) + p_WO for
/// each vertex V. `scale` converts the file's unit to m and must be finite and not 0; `R_WO` is a
/// rotation; `p_WO` is in m. A negative scale mirrors the mesh; triangles are then reversed so that
/// their outer side stays outside. Real-time: never from the servo thread.
THIMBLE_EXPORT TriangleMesh placed(const TriangleMesh& mesh, double scale,
                                   const Eigen::Matrix3d& R_WO, const Eigen::Vector3d& p_WO);

/// Writes a mesh as an OFF file with 17 digits per coordinate, so that load_mesh returns
/// bit-identical numbers. An existing file is replaced only once the new one is complete. The error
/// names the file if its extension is not .off or its folder is not writable. Real-time: never from
/// the servo thread.
THIMBLE_EXPORT driver::Result<void> save_mesh(const TriangleMesh& mesh,
                                              const std::filesystem::path& file);

}  // namespace thimble::render
