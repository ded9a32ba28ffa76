#pragma once

#include <libusb-1.0/libusb.h>

#include <memory>

#include "thimble/driver/clock.h"
#include "thimble/driver/result.h"
#include "thimble/driver/transport.h"

namespace thimble::driver {

// Endpoints and interface of a single-port FTDI converter [S libnifalcon].
inline constexpr unsigned char kFtdiEndpointIn = 0x81, kFtdiEndpointOut = 0x02;
inline constexpr int kFtdiInterface = 0;

/// Closes a libusb context. Real-time: never from the servo thread.
struct CloseContext {
  void operator()(libusb_context* context) const noexcept { libusb_exit(context); }
};

/// Releases an interface and closes its device. Real-time: never from the servo thread.
struct CloseHandle {
  void operator()(libusb_device_handle* handle) const noexcept {
    libusb_release_interface(handle, kFtdiInterface);
    libusb_close(handle);
  }
};

/// An open and claimed converter. The handle is destroyed before its context.
struct FtdiUsb {
  std::unique_ptr<libusb_context, CloseContext> context;
  std::unique_ptr<libusb_device_handle, CloseHandle> handle;
};

/// Starts continuous reading of the converter. Real-time: never from the servo thread.
Result<std::unique_ptr<Transport>> start_ftdi_transport(FtdiUsb usb, const Framing& framing,
                                                        const Clock& clock);

}  // namespace thimble::driver
