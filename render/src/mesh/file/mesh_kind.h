#pragma once

#include <string>
#include <string_view>

namespace thimble::render {

/// Returns the kind of a mesh file from its contents: off, stl, ply, gltf, glb, 3mf, dae, amf or
/// 3ds. Returns `ending` (lower case) if the contents do not decide (OBJ begins with any
/// statement). A ZIP archive is a 3MF file unless it holds an AMF file. Real-time: never from the
/// servo thread.
std::string mesh_kind_of(std::string_view bytes, const std::string& ending);

}  // namespace thimble::render
