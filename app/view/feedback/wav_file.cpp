#include "view/feedback/wav_file.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "output/output_file.h"

namespace thimble::view {
namespace {

constexpr std::size_t kHeaderBytes = 44;

/// Appends a number, low byte first.
void put(std::string& bytes, std::uint32_t number, int size) {
  for (int i = 0; i < size; ++i) bytes.push_back(static_cast<char>(number >> (8 * i) & 0xffU));
}

}  // namespace

std::vector<std::int16_t> sixteen_bits(std::span<const float> samples) {
  constexpr float kMax = std::numeric_limits<std::int16_t>::max();
  std::vector<std::int16_t> whole;
  whole.reserve(samples.size());
  for (const float x : samples) {
    const float bounded = std::isfinite(x) ? std::clamp(x, -1.0F, 1.0F) : 0;
    whole.push_back(static_cast<std::int16_t>(std::lround(kMax * bounded)));
  }
  return whole;
}

// [S] IBM and Microsoft, Multimedia Programming Interface and Data Specifications 1.0, 1991: RIFF
// WAVE with format 1 (PCM).
driver::Result<void> write_wav(std::span<const float> samples, int rate, const std::string& file) {
  constexpr std::size_t kMax = (std::numeric_limits<std::uint32_t>::max() - kHeaderBytes) / 2;
  if (samples.size() > kMax) {
    return driver::Error{file +
                         " cannot be written: the sound is longer than a WAV file can be (4 GB)."};
  }
  const auto data_bytes = static_cast<std::uint32_t>(2 * samples.size());
  const auto per_second = static_cast<std::uint32_t>(rate);
  std::string bytes = "RIFF";
  put(bytes, data_bytes + kHeaderBytes - 8, 4);
  bytes += "WAVEfmt ";
  put(bytes, 16, 4);              // bytes of the format chunk
  put(bytes, 1, 2);               // PCM
  put(bytes, 1, 2);               // channels
  put(bytes, per_second, 4);      // sample rate
  put(bytes, 2 * per_second, 4);  // bytes a second
  put(bytes, 2, 2);               // bytes per sample of all channels
  put(bytes, 16, 2);              // bits per sample
  bytes += "data";
  put(bytes, data_bytes, 4);
  for (const std::int16_t x : sixteen_bits(samples)) put(bytes, static_cast<std::uint16_t>(x), 2);
  return output::write_file(file, output::kSound, bytes);
}

}  // namespace thimble::view
