#pragma once

#include <cstddef>
#include <cstdint>

#include "arms/hfab/hfab_report.h"
#include "arms/woody/woody_report.h"

namespace thimble::device_sim::usb {

/// What the reports of a HID arm look like. All hold little-endian 16-bit words.
enum class HidLayout : std::uint8_t {
  kWoodenHaptics,  ///< 8 bytes: 3 counts and a counter in; 3 currents (mA) and an unused word out.
  kPolhem,         ///< 14 bytes, as arms/hfab/hfab_report.h of the driver has them.
  kPolhemPadded,   ///< The same in 64 bytes, as boards built on the Teensy send them.
};

/// When a board sends reports.
enum class HidSpeech : std::uint8_t {
  kFreeRunning,  ///< One in each frame, whether it hears messages or not.
  /// One when it starts, then one after each message of any length. It does not listen while a
  /// report waits for the host; one message waits in its endpoint meanwhile, the next is not taken.
  kAnswers,
};

/// A kind of HID board: what its firmware and its USB library make of the bus.
struct HidBoard {
  HidLayout layout = HidLayout::kPolhem;   ///< Of reports and messages.
  HidSpeech speech = HidSpeech::kAnswers;  ///< When it sends reports.
  bool takes_set_idle = false;             ///< Else it refuses all requests of the HID class.
  std::uint8_t in = 0x81;                  ///< Endpoint of its reports.
  std::uint8_t out = 0x01;                 ///< Endpoint of its messages.

  /// Returns the bytes of a report and of a message. Real-time: safe.
  constexpr std::size_t report_size() const noexcept {
    switch (layout) {
      case HidLayout::kWoodenHaptics:
        return driver::woody::kReportSize;
      case HidLayout::kPolhem:
        return driver::hfab::kReportSize;
      case HidLayout::kPolhemPadded:
        return driver::hfab::kPaddedReportSize;
    }
    return 0;
  }
};

/// The WoodenHaptics board, an mbed LPC1768. It samples, sends and only then looks for a message
/// [S WoodenHaptics/woody-experimental, mbed-code/WoodenHapticsHID/main.cpp: hid(8, 8), readNB].
/// mbed's USBHID class answers no request of the HID class that these boards get [S mbed
/// USBHID.cpp, USBCallback_request].
inline constexpr HidBoard kWoodenHapticsBoard{.layout = HidLayout::kWoodenHaptics,
                                              .speech = HidSpeech::kFreeRunning};

/// The Polhem's first board, an mbed LPC1768: it sends a report, then waits for a message without
/// end, takes the newest that came, uses it only if it has 14 bytes, and begins anew [S
/// forsslund/haptikfabrikenapi firmware/main.cpp: hid(14, 14), send, read, readNB]. Its host wakes
/// it with a message of zeros after 10 ms of silence [S src/fsusbhapticdevicethread.cpp].
inline constexpr HidBoard kMbed14Board{};

/// The Polhem's second board, a Teensy with raw HID [S fsusbhapticdevicethread.cpp: 16c0:0486, 64
/// bytes each way; PaulStoffregen/cores teensy3/usb_desc.h, usb_dev.c]. Its firmware is not
/// published. That it answers only is a guess: its host wakes it as it wakes the mbed board, the
/// boards before and after it answer only, and a driver that manages with that manages with a
/// free-running one too.
inline constexpr HidBoard kTeensy64Board{
    .layout = HidLayout::kPolhemPadded, .takes_set_idle = true, .in = 0x83, .out = 0x04};

}  // namespace thimble::device_sim::usb
