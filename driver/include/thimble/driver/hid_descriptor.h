#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace thimble::driver {

/// What a HID report descriptor says of a device that exchanges one report each way.
struct HidReports {
  std::uint16_t usage_page = 0;  ///< Of the first collection.
  std::uint16_t usage = 0;       ///< Of the first collection.
  std::size_t in_bytes = 0;      ///< Length of a report to the host; 0: there is none.
  std::size_t out_bytes = 0;     ///< Length of a report to the device; 0: there is none.
  bool numbered = false;         ///< Reports have ids, so that there may be several of each.

  friend bool operator==(const HidReports&, const HidReports&) = default;
};

/// The page and usage of the raw HID examples from which the arms' firmware grew [S mbed
/// USBHID.cpp; Teensyduino usb_desc.h, RAWHID_USAGE_PAGE]. Many other devices have them too.
inline constexpr std::uint16_t kRawHidPage = 0xffab, kRawHidUsage = 0x0200;

/// Reads a report descriptor [HID 1.11, 6.2.2]. Total: any bytes give lengths of at most 64 kB;
/// what is not understood counts as nothing. Real-time: safe.
HidReports read_hid_descriptor(std::span<const std::byte> bytes) noexcept;

/// Returns whether a descriptor is that of a raw HID device with reports of so many bytes each way.
/// Real-time: safe.
bool is_raw_hid(const HidReports& reports, std::size_t bytes) noexcept;

}  // namespace thimble::driver
