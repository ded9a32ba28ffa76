#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "thimble/driver/clock.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/driver/transport.h"

namespace thimble::driver {

// The wires to real arms on HID and serial ports. Each keeps the clock by reference (its deadlines
// are on it), so the clock must outlive the transport. Opening is for set-up; the transports
// themselves are Real-time: safe, with what their libraries do beneath said at each.
// app/guide/pages/driver.md has the table.

/// Opens an arm on USB HID by its node (/dev/hidraw3), for this program alone (NodeLock). Messages
/// are filled up with zeros to `message_size` bytes (0: sent as they are), with report id 0 in
/// front. Fails if the device's report descriptor says that its messages have another length;
/// later, a message of another length is refused, because boards throw such messages away without a
/// word. Nothing is sent.
///
/// Reading takes the newest report and counts older ones. The kernel keeps 63 and drops what comes
/// after them; when so many wait, reading waits for the next, at most 2 ms. Nothing allocates while
/// the arm is there (hidapi makes an error text when it is not). Writing returns when the arm
/// has taken the message, one USB frame as a rule; the kernel itself waits up to 5 s for an arm
/// that refuses messages without an answer, during which the loop stands still and the arm's own
/// watchdog switches it off (Fault::kLoopStalled names it afterwards).
THIMBLE_EXPORT Result<std::unique_ptr<Transport>> open_hid_transport(const std::string& node,
                                                                     std::size_t message_size,
                                                                     const Clock& clock);

/// Opens an arm on a serial port by its node (/dev/serial/by-id/...), for this program alone
/// (NodeLock). Nothing is sent. Neither allocates nor locks. A message that the port has no room
/// for is refused, not waited for.
THIMBLE_EXPORT Result<std::unique_ptr<Transport>> open_serial_transport(const std::string& node,
                                                                        const Framing& framing,
                                                                        const Clock& clock);

/// Where the kernel put a USB device.
struct UsbAddress {
  int bus = 0;     ///< Number of the bus.
  int device = 0;  ///< Number of the device on it.
};

/// Returns the node of a USB device ("/dev/bus/usb/001/004"). Real-time: never from the servo
/// thread.
THIMBLE_EXPORT std::string usb_node(const UsbAddress& address);

}  // namespace thimble::driver
