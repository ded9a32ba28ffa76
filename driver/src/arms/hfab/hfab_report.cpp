#include "thimble/driver/arms/hfab/hfab_report.h"

namespace thimble::driver::hfab {
namespace {

bool is_report(std::span<const std::byte> bytes) noexcept {
  return bytes.size() == kReportSize || bytes.size() == kPaddedReportSize;
}

std::int16_t get(std::span<const std::byte> bytes, std::size_t word) noexcept {
  const auto low = std::to_integer<unsigned>(bytes[2 * word]);
  const auto high = std::to_integer<unsigned>(bytes[2 * word + 1]);
  return static_cast<std::int16_t>(static_cast<std::uint16_t>(low | (high << 8)));
}

void put(std::span<std::byte, kReportSize> bytes, std::size_t word, std::int16_t value) noexcept {
  const auto bits = static_cast<std::uint16_t>(value);
  bytes[2 * word] = static_cast<std::byte>(bits & 0xff);
  bytes[2 * word + 1] = static_cast<std::byte>(bits >> 8);
}

}  // namespace

std::optional<InputReport> decode_input(std::span<const std::byte> bytes) noexcept {
  if (!is_report(bytes)) return std::nullopt;
  InputReport report;
  for (std::size_t i = 0; i < 6; ++i) report.counts[i] = get(bytes, i);
  report.info = get(bytes, 6);
  return report;
}

std::array<std::byte, kReportSize> encode_input(const InputReport& report) noexcept {
  std::array<std::byte, kReportSize> bytes{};
  for (std::size_t i = 0; i < 6; ++i) put(bytes, i, report.counts[i]);
  put(bytes, 6, report.info);
  return bytes;
}

std::optional<OutputReport> decode_output(std::span<const std::byte> bytes) noexcept {
  if (!is_report(bytes)) return std::nullopt;
  OutputReport report;
  for (std::size_t i = 0; i < 3; ++i) report.current_mA[i] = get(bytes, i);
  report.command = get(bytes, 3);
  for (std::size_t i = 0; i < 3; ++i) report.attributes[i] = get(bytes, 4 + i);
  return report;
}

std::array<std::byte, kReportSize> encode_output(const OutputReport& report) noexcept {
  std::array<std::byte, kReportSize> bytes{};
  for (std::size_t i = 0; i < 3; ++i) put(bytes, i, report.current_mA[i]);
  put(bytes, 3, report.command);
  for (std::size_t i = 0; i < 3; ++i) put(bytes, 4 + i, report.attributes[i]);
  return bytes;
}

}  // namespace thimble::driver::hfab
