#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace thimble::driver {

/// What an arm is reached by: a kind of controller board, told by how it looks on USB, or its
/// vendor's service or library. One arm may have one of several boards, and one kind of board may
/// be anything: see Certainty (discovery.h).
enum class BoardKind : std::uint8_t {
  kMbedHid8,        ///< mbed, raw HID, 8 bytes each way: WoodenHaptics' firmware, among others.
  kMbedHid14,       ///< mbed, raw HID, 14 bytes each way: Haptikfabriken's firmware, among others.
  kTeensyRawHid64,  ///< Teensy, raw HID, 64 bytes each way: any program may run on it.
  kTextLines,       ///< Teensy with a serial port: any program may run on it.
  kFalconFtdi,      ///< The FTDI converter of a Novint Falcon.
  kHaplyService,    ///< Haply's service on this computer.
  kDhdLibrary,      ///< Force Dimension's library.
  kHdLibrary,       ///< OpenHaptics' library.
  kOther,           ///< A form that no arm is known to have; never opened.
};

/// The names of the kinds in arm files and messages, in the order of BoardKind; kOther has none.
inline constexpr std::array<std::string_view, 8> kBoardNames = {
    "mbed_hid_8",  "mbed_hid_14",   "teensy_raw_hid_64", "text_lines",
    "falcon_ftdi", "haply_service", "dhd_library",       "hd_library"};

/// Returns the name of a kind of board, "other" for kOther. Real-time: safe.
constexpr std::string_view name(BoardKind board) noexcept {
  const auto index = static_cast<std::size_t>(board);
  return index < kBoardNames.size() ? kBoardNames[index] : "other";
}

/// A language that arms speak; the table of arms (arm_table.h) has a row for each.
enum class ArmKind : std::uint8_t {
  kWoody,        ///< WoodenHaptics on its mbed board: 8-byte HID reports.
  kPolhem,       ///< Polhem or another Haptikfabriken arm on HID: 14-byte reports.
  kHfabLine,     ///< A Teensy on USB serial, which may be a Haptikfabriken arm: text lines.
  kFalcon,       ///< Novint Falcon: packets through an FTDI converter.
  kHaply,        ///< Haply Inverse3: JSON messages of its service.
  kDhd,          ///< Force Dimension's arms: calls of their library.
  kHd,           ///< Touch and PHANTOM arms: calls of the library of OpenHaptics.
  kUnsupported,  ///< Nothing that Thimble can drive.
};

/// What a HID report descriptor says of a device that exchanges one report each way.
struct HidReports {
  std::uint16_t usage_page = 0;  ///< Of the first collection.
  std::uint16_t usage = 0;       ///< Of the first collection.
  std::size_t in_bytes = 0;      ///< Length of a report to the host; 0: there is none.
  std::size_t out_bytes = 0;     ///< Length of a report to the device; 0: there is none.
  bool numbered = false;         ///< Reports have ids, so that there may be several of each.

  friend bool operator==(const HidReports&, const HidReports&) = default;
};

}  // namespace thimble::driver
