#include "thimble/driver/arms/woody/woody_report.h"

#include "thimble/driver/little_endian.h"

namespace thimble::driver::woody {
namespace {

constexpr std::size_t kLastWord = 3;

}  // namespace

std::optional<InputReport> decode_input(std::span<const std::byte> bytes) noexcept {
  if (bytes.size() != kReportSize) return std::nullopt;
  InputReport report;
  for (std::size_t i = 0; i < 3; ++i) report.counts[i] = get_word(bytes, i);
  report.counter = static_cast<std::uint16_t>(get_word(bytes, kLastWord));
  return report;
}

std::array<std::byte, kReportSize> encode_input(const InputReport& report) noexcept {
  std::array<std::byte, kReportSize> bytes{};
  for (std::size_t i = 0; i < 3; ++i) put_word(bytes, i, report.counts[i]);
  put_word(bytes, kLastWord, static_cast<std::int16_t>(report.counter));
  return bytes;
}

std::optional<OutputReport> decode_output(std::span<const std::byte> bytes) noexcept {
  if (bytes.size() != kReportSize) return std::nullopt;
  OutputReport report;
  for (std::size_t i = 0; i < 3; ++i) report.current_mA[i] = get_word(bytes, i);
  report.unknown_debug = static_cast<std::uint16_t>(get_word(bytes, kLastWord));
  return report;
}

std::array<std::byte, kReportSize> encode_output(const OutputReport& report) noexcept {
  std::array<std::byte, kReportSize> bytes{};
  for (std::size_t i = 0; i < 3; ++i) put_word(bytes, i, report.current_mA[i]);
  put_word(bytes, kLastWord, static_cast<std::int16_t>(report.unknown_debug));
  return bytes;
}

}  // namespace thimble::driver::woody
