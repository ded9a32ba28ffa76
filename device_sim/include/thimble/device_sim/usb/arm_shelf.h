#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "thimble/device_sim/settings.h"
#include "thimble/device_sim/usb/usb_arm.h"
#include "thimble/driver/arm_model.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::device_sim::usb {

/// Motion of the simulated hand.
enum class HandMotion : std::uint8_t {
  kRest,    ///< Holds the tip at the home pose.
  kTap,     ///< Moves up and down by 15 mm (Falcon: 20 mm) along the base's z, once a second.
  kStroke,  ///< Moves on a circle of that size in the base's y and z, once in two seconds.
  kNone,    ///< Holds the tip only while homing.
};

/// Custom arm on a shelf board: its actual mechanics, motors and encoders, independent of what a
/// driver assumes.
struct ShelfArm {
  driver::ArmModel model;  ///< Geometry, motors and encoders of the arm.
  /// Settings of the arm. Only tip, hand, weight, drive train, motors, watchdog, wiring and missed
  /// edges are used; protocol and timing are those of the board. For the name `described` also its
  /// described wire.
  SimulatedArmSettings settings;
};

/// Options of an arm from the shelf.
struct ShelfOptions {
  HandMotion motion = HandMotion::kTap;  ///< Motion of the hand.
  std::string serial;                    ///< Serial number to report; empty: that of the board.
  std::uint64_t seed = 0;                ///< Seed of all random numbers.
  std::vector<std::byte> firmware;       ///< Only firmware image that a Falcon accepts; empty: any.
  std::optional<ShelfArm> arm;           ///< Custom arm to use instead of the shelf's constants.
};

/// Entry of the list of arms that can be connected.
struct ShelfEntry {
  std::string_view name;  ///< Name on the command line.
  std::string_view what;  ///< Description to display.
};
inline constexpr std::array<ShelfEntry, 4> kShelf{{
    {"woodenhaptics", "WoodenHaptics on its mbed board, HID 1234:0006, 8-byte reports"},
    {"polhem", "Polhem on its mbed board, HID 1234:0006, 14-byte reports when asked"},
    {"polhem-64", "Polhem on a Teensy, HID 16c0:0486, the same reports in 64 bytes"},
    {"falcon", "Novint Falcon, FTDI 0403:cb48, with boot loader, firmware and homing"},
}};

/// Name of the arm of ShelfOptions::arm on the HID board that its file describes
/// (FirmwareSettings::described).
inline constexpr std::string_view kDescribedName = "described";

/// Creates an arm by name. Fails with the list of names if the name is unknown, or if an arm in
/// `options` has another geometry than the board drives. The hand moves for ten minutes, then
/// rests. The hand of a Falcon homes it whenever the arm requests homing and is not homed
/// (homing_hand.h). Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<std::unique_ptr<UsbArm>> make_usb_arm(std::string_view name,
                                                                    const ShelfOptions& options);

}  // namespace thimble::device_sim::usb
