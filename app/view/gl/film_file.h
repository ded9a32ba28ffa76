#pragma once

#include <filesystem>
#include <vector>

#include "thimble/driver/result.h"
#include "view/gl/canvas.h"

namespace thimble::view {

/// Returns whether a file of this name is a film that ffmpeg writes: .mp4 or .gif.
bool is_film(const std::filesystem::path& file);

/// Returns whether a file of this name is a GIF. Players show a picture of one for 0.1 s if it asks
/// for less than 0.02 s.
bool is_gif(const std::filesystem::path& file);

/// Returns whether ffmpeg can be run; what to do without it, if not.
driver::Result<void> find_ffmpeg();

/// Writes pictures of one size, `frame_time` (s) each, as a film: MP4 (H.264, which every browser
/// and slide program plays) or GIF (for ever), by the ending of the file's name. ffmpeg writes it,
/// the same bits each time. An MP4's sides are even: where a picture's are not, a line of white is
/// added.
///
/// Fails without ffmpeg, or tells what ffmpeg said.
/// Precondition: there is a picture and is_film(file). Real-time: never from the servo thread.
driver::Result<void> write_film(const std::vector<Picture>& pictures, double frame_time,
                                const std::filesystem::path& file);

}  // namespace thimble::view
