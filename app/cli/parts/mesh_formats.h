#pragma once

#include "mesh/file/read_with_assimp.h"

namespace thimble::cli {

/// Readers of the package thimble-mesh-formats. They are a separate module, so that `thimble`
/// starts without the Assimp library and loads it only for a mesh in one of its formats.
struct MeshFormats {
  const char* version;  ///< Version of Thimble. Only programs of the same version use the module.
  decltype(&render::read_with_assimp) read;
  decltype(&render::import_by_assimp) import;
};

/// The name of the module's file, and of the MeshFormats variable in it.
inline constexpr const char* kMeshFormatsFile = "thimble-mesh-formats.so";
inline constexpr const char* kMeshFormatsSymbol = "thimble_mesh_formats";

}  // namespace thimble::cli
