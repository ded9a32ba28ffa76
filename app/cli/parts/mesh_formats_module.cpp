// The module of the package thimble-mesh-formats (mesh_formats.h).
#include "cli/parts/mesh_formats.h"
#include "thimble/version.h"

extern "C" __attribute__((visibility("default")))
const thimble::cli::MeshFormats thimble_mesh_formats{
    THIMBLE_VERSION, &thimble::render::read_with_assimp, &thimble::render::import_by_assimp};
