#pragma once

#include "mesh/file/read_with_assimp.h"

namespace thimble::cli {

/// Readers of the package thimble-mesh-formats: a module of its own, so that `thimble` starts
/// without the Assimp library, and loads it for a mesh in one of its formats only.
struct MeshFormats {
  const char* version;  ///< Of Thimble: the module is for the programs of its own version only.
  decltype(&render::read_with_assimp) read;
  decltype(&render::import_by_assimp) import;
};

/// The name of the module's file, and of the MeshFormats in it.
inline constexpr const char* kMeshFormatsFile = "thimble-mesh-formats.so";
inline constexpr const char* kMeshFormatsSymbol = "thimble_mesh_formats";

}  // namespace thimble::cli
