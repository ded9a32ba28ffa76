#include "usb/board_descriptions.h"

#include <array>
#include <utility>

#include "arms/hfab/hfab_report.h"
#include "usb/ftdi_chip.h"
#include "usb/hid_board.h"
#include "usb/usb_description.h"

namespace thimble::device_sim::usb {
namespace {

constexpr std::uint8_t kHidClass = 3;
constexpr std::uint8_t kProductString = 2;

// Vendor-defined page and usage, the same in both libraries [S mbed USBHID.cpp;
// teensy3/usb_desc.h].
constexpr std::uint16_t kRawHidPage = 0xffab;
constexpr std::uint16_t kRawHidUsage = 0x0200;

// The Teensy's emulated serial port [S teensy3/usb_desc.c, seremu_report_desc]: 64 bytes in, 32
// bytes out, a feature of 4 bytes.
constexpr std::array<unsigned, 33> kSeremuReports{0x06, 0xc9, 0xff,  // usage page 0xffc9
                                                  0x09, 0x04,        // usage 4
                                                  0xa1, 0x5c,        // collection 0x5c
                                                  0x75, 0x08,        // report size 8 bits
                                                  0x15, 0x00,        // logical minimum 0
                                                  0x26, 0xff, 0x00,  // logical maximum 255
                                                  0x95, 64,   0x09, 0x75, 0x81, 0x02, 0x95,
                                                  32,   0x09, 0x76, 0x91, 0x02, 0x95, 4,
                                                  0x09, 0x76, 0xb1, 0x02, 0xc0};

std::string or_else(std::string serial, const char* own) {
  return serial.empty() ? std::string(own) : std::move(serial);
}

InterfaceDescription raw_hid(std::uint8_t report_size, std::uint8_t in, std::uint8_t out) {
  InterfaceDescription interface;
  interface.interface_class = kHidClass;
  interface.report_descriptor =
      build_raw_report_descriptor(kRawHidPage, kRawHidUsage, report_size, report_size);
  interface.endpoints = {{in, TransferKind::kInterrupt, 64, 1},
                         {out, TransferKind::kInterrupt, 64, 1}};
  return interface;
}

InterfaceDescription seremu() {
  InterfaceDescription interface;
  interface.interface_class = kHidClass;
  for (const unsigned byte : kSeremuReports) {
    interface.report_descriptor.push_back(static_cast<std::byte>(byte));
  }
  interface.endpoints = {{0x81, TransferKind::kInterrupt, 64, 1},
                         {0x02, TransferKind::kInterrupt, 32, 2}};
  return interface;
}

}  // namespace

UsbDescription mbed_hid_description(std::uint8_t report_size, std::string serial) {
  UsbDescription d;
  d.vendor_id = 0x1234;
  d.product_id = 0x0006;
  d.release = 0x0001;
  d.power_2mA = 0;  // C_POWER(0)
  d.manufacturer = "mbed.org";
  d.product = "HID DEVICE";
  d.serial = or_else(std::move(serial), kMbedSerial);
  d.interfaces = {raw_hid(report_size, 0x81, 0x01)};
  return d;
}

UsbDescription teensy_raw_hid_description(std::string serial) {
  UsbDescription d;
  d.vendor_id = 0x16c0;
  d.product_id = 0x0486;
  d.release = 0x0100;
  d.manufacturer = "Teensyduino";
  d.product = "Teensyduino RawHID";
  d.serial = or_else(std::move(serial), "1234560");
  d.interfaces = {raw_hid(driver::hfab::kPaddedReportSize, kTeensy64Board.in, kTeensy64Board.out),
                  seremu()};
  return d;
}

UsbDescription described_hid_description(const driver::WireTable& wire, std::string serial) {
  const driver::WireIdentity& identity = wire.text.identity;
  UsbDescription d;
  d.vendor_id = identity.vendor_id;
  d.product_id = identity.product_id;
  d.release = 0x0100;
  d.manufacturer = "Thimble";
  d.product = identity.product.empty() ? "Simulated board" : identity.product;
  d.serial = or_else(std::move(serial), "SIM0001");
  InterfaceDescription interface = raw_hid(64, 0x81, 0x01);
  const bool own = identity.usage_page != 0;
  interface.report_descriptor = build_raw_report_descriptor(
      own ? identity.usage_page : kRawHidPage, own ? identity.usage : kRawHidUsage,
      static_cast<std::uint8_t>(wire.report.padded),
      static_cast<std::uint8_t>(wire.command.padded));
  d.interfaces = {std::move(interface)};
  return d;
}

UsbDescription falcon_description(std::string serial) {
  UsbDescription d;
  d.vendor_id = 0x0403;
  d.product_id = 0xcb48;
  d.release = 0x0400;  // FT232BM [S libftdi distinguishes chips by it]
  d.manufacturer = "FTDI";
  d.product = "FALCON HAPTIC";
  d.serial = or_else(std::move(serial), "SIM0001");
  InterfaceDescription interface;
  interface.string_index = kProductString;
  interface.endpoints = {{FtdiChip::kInEndpoint, TransferKind::kBulk, 64, 0},
                         {FtdiChip::kOutEndpoint, TransferKind::kBulk, 64, 0}};
  d.interfaces = {std::move(interface)};
  return d;
}

}  // namespace thimble::device_sim::usb
