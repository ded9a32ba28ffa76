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

/// What the simulated hand does with the arm.
enum class HandMotion : std::uint8_t {
  kRest,    ///< Holds the tip at the home pose.
  kTap,     ///< Goes up and down by 15 mm (Falcon: 20 mm) along the base's z, once a second.
  kStroke,  ///< Goes round a circle of so much in the base's y and z, once in two seconds.
  kNone,    ///< Holds the tip no longer than homing takes.
};

/// Another arm on a board of the shelf: what its mechanics, motors and encoders are, whatever a
/// driver believes of it.
struct ShelfArm {
  driver::ArmModel model;  ///< Geometry, motors and encoders.
  /// Of them tip, hand, weight, drive train, motors, watchdog, wiring and missed edges are taken:
  /// what a board speaks, and when, is its own.
  SimulatedArmSettings settings;
};

/// How an arm from the shelf is to be.
struct ShelfOptions {
  HandMotion motion = HandMotion::kTap;  ///< What the hand does.
  std::string serial;                    ///< Serial number that it tells; empty: its board's own.
  std::uint64_t seed = 0;                ///< Of everything random.
  std::vector<std::byte> firmware;       ///< The only image that a Falcon runs; empty: any.
  std::optional<ShelfArm> arm;           ///< In place of the shelf's own constants.
};

/// Lists the arms that can be plugged in: name for the command line, and what it is.
struct ShelfEntry {
  std::string_view name;  ///< For the command line.
  std::string_view what;  ///< What it is, for people.
};
inline constexpr std::array<ShelfEntry, 4> kShelf{{
    {"woodenhaptics", "WoodenHaptics on its mbed board, HID 1234:0006, 8-byte reports"},
    {"polhem", "Polhem on its mbed board, HID 1234:0006, 14-byte reports, answers only"},
    {"polhem-64", "Polhem on a Teensy, HID 16c0:0486, the same reports in 64 bytes"},
    {"falcon", "Novint Falcon, FTDI 0403:cb48, boots, takes firmware, homes"},
}};

/// Makes an arm by its name. Fails with the list of names, or if an arm of `options` is of another
/// build than the board drives. The hand moves for ten minutes, then
/// rests. That of a Falcon homes it whenever the arm is asked to home and is not (homing_hand.h).
/// Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<std::unique_ptr<UsbArm>> make_usb_arm(std::string_view name,
                                                                    const ShelfOptions& options);

}  // namespace thimble::device_sim::usb
