#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace thimble::driver {

/// Interface through which an arm is accessed: a kind of controller board, identified by its USB
/// properties, or a vendor service or library. One arm can have one of several boards. A board of
/// one kind can have another purpose than an arm: see Certainty (discovery.h).
enum class BoardKind : std::uint8_t {
  /// mbed, raw HID, 8 bytes each way; used by WoodenHaptics' firmware, among others.
  kMbedHid8,
  /// mbed, raw HID, 14 bytes each way; used by Haptikfabriken's firmware, among others.
  kMbedHid14,
  kTeensyRawHid64,  ///< Teensy, raw HID, 64 bytes each way; may run any program.
  kTextLines,       ///< Teensy with a serial port; may run any program.
  kFalconFtdi,      ///< FTDI converter of a Novint Falcon.
  kHaplyService,    ///< Haply's service on this computer.
  kDhdLibrary,      ///< Force Dimension's library.
  kHdLibrary,       ///< OpenHaptics' library.
  kDescribed,       ///< A board that an installed arm file describes (its section `wire`).
  kOther,           ///< A board that no known arm uses; never opened.
};

/// Names of the board kinds in arm files and messages, in the order of BoardKind. kOther has none.
inline constexpr std::array<std::string_view, 9> kBoardNames = {
    "mbed_hid_8",    "mbed_hid_14", "teensy_raw_hid_64", "text_lines", "falcon_ftdi",
    "haply_service", "dhd_library", "hd_library",        "described"};

/// Returns the name of a board kind, "other" for kOther. Real-time: safe.
constexpr std::string_view name(BoardKind board) noexcept {
  const auto index = static_cast<std::size_t>(board);
  return index < kBoardNames.size() ? kBoardNames[index] : "other";
}

/// Protocol of an arm. The table of arms (arm_table.h) has a row for each.
enum class ArmKind : std::uint8_t {
  kWoody,        ///< WoodenHaptics on its mbed board: 8-byte HID reports.
  kPolhem,       ///< Polhem or another Haptikfabriken arm on HID: 14-byte reports.
  kHfabLine,     ///< A Teensy on USB serial, which may be a Haptikfabriken arm: text lines.
  kFalcon,       ///< Novint Falcon: packets through an FTDI converter.
  kHaply,        ///< Haply Inverse3: JSON messages of its service.
  kDhd,          ///< Force Dimension's arms: calls of their library.
  kHd,           ///< Touch and PHANTOM arms: calls of the library of OpenHaptics.
  kDescribed,    ///< An arm whose file describes its wire: a table instead of code.
  kUnsupported,  ///< Not supported by Thimble.
};

/// Properties of a HID device that exchanges one report each way, from its report descriptor.
struct HidReports {
  std::uint16_t usage_page = 0;  ///< Usage page of the first collection.
  std::uint16_t usage = 0;       ///< Usage of the first collection.
  std::size_t in_bytes = 0;      ///< Length of a report to the host, bytes; 0: none.
  std::size_t out_bytes = 0;     ///< Length of a report to the device, bytes; 0: none.
  /// True if reports have ids, so that several of each direction may exist.
  bool numbered = false;

  friend bool operator==(const HidReports&, const HidReports&) = default;
};

}  // namespace thimble::driver
