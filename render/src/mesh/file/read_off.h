#pragma once

#include <string>
#include <string_view>

#include "thimble/driver/result.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// The largest coordinate a mesh file may hold, in the file's unit. Up to here doubles tell
/// places apart to better than one unit, and products of three stay far from overflow.
inline constexpr double kCoordinateMax = 1e15;

/// Reads the text of an OFF file: OFF, and COFF, NOFF, STOFF and their mixtures, of which only the
/// positions are kept. Not welded. The error begins with the file's `name` and the line
/// ("a.off:12: ..."). Real-time: never from the servo thread.
driver::Result<TriangleMesh> read_off(std::string_view text, const std::string& name);

}  // namespace thimble::render
