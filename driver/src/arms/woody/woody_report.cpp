#include "arms/woody/woody_report.h"

#include "little_endian.h"

namespace thimble::driver::woody {
namespace {

// Both directions are three signed words and one unsigned word.
constexpr std::size_t kLastWord = 3;

struct Words {
  std::array<std::int16_t, 3> axes{};
  std::uint16_t last = 0;
};

std::optional<Words> words_of(std::span<const std::byte> bytes) noexcept {
  if (bytes.size() != kReportSize) return std::nullopt;
  Words words;
  for (std::size_t i = 0; i < 3; ++i) words.axes[i] = get_word(bytes, i);
  words.last = static_cast<std::uint16_t>(get_word(bytes, kLastWord));
  return words;
}

std::array<std::byte, kReportSize> bytes_of(const Words& words) noexcept {
  std::array<std::byte, kReportSize> bytes{};
  for (std::size_t i = 0; i < 3; ++i) put_word(bytes, i, words.axes[i]);
  put_word(bytes, kLastWord, static_cast<std::int16_t>(words.last));
  return bytes;
}

}  // namespace

std::optional<InputReport> decode_input(std::span<const std::byte> bytes) noexcept {
  const auto words = words_of(bytes);
  if (!words) return std::nullopt;
  return InputReport{.counts = words->axes, .counter = words->last};
}

std::array<std::byte, kReportSize> encode_input(const InputReport& report) noexcept {
  return bytes_of({.axes = report.counts, .last = report.counter});
}

std::optional<OutputReport> decode_output(std::span<const std::byte> bytes) noexcept {
  const auto words = words_of(bytes);
  if (!words) return std::nullopt;
  return OutputReport{.current_mA = words->axes, .unknown_debug = words->last};
}

std::array<std::byte, kReportSize> encode_output(const OutputReport& report) noexcept {
  return bytes_of({.axes = report.current_mA, .last = report.unknown_debug});
}

}  // namespace thimble::driver::woody
