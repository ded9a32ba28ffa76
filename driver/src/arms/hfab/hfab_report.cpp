#include "arms/hfab/hfab_report.h"

#include <algorithm>

#include "little_endian.h"

namespace thimble::driver::hfab {
namespace {

bool is_report(std::span<const std::byte> bytes) noexcept {
  return bytes.size() == kReportSize || bytes.size() == kPaddedReportSize;
}

}  // namespace

std::optional<InputReport> decode_input(std::span<const std::byte> bytes) noexcept {
  if (!is_report(bytes)) return std::nullopt;
  InputReport report;
  for (std::size_t i = 0; i < 6; ++i) report.counts[i] = get_word(bytes, i);
  report.info = get_word(bytes, 6);
  return report;
}

std::array<std::byte, kReportSize> encode_input(const InputReport& report) noexcept {
  std::array<std::byte, kReportSize> bytes{};
  for (std::size_t i = 0; i < 6; ++i) put_word(bytes, i, report.counts[i]);
  put_word(bytes, 6, report.info);
  return bytes;
}

std::optional<OutputReport> decode_output(std::span<const std::byte> bytes) noexcept {
  if (!is_report(bytes)) return std::nullopt;
  OutputReport report;
  for (std::size_t i = 0; i < 3; ++i) report.current_mA[i] = get_word(bytes, i);
  report.command = get_word(bytes, 3);
  for (std::size_t i = 0; i < 3; ++i) report.attributes[i] = get_word(bytes, 4 + i);
  return report;
}

std::array<std::byte, kReportSize> encode_output(const OutputReport& report) noexcept {
  std::array<std::byte, kReportSize> bytes{};
  for (std::size_t i = 0; i < 3; ++i) put_word(bytes, i, report.current_mA[i]);
  put_word(bytes, 3, report.command);
  for (std::size_t i = 0; i < 3; ++i) put_word(bytes, 4 + i, report.attributes[i]);
  return bytes;
}

std::array<std::byte, kPaddedReportSize> pad(
    const std::array<std::byte, kReportSize>& report) noexcept {
  std::array<std::byte, kPaddedReportSize> padded{};
  std::copy(report.begin(), report.end(), padded.begin());
  return padded;
}

}  // namespace thimble::driver::hfab
