#pragma once

#include <string>
#include <string_view>

#include "thimble/driver/result.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// The largest coordinate in a mesh file, in the file's unit. Up to here doubles resolve places to
/// better than one unit, and products of three stay far from overflow.
inline constexpr double kCoordinateMax = 1e15;

/// Reads the text of an OFF file: OFF, and COFF, NOFF, STOFF and their combinations, of which only
/// positions are kept. Not welded. The error begins with the file's `name` and the line ("a.off:12:
/// ..."). Real-time: never from the servo thread.
driver::Result<TriangleMesh> read_off(std::string_view text, const std::string& name);

}  // namespace thimble::render
