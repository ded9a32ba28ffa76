#pragma once

#include <cstdio>
#include <filesystem>

#include "output/output_file.h"
#include "thimble/driver/result.h"
#include "view/gl/canvas.h"

namespace thimble::view {

/// The number of colours in a PNG.
enum class PngColours {
  kAll,  ///< All colours, for comparisons.
  k256,  ///< The 256 best colours: a third of the size, with hardly visible differences.
};

/// Writes a picture as PNG. The error says which file could not be written.
/// Real-time: never from the servo thread.
driver::Result<void> write_png(const Picture& picture, const std::filesystem::path& file,
                               PngColours colours = PngColours::k256);

/// Opens a stream that writes to an output; null if there is no descriptor left.
/// Real-time: never from the servo thread.
std::FILE* write_stream(const output::OutputFile& file);

/// Reads a PNG. The error names the file. Real-time: never from the servo thread.
driver::Result<Picture> read_png(const std::filesystem::path& file);

}  // namespace thimble::view
