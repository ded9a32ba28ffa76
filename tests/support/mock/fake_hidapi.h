#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace thimble::support {

/// hidapi with one scripted arm, for programs that link fake_hidapi.cpp: its functions stand in for
/// the library's, and so does its ioctl for the kernel's questions about the report descriptor (all
/// others go on to the kernel). Nothing here asks the heap for anything.
struct FakeHidapi {
  /// The descriptor of the raw HID examples with reports of `bytes` each way is what it tells; 0:
  /// it is no HID device.
  int report_bytes = 8;
  /// Reports are the 8 bytes of a WoodenHaptics board: zeros, and in the last word a number that
  /// rises by `number_step` from one to the next. Otherwise the first byte has the number.
  bool numbered_last = false;
  int number_step = 1;
  int reports = 0;           ///< Waiting to be read; each holds its number.
  int coming = 0;            ///< Arrive when somebody waits.
  std::uint16_t number = 0;  ///< Of the last report that was read.
  bool gone = false;         ///< Reads fail.
  int interruptions = 0;     ///< So many calls from now on are interrupted by a signal.
  /// Reports that are read in place of the numbered ones: each behind a byte that tells its length.
  std::span<const unsigned char> script = {};
  std::uint16_t listed_vendor = 0;  ///< Of the one multi-axis controller that is listed; 0: none.
  std::uint16_t listed_product = 0;
  bool refused = false;      ///< It cannot be opened.
  int write_error = 0;       ///< errno of a write; 0: it goes well.
  int last_timeout_ms = -1;  ///< Of the last read.
  std::uint64_t messages = 0;
  std::array<unsigned char, 130> last_message{};
  std::size_t last_message_size = 0;
  int open = 0;
};

/// Returns the only one.
FakeHidapi& fake_hidapi();

}  // namespace thimble::support
