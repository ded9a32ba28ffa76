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

/// Certainty that a board belongs to an arm. A USB id is not sufficient. A Teensy with any program
/// uses 16c0:0480 to 048f, and mbed's USB library uses 1234:0006 by default.
enum class Certainty : std::uint8_t {
  kKnown,  ///< The USB id or product string is that of an arm.
  /// The board looks like an arm. After it is opened, it must identify itself by the messages that
  /// it sends without a request.
  kProvesItself,
  /// Unknown device, possibly an arm; it cannot be identified before data is sent to it.
  kUnknown,
  kUnsupported,  ///< Known device that Thimble cannot drive.
};

/// USB properties by which an installed arm file describes the board of its arm.
struct DescribedBoard {
  std::string arm;                              ///< Name of the arm.
  std::string arm_file;                         ///< Name of the installed arm file.
  std::uint16_t vendor_id = 0, product_id = 0;  ///< USB ids.
  std::string product;                          ///< Whole product string; empty: not compared.
  std::uint16_t usage_page = 0, usage = 0;      ///< HID usage; 0: not compared.
  bool serial = false;                          ///< The board is on a serial port, not on HID.
  bool bulk = false;                            ///< The board is on USB bulk transfers.
  /// The board sends unasked, and its reports have a check value or a number.
  bool proves_itself = false;
};

/// A connected board that may belong to an arm.
struct THIMBLE_EXPORT FoundArm {
  ArmKind kind = ArmKind::kUnsupported;  ///< Protocol of the board (arm_table.h).
  std::string arm;                       ///< Name of the arm ("WoodenHaptics").
  std::string bus;                       ///< Connection ("USB HID").
  std::string address;                   ///< Location on the bus ("bus 1, device 4").
  std::uint16_t vendor_id = 0;           ///< USB vendor id.
  std::uint16_t product_id = 0;          ///< USB product id.
  std::string serial;                    ///< Serial number; empty if the arm has none.
  UsbAddress usb;                        ///< USB bus and device number.
  /// Device node that a program opens ("/dev/hidraw3"); empty if there is none.
  std::string node;
  std::filesystem::path sysfs;              ///< Folder of the device in sysfs.
  bool accessible = false;                  ///< True if the user may open the node.
  BoardKind board = BoardKind::kOther;      ///< Kind of board.
  Certainty certainty = Certainty::kKnown;  ///< Certainty that it is an arm.
  std::string manufacturer, product;        ///< USB strings; empty if the device has none.
  std::uint16_t release = 0;                ///< USB release number (bcdDevice).
  /// Properties of its HID reports, if it is a HID device with a kernel driver.
  HidReports hid;
  bool serial_is_shared = false;  ///< True if another board has the same serial number.
  /// Versions that a vendor service or library reports; may be empty.
  std::string software;
  /// Reason why a service cannot use the arm now, in one sentence; empty if it can.
  std::string trouble;
  /// Name of the installed arm file that describes this board, if its kind is kDescribed.
  std::string arm_file;

  /// Returns the name shown to users, which is also the name of the arm's calibration. It is the
  /// serial number if that is unique. Otherwise it is the kernel's name of the USB socket
  /// ("usb-1-1.4"), which is the same after each reconnection to that socket.
  std::string name() const;
};

/// Returns whether a serial number is a default that many boards share, such as 0123456789 of every
/// mbed board. Such a number does not identify a board. Real-time: safe.
THIMBLE_EXPORT bool is_placeholder(std::string_view serial) noexcept;

/// Lists the USB boards that may be arms (app/guide/pages/driver.md lists the sources). Reads the
/// ids, strings and report descriptors that the kernel provides below `root`/sys. Opens no device
/// and needs no permission. If `root` is "/", it also lists the arms of vendor services on this
/// computer. It listens to these services for at most half a second and sends nothing. Fails if USB
/// devices cannot be listed and no service has an arm. `described` are boards that arm files
/// describe. Each is recognised only by its whole product string or by a usage of its vendor; its
/// ids alone prove nothing. Real-time: never from the servo thread.
THIMBLE_EXPORT Result<std::vector<FoundArm>> find_arms(
    const std::filesystem::path& root = "/", const std::vector<DescribedBoard>& described = {});

/// Returns the contents of a small kernel text file without its newline; empty if it cannot be
/// read. Real-time: never from the servo thread.
THIMBLE_EXPORT std::string read_line(const std::filesystem::path& file);

}  // namespace thimble::driver
