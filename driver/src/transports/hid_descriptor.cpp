#include "transports/hid_descriptor.h"

#include <algorithm>
#include <array>

namespace thimble::driver {
namespace {

// Items used here: prefix byte without its two length bits [HID 1.11, 6.2.2.4 to 6.2.2.8].
enum ItemTag : std::uint8_t {
  kInput = 0x80,
  kOutput = 0x90,
  kCollection = 0xa0,
  kUsagePage = 0x04,
  kReportSize = 0x74,
  kReportId = 0x84,
  kReportCount = 0x94,
  kUsage = 0x08,
};
constexpr std::uint8_t kLongItem = 0xfe;
constexpr std::size_t kLengthMax = 1U << 16;  // bytes; beyond any report [chosen]

}  // namespace

HidReports read_hid_descriptor(std::span<const std::byte> bytes) noexcept {
  HidReports reports;
  std::uint32_t page = 0, usage = 0, size_bits = 0, count = 0;
  std::uint64_t in_bits = 0, out_bits = 0;
  bool in_collection = false;
  while (!bytes.empty()) {
    const auto prefix = std::to_integer<std::uint8_t>(bytes[0]);
    bytes = bytes.subspan(1);
    if (prefix == kLongItem) {
      if (bytes.size() < 2) break;
      const std::size_t length = 2 + std::to_integer<std::size_t>(bytes[0]);
      bytes = bytes.subspan(std::min(length, bytes.size()));
      continue;
    }
    constexpr std::array<std::size_t, 4> kLengths = {0, 1, 2, 4};
    const std::size_t length = kLengths[prefix & 3U];
    if (length > bytes.size()) break;
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < length; ++i) {
      value |= std::to_integer<std::uint32_t>(bytes[i]) << (8 * i);
    }
    bytes = bytes.subspan(length);
    // Clamped so that the sums below cannot overflow.
    const std::uint64_t bits =
        std::uint64_t{std::min(size_bits, 1U << 16)} * std::uint64_t{std::min(count, 1U << 16)};
    switch (prefix & ~3U) {
      case kUsagePage:
        page = value;
        break;
      case kUsage:
        usage = value;
        break;
      case kReportSize:
        size_bits = value;
        break;
      case kReportCount:
        count = value;
        break;
      case kReportId:
        reports.numbered = true;
        break;
      case kCollection:
        if (!in_collection) {
          reports.usage_page = static_cast<std::uint16_t>(page);
          reports.usage = static_cast<std::uint16_t>(usage);
        }
        in_collection = true;
        usage = 0;
        break;
      case kInput:
        in_bits = std::min<std::uint64_t>(in_bits + bits, 8 * kLengthMax);
        break;
      case kOutput:
        out_bits = std::min<std::uint64_t>(out_bits + bits, 8 * kLengthMax);
        break;
      default:
        break;
    }
  }
  reports.in_bytes = static_cast<std::size_t>((in_bits + 7) / 8);
  reports.out_bytes = static_cast<std::size_t>((out_bits + 7) / 8);
  return reports;
}

bool is_raw_hid(const HidReports& reports, std::size_t bytes) noexcept {
  return reports.usage_page == kRawHidPage && reports.usage == kRawHidUsage && !reports.numbered &&
         reports.in_bytes == bytes && reports.out_bytes == bytes;
}

}  // namespace thimble::driver
