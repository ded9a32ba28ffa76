#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "system/run_in_sandbox.h"
#include "thimble/driver/result.h"
#include "thimble/render/mesh/mesh_file.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// Reads a mesh and the information of its file; throws std::bad_alloc if memory is short.
using MeshReader = std::function<driver::Result<TriangleMesh>(MeshFileInfo& info)>;

/// Returns the limits of reading a file of `bytes` bytes: twenty times the time per byte of the
/// slowest format, and four times the memory of the hungriest.
driver::SandboxLimits limits_of(std::size_t bytes);

/// Returns the error about a damaged file: "the GLTF file could not be read (it ...)".
driver::Error unreadable(const std::string& kind, const std::string& reason);

/// Runs a reader in a separate process with limits of time and memory. The error is the reader's,
/// or `unreadable` if the process reached its limits or crashed. Real-time: never from the servo
/// thread. `attributes`, if not null, is filled by `read` in that process, and carried over.
driver::Result<TriangleMesh> read_in_child(const MeshReader& read, const std::string& kind,
                                           const driver::SandboxLimits& limits, MeshFileInfo& info,
                                           MeshAttributes* attributes = nullptr);

}  // namespace thimble::render
