#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <string_view>

#include "thimble/driver/result.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::studies {

/// Names of the small closed meshes for random scenes, about 1 unit large: smooth and sharp,
/// concave, thin, and with a needle's point.
inline constexpr std::array<std::string_view, 7> kSmallMeshes{"ball",  "cube",   "ring", "star",
                                                              "plate", "needle", "wedge"};

/// Makes one of them. Real-time: never from the servo thread.
render::TriangleMesh small_mesh(std::size_t which);

/// Writes all of them into `folder` as NAME.off; creates the folder. Fails if it cannot.
driver::Result<void> write_small_meshes(const std::filesystem::path& folder);

}  // namespace thimble::studies
