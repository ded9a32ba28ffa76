#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::device_sim::usb {

/// Folder of the kernel's virtual USB host in sysfs [Linux, drivers/usb/usbip/vhci_sysfs.c].
inline constexpr const char* kVhciFolder = "/sys/devices/platform/vhci_hcd.0";

/// Returns the first free port for a full-speed device in the kernel's table of ports; empty if
/// there is none. Accepts any text. Real-time: never from the servo thread.
THIMBLE_EXPORT std::optional<int> find_free_port(std::string_view status);

/// Attaches a device of a USB/IP server on this machine to this kernel: imports it over TCP and
/// passes the socket to the virtual host, which keeps it. Requires root and the module vhci-hcd.
/// Returns the port of the virtual host. The error states the remedy. Waits for the server, which
/// must run on another thread. Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<int> attach_to_kernel(
    std::uint16_t port, const std::string& bus_id, const std::filesystem::path& vhci = kVhciFolder);

}  // namespace thimble::device_sim::usb
