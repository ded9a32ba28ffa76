#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "thimble/driver/result.h"
#include "thimble/render/mesh/mesh_file.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// Reads the text of an OBJ file in double precision [Wavefront, Advanced Visualizer appendix B1].
/// Reads vertices with or without a weight of 1 or a colour, comments and joined lines. Faces may
/// have any size and positive or negative numbers, also before their vertices. Materials, normals,
/// groups, lines and points are omitted; lines and points are reported in `notes`. Free-form
/// surfaces, included files and unknown statements are refused. Not welded. The error begins with
/// the file's `name` and the line ("a.obj:12: ..."), or is a sentence if it concerns no line.
/// Memory grows with the text. If `attributes` is not null, it gets texture coordinates and
/// colours; invalid ones are an error. Real-time: never from the servo thread.
driver::Result<TriangleMesh> read_obj(std::string_view text, const std::string& name,
                                      std::vector<std::string>& notes,
                                      MeshAttributes* attributes = nullptr);

}  // namespace thimble::render
