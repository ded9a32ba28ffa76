#pragma once

#include <cstdint>
#include <string>

#include "usb/usb_description.h"
#include "wires/wire_table.h"

namespace thimble::device_sim::usb {

// USB descriptions of the boards, byte for byte as their libraries send them. None of these
// functions may run on the servo thread.

/// The serial number of every mbed board [S mbed USBDevice.cpp, stringIserialDesc].
inline constexpr const char* kMbedSerial = "0123456789";

/// Returns the description of an mbed board with USBHID(report_size, report_size), including the
/// class's own ids 1234:0006 and bcdDevice 0001: boards differ in their report descriptor only [S
/// mbed USBHID.h, USBHID.cpp, USBDevice.cpp]. An empty serial number means kMbedSerial.
UsbDescription mbed_hid_description(std::uint8_t report_size, std::string serial);

/// Returns the description of a Teensy with the USB type "Raw HID". Raw reports are on its first
/// interface, an emulated serial port ("seremu") for debug output is on its second [S
/// PaulStoffregen/cores teensy3/usb_desc.h, usb_desc.c]. Its serial number is a decimal number of
/// each chip; an empty one means ours, 1234560.
UsbDescription teensy_raw_hid_description(std::string serial);

/// Returns the description of a HID board whose messages an arm file describes: its ids, product
/// string and usage. An empty serial number means ours, SIM0001.
UsbDescription described_hid_description(const driver::WireTable& wire, std::string serial);

/// Returns the description of a Novint Falcon. The strings are quoted from memory. An empty serial
/// number means ours, SIM0001.
UsbDescription falcon_description(std::string serial);

}  // namespace thimble::device_sim::usb
