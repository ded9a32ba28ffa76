#pragma once

#include <string>
#include <string_view>

namespace thimble::render {

/// Returns the kind of a mesh file as its contents show it: off, stl, ply, gltf, glb, 3mf, dae, amf
/// or 3ds; `ending` (small letters) where the contents show none (OBJ begins with any statement).
/// A ZIP archive is a 3MF file unless it holds an AMF file. Real-time: never from the servo thread.
std::string mesh_kind_of(std::string_view bytes, const std::string& ending);

}  // namespace thimble::render
