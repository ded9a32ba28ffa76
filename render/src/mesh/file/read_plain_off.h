#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// Reads the vertices and faces of an OFF file that has one vertex or triangle in each line, as
/// most large ones have: three numbers, and "3" with three numbers of vertices, separated by
/// spaces. Takes a third of the instructions of the words one by one, on two threads. `text` begins
/// after the line of the counts. None if a line has any other form; read_off then reads or refuses
/// the text. Numbers are bit-identical to those of read_off. Real-time: never from the servo
/// thread.
std::optional<TriangleMesh> read_plain_off(std::string_view text, std::size_t vertices,
                                           std::size_t faces);

}  // namespace thimble::render
