#pragma once

#include "thimble/driver/result.h"
#include "thimble/render/build_object_touch.h"

namespace thimble::render {

/// Returns whether a surface has stages that depend on the maps of a mesh. Real-time: never from
/// the servo thread.
bool needs_maps(const SurfaceChoice& surface);

/// Returns the surface with its maps built into its stages, so that it no longer needs them. The
/// error states which map cannot be used, and the remedy. Real-time: never from the servo thread.
driver::Result<SurfaceChoice> use_maps(const SurfaceChoice& surface);

/// Returns an error if a surface needs maps that an object of `triangles` triangles cannot have.
/// Real-time: never from the servo thread.
driver::Result<void> check_maps(const SurfaceChoice& surface, std::size_t triangles);

}  // namespace thimble::render
