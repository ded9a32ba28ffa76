#pragma once

#include <filesystem>

#include "thimble/driver/result.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// Writes a mesh as an OFF file with 17 digits per coordinate, so that load_mesh gives the same
/// numbers back to the bit. An existing file is replaced only once the new one is complete. The
/// error names the file: another ending than .off, or a folder that cannot be written to.
/// Real-time: never from the servo thread.
driver::Result<void> save_mesh(const TriangleMesh& mesh, const std::filesystem::path& file);

}  // namespace thimble::render
