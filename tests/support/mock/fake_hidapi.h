#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace thimble::support {

/// hidapi with one scripted arm, for programs that link fake_hidapi.cpp. Its functions replace the
/// library's, and its ioctl replaces the kernel's for the report descriptor (all other calls go to
/// the kernel). Nothing here uses the heap.
struct FakeHidapi {
  /// Size of the reports in each direction in the returned descriptor, that of the raw HID
  /// examples; 0: it is not a HID device.
  int report_bytes = 8;
  /// Reports are the 8 bytes of a WoodenHaptics board: zeros, and in the last word a number that
  /// increases by `number_step`. If false, the number is in the first byte.
  bool numbered_last = false;
  int number_step = 1;
  int reports = 0;           ///< Reports ready to read; each contains its number.
  int coming = 0;            ///< Reports that arrive while a caller waits.
  std::uint16_t number = 0;  ///< Of the last report that was read.
  bool gone = false;         ///< Reads fail.
  int interruptions = 0;     ///< Number of following calls that a signal interrupts.
  /// Reports that are read instead of the numbered ones, each after a byte with its length.
  std::span<const unsigned char> script = {};
  std::uint16_t listed_vendor =
      0;  ///< Vendor of the only multi-axis controller in the list; 0: none.
  std::uint16_t listed_product = 0;
  bool refused = false;      ///< It cannot be opened.
  int write_error = 0;       ///< errno of a write; 0: success.
  int last_timeout_ms = -1;  ///< Of the last read.
  std::uint64_t messages = 0;
  std::array<unsigned char, 130> last_message{};
  std::size_t last_message_size = 0;
  int open = 0;
};

/// Returns the only instance.
FakeHidapi& fake_hidapi();

}  // namespace thimble::support
