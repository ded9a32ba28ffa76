#pragma once

#include <filesystem>
#include <vector>

#include "thimble/driver/result.h"
#include "view/gl/canvas.h"

namespace thimble::view {

/// Returns whether the file name is that of an animation that ffmpeg writes: .mp4 or .gif.
bool is_animation(const std::filesystem::path& file);

/// Returns whether the file name is that of a GIF. Players show a picture of a GIF for 0.1 s if it
/// asks for less than 0.02 s.
bool is_gif(const std::filesystem::path& file);

/// Returns whether ffmpeg can be run; the error says what to do without it.
driver::Result<void> find_ffmpeg();

/// Writes pictures of one size, `frame_time` (s) each, as an animation, in the format of the file's
/// ending: MP4 (H.264, which all browsers and slide programs play) or GIF (repeats forever). ffmpeg
/// writes it, bit-identical each time. The sides of an MP4 are even: a white line is added to odd
/// ones.
///
/// Fails without ffmpeg, or with the message of ffmpeg.
/// Precondition: there is a picture and is_animation(file). Real-time: never from the servo thread.
driver::Result<void> write_animation(const std::vector<Picture>& pictures, double frame_time,
                                     const std::filesystem::path& file);

}  // namespace thimble::view
