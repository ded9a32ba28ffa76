#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "thimble/driver/arm_link.h"
#include "thimble/driver/arm_model.h"
#include "thimble/driver/clock.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/driver/transport.h"
#include "thimble/driver/transports.h"
#include "wires/wire_table.h"

namespace thimble::driver {

// Opening of described boards. Real-time: never from the servo thread.

/// Opens the wire of a described board by its node. Nothing is sent before the board has proven
/// what can be checked by listening: a board that streams must send 20 valid reports in a row, with
/// consecutive numbers if they are numbered. Then the start-up messages are sent, and each expected
/// answer must arrive in time. Precondition: the USB identity of the board is that of the
/// description (check_fits in thimble/scene/real_arm.h).
/// `usb`: address of a board on bulk transfers.
THIMBLE_EXPORT Result<std::unique_ptr<Transport>> open_described(const std::string& node,
                                                                 const WireTable& wire,
                                                                 const Clock& clock,
                                                                 const UsbAddress& usb = {});

/// Opens a described board that streams, without sending anything: neither start-up messages nor
/// the last message. Nothing is checked; for measurements.
THIMBLE_EXPORT Result<std::unique_ptr<Transport>> open_to_listen(const std::string& node,
                                                                 const WireTable& wire,
                                                                 const Clock& clock,
                                                                 const UsbAddress& usb = {});

/// Returns the number of damaged messages that a described board's port has dropped so far, if it
/// finds messages in a stream of bytes; else 0.
THIMBLE_EXPORT std::uint64_t torn_messages(const Transport& port) noexcept;

/// Listens to a board that streams, without sending; see open_described.
THIMBLE_EXPORT Result<void> listen_for_described(Transport& transport, const WireTable& wire,
                                                 const Clock& clock);

}  // namespace thimble::driver
