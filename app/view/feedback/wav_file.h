#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "thimble/driver/result.h"

namespace thimble::view {

/// Converts samples to 16 bits. Samples outside -1 to 1 are clamped; samples that are not finite
/// become 0.
std::vector<std::int16_t> sixteen_bits(std::span<const float> samples);

/// Writes samples (-1 to 1), `rate` a second, as a WAV file: one channel of 16 bits. The error
/// names the file. Real-time: never from the servo thread.
driver::Result<void> write_wav(std::span<const float> samples, int rate, const std::string& file);

}  // namespace thimble::view
