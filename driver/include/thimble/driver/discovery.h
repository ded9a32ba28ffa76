#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "thimble/driver/board.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/driver/transports.h"

namespace thimble::driver {

/// How sure it is that a board belongs to an arm. USB ids alone say little: 16c0:0480 to 048f are
/// what a Teensy takes for any program, 1234:0006 is what mbed's USB library takes by itself.
enum class Certainty : std::uint8_t {
  kKnown,         ///< Its USB id or product string is an arm's.
  kProvesItself,  ///< Looks like an arm; at opening it must show by what it sends unasked that it
                  ///< is.
  kUnknown,      ///< May be an arm or anything else, and can prove nothing before it is written to.
  kUnsupported,  ///< Known, and nothing that Thimble can drive.
};

/// A board that is plugged in and may belong to an arm.
struct THIMBLE_EXPORT FoundArm {
  ArmKind kind = ArmKind::kUnsupported;  ///< What its board speaks (arm_table.h).
  std::string arm;                       ///< What it is ("WoodenHaptics").
  std::string bus;                       ///< How it is reached ("USB HID").
  std::string address;                   ///< Where it is plugged in ("bus 1, device 4").
  std::uint16_t vendor_id = 0;           ///< USB's, of the maker.
  std::uint16_t product_id = 0;          ///< The maker's.
  std::string serial;                    ///< Serial number; empty if the arm tells none.
  UsbAddress usb;                        ///< Bus and device number.
  std::string node;             ///< What a program opens ("/dev/hidraw3"); empty if there is none.
  std::filesystem::path sysfs;  ///< The kernel's folder about it.
  bool accessible = false;      ///< This user may open the node.
  BoardKind board = BoardKind::kOther;      ///< What kind of board it is.
  Certainty certainty = Certainty::kKnown;  ///< How sure it is that it is an arm.
  std::string manufacturer, product;        ///< Its USB strings; empty where it has none.
  std::uint16_t release = 0;                ///< bcdDevice.
  HidReports hid;                           ///< Its reports, if it is on HID and has a driver.
  bool serial_is_shared = false;            ///< Another one has the same serial number.
  std::string software;  ///< What a service or library tells of the arm's versions, if it does.
  std::string trouble;   ///< Why a service cannot use the arm now, a sentence; empty: it can.

  /// Returns what the user calls it by, which is also the name of its calibration: the serial
  /// number if only this board has it, else the socket it is plugged into ("usb-1-1.4", the
  /// kernel's name; the same after each replug into that socket).
  std::string name() const;
};

/// Returns whether a serial number is one that many boards carry, such as the 0123456789 of every
/// mbed board, and so names none. Real-time: safe.
THIMBLE_EXPORT bool is_placeholder(std::string_view serial) noexcept;

/// Lists the boards on USB that may be arms (app/guide/pages/driver.md names the sources), from
/// what the kernel tells under `root`/sys: ids, strings and report descriptors. Opens nothing and
/// needs no right to. Of this computer ("/") it lists the arms behind vendors' services as well:
/// those are listened to for half a second at most, on this computer alone, and told nothing. Fails
/// if USB cannot be listed at all and there is no such arm. Real-time: never from the servo thread.
THIMBLE_EXPORT Result<std::vector<FoundArm>> find_arms(const std::filesystem::path& root = "/");

/// Reads a small text file of the kernel without its newline; empty if it cannot be read.
/// Real-time: never from the servo thread.
THIMBLE_EXPORT std::string read_line(const std::filesystem::path& file);

}  // namespace thimble::driver
