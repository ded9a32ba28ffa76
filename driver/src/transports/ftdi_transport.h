#pragma once

#include <libusb-1.0/libusb.h>

#include <memory>

#include "thimble/driver/clock.h"
#include "thimble/driver/result.h"
#include "thimble/driver/transport.h"
#include "thimble/driver/transports.h"

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

/// Endpoints of a board on USB bulk transfers.
struct BulkEnds {
  unsigned char in = kFtdiEndpointIn;    ///< Endpoint of bytes from the board.
  unsigned char out = kFtdiEndpointOut;  ///< Endpoint of bytes to the board.
  bool ftdi = true;  ///< Each packet begins with the two status bytes of an FTDI converter.
};

/// Opens a USB device, detaches the kernel's driver from its first interface if necessary, and
/// claims it. Only one program can. Real-time: never from the servo thread.
Result<FtdiUsb> open_bulk_device(const UsbAddress& address, const BulkEnds& ends);

/// Starts continuous reading of the converter or board. Real-time: never from the servo thread.
Result<std::unique_ptr<Transport>> start_ftdi_transport(FtdiUsb usb, const Framing& framing,
                                                        const Clock& clock,
                                                        const BulkEnds& ends = {});

}  // namespace thimble::driver
