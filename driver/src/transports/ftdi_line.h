#pragma once

#include <memory>

#include "thimble/driver/clock.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/driver/transport.h"
#include "thimble/driver/transports.h"
#include "transports/serial_line.h"

namespace thimble::driver {

/// An arm behind an FTDI converter: a serial line for the set-up, then a transport.
class THIMBLE_EXPORT FtdiLine : public SerialLine {
 public:
  /// Opens the converter, detaches it from the kernel's serial driver if necessary, and claims it.
  /// Only one program can. Fails with the name of the program that holds it.
  static Result<std::unique_ptr<FtdiLine>> open(const UsbAddress& address);

  /// Turns the line into a transport; the line is unusable afterwards. All transfers are allocated
  /// here and reused. libusb itself allocates a request block per transfer and takes its own
  /// (uncontended) locks. FTDI's two status bytes per packet are removed.
  virtual Result<std::unique_ptr<Transport>> into_transport(const Framing& framing,
                                                            const Clock& clock) = 0;
};

}  // namespace thimble::driver
