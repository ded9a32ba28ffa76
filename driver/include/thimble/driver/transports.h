#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "thimble/driver/clock.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/driver/transport.h"

namespace thimble::driver {

// Transports to real arms on HID and serial ports. Each keeps a reference to the clock of its
// deadlines, so the clock must outlive it. Opening is for set-up. The transports themselves are
// Real-time: safe; each comment states what its library does. app/guide/pages/driver.md has the
// table.

/// Opens an arm on USB HID by its node (/dev/hidraw3), for exclusive use by this program
/// (NodeLock). Messages are padded with zeros to `message_size` bytes (0: sent unchanged) and
/// preceded by report id 0. Fails if the report descriptor of the device specifies another message
/// length. Later, a message of another length is refused, because boards silently discard such
/// messages. Opening sends nothing.
///
/// Reading returns the newest report and counts older ones. The kernel queues 63 reports and drops
/// further ones; if the queue is full, a read waits for the next report, at most 2 ms. Nothing is
/// allocated while the arm is connected (hidapi creates an error text when it is not). A write
/// returns when the arm has accepted the message, normally after one USB frame. For an arm that
/// refuses messages without an answer, the kernel waits up to 5 s. The loop then stops, and the
/// arm's own watchdog switches it off (afterwards Fault::kLoopStalled).
THIMBLE_EXPORT Result<std::unique_ptr<Transport>> open_hid_transport(const std::string& node,
                                                                     std::size_t message_size,
                                                                     const Clock& clock);

/// Opens an arm on a serial port by its node (/dev/serial/by-id/...), for exclusive use by this
/// program (NodeLock). Opening sends nothing. The transport neither allocates nor locks. A message
/// for which the port has no room is refused; the write does not wait. `baud`: bit rate, which USB
/// serial boards ignore.
THIMBLE_EXPORT Result<std::unique_ptr<Transport>> open_serial_transport(const std::string& node,
                                                                        const Framing& framing,
                                                                        const Clock& clock,
                                                                        int baud = 115200);

/// Address of a USB device in the kernel.
struct UsbAddress {
  int bus = 0;     ///< Number of the bus.
  int device = 0;  ///< Number of the device on it.
};

/// Returns the node of a USB device ("/dev/bus/usb/001/004"). Real-time: never from the servo
/// thread.
THIMBLE_EXPORT std::string usb_node(const UsbAddress& address);

}  // namespace thimble::driver
