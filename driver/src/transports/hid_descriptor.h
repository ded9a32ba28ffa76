#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "thimble/driver/board.h"

namespace thimble::driver {

/// Page and usage of the raw HID examples on which the arms' firmware is based [S mbed USBHID.cpp;
/// Teensyduino usb_desc.h, RAWHID_USAGE_PAGE]. Many other devices have them too.
inline constexpr std::uint16_t kRawHidPage = 0xffab, kRawHidUsage = 0x0200;

/// Reads a report descriptor [HID 1.11, 6.2.2]. Total: any bytes give lengths of at most 64 kB;
/// unknown items are ignored. Real-time: safe.
HidReports read_hid_descriptor(std::span<const std::byte> bytes) noexcept;

/// Returns whether a descriptor is that of a raw HID device with reports of `bytes` bytes each way.
/// Real-time: safe.
bool is_raw_hid(const HidReports& reports, std::size_t bytes) noexcept;

}  // namespace thimble::driver
