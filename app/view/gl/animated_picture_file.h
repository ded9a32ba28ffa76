#pragma once

#include <filesystem>
#include <vector>

#include "thimble/driver/result.h"
#include "view/gl/canvas.h"

namespace thimble::view {

/// Writes pictures of one size as an animated PNG (APNG) that repeats forever, `frame_time` (s)
/// each, with one palette of 256 colours. Programs without animation show the first picture.
/// Precondition: there is a picture. Real-time: never from the servo thread.
driver::Result<void> write_animated_png(const std::vector<Picture>& pictures, double frame_time,
                                        const std::filesystem::path& file);

}  // namespace thimble::view
