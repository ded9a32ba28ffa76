#pragma once

#include <cstddef>
#include <cstdint>

#include "arms/hfab/hfab_report.h"
#include "arms/woody/woody_report.h"

namespace thimble::device_sim::usb {

/// Layout of the reports of a HID arm. All hold little-endian 16-bit words.
enum class HidLayout : std::uint8_t {
  kWoodenHaptics,  ///< 8 bytes: 3 counts and a counter in; 3 currents (mA) and an unused word out.
  kPolhem,         ///< 14 bytes, as in arms/hfab/hfab_report.h of the driver.
  kPolhemPadded,   ///< The same padded to 64 bytes, as boards built on the Teensy send them.
  kDescribed,      ///< Described by FirmwareSettings::described.
};

/// When a board sends reports.
enum class HidReportMode : std::uint8_t {
  kFreeRunning,  ///< One in each frame, with or without messages.
  /// One when it starts, then one after each message of any length. It does not receive while a
  /// report waits for the host. One message waits in its endpoint meanwhile; the next is not
  /// accepted.
  kAnswers,
};

/// A kind of HID board: the bus behaviour of its firmware and its USB library.
struct HidBoard {
  HidLayout layout = HidLayout::kPolhem;                ///< Layout of reports and messages.
  HidReportMode report_mode = HidReportMode::kAnswers;  ///< When it sends reports.
  bool takes_set_idle = false;  ///< If false, it refuses all requests of the HID class.
  std::uint8_t in = 0x81;       ///< Endpoint of the reports.
  std::uint8_t out = 0x01;      ///< Endpoint of the messages.

  /// Returns the size of a report and of a message, bytes; 0 if they are described. Real-time:
  /// safe.
  constexpr std::size_t report_size() const noexcept {
    switch (layout) {
      case HidLayout::kWoodenHaptics:
        return driver::woody::kReportSize;
      case HidLayout::kPolhem:
        return driver::hfab::kReportSize;
      case HidLayout::kPolhemPadded:
        return driver::hfab::kPaddedReportSize;
      case HidLayout::kDescribed:
        return 0;
    }
    return 0;
  }
};

/// The WoodenHaptics board, an mbed LPC1768. It samples, sends and only then checks for a message
/// [S WoodenHaptics/woody-experimental, mbed-code/WoodenHapticsHID/main.cpp: hid(8, 8), readNB].
/// mbed's USBHID class answers none of the requests of the HID class that these boards get [S mbed
/// USBHID.cpp, USBCallback_request].
inline constexpr HidBoard kWoodenHapticsBoard{.layout = HidLayout::kWoodenHaptics,
                                              .report_mode = HidReportMode::kFreeRunning};

/// The Polhem's first board, an mbed LPC1768. It sends a report, waits for a message without a
/// timeout, takes the newest one, uses it only if it has 14 bytes, and starts over [S
/// forsslund/haptikfabrikenapi firmware/main.cpp: hid(14, 14), send, read, readNB]. Its host wakes
/// it with a message of zeros after 10 ms of silence [S src/fsusbhapticdevicethread.cpp].
inline constexpr HidBoard kMbed14Board{};

/// The Polhem's second board, a Teensy with raw HID [S fsusbhapticdevicethread.cpp: 16c0:0486, 64
/// bytes each way; PaulStoffregen/cores teensy3/usb_desc.h, usb_dev.c]. Its firmware is not
/// published. That it only answers is a guess: its host wakes it like the mbed board, and the
/// boards before and after it only answer. A driver that works with such a board also works with a
/// free-running one.
inline constexpr HidBoard kTeensy64Board{
    .layout = HidLayout::kPolhemPadded, .takes_set_idle = true, .in = 0x83, .out = 0x04};

/// Boards whose messages an arm file describes, without and with requests (exchange: stream, ask).
inline constexpr HidBoard kDescribedStreamBoard{.layout = HidLayout::kDescribed,
                                                .report_mode = HidReportMode::kFreeRunning,
                                                .takes_set_idle = true};
inline constexpr HidBoard kDescribedAskBoard{.layout = HidLayout::kDescribed,
                                             .takes_set_idle = true};

}  // namespace thimble::device_sim::usb
