#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "thimble/driver/result.h"
#include "thimble/driver/transports.h"

namespace thimble::driver {

/// Says how an arm is reached and what it speaks.
enum class ArmKind : std::uint8_t {
  kWoody,        ///< WoodenHaptics on its mbed board: 8-byte HID reports.
  kPolhem,       ///< Polhem or another Haptikfabriken arm on HID: 14-byte reports.
  kHfabLine,     ///< A Teensy on USB serial, which may be a Haptikfabriken arm: text lines.
  kFalcon,       ///< Novint Falcon: packets through an FTDI converter.
  kUnsupported,  ///< Known, but its protocol is not public.
};

/// Is one arm that is plugged in.
struct FoundArm {
  ArmKind kind = ArmKind::kUnsupported;  ///< How it is reached, and its language.
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

  /// Tells what the user calls it by: the serial number, or the place if it has none
  /// ("usb-1-4" for bus 1, device 4).
  std::string name() const;
};

/// Lists the arms on USB whose ids are known (driver/README.md names the sources), from what the
/// kernel tells under `root`/sys. Needs no right to open them. Fails if USB cannot be listed at
/// all. Real-time: never from the servo thread.
Result<std::vector<FoundArm>> find_arms(const std::filesystem::path& root = "/");

/// Tells which arm a USB id belongs to, or nullptr. Real-time: safe.
const char* arm_of_usb_id(std::uint16_t vendor_id, std::uint16_t product_id) noexcept;

/// Reads a small text file of the kernel without its newline; empty if it cannot be read.
/// Real-time: never from the servo thread.
std::string read_line(const std::filesystem::path& file);

}  // namespace thimble::driver
