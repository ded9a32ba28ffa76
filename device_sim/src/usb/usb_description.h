#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace thimble::device_sim::usb {

/// How an endpoint moves data (bmAttributes of its descriptor [USB 2.0, 9.6.6]).
enum class TransferKind : std::uint8_t { kBulk = 2, kInterrupt = 3 };

/// Describes one endpoint besides the control pipe.
struct EndpointDescription {
  std::uint8_t address = 0;  ///< Number, with bit 7 set if it sends to the host.
  TransferKind kind = TransferKind::kInterrupt;  ///< How it carries packets.
  std::uint16_t packet_size = 64;                ///< Bytes; at most 64 at full speed.
  std::uint8_t interval = 0;  ///< Frames between two polls of an interrupt endpoint.

  bool to_host() const noexcept { return (address & 0x80U) != 0; }  ///< Its direction.
  std::uint8_t number() const noexcept { return address & 0x0fU; }  ///< Its number.
};

/// One interface of a device: a host binds a driver to each.
struct InterfaceDescription {
  std::uint8_t interface_class = 0xff;         ///< 3 for HID, 0xff for the vendor's own.
  std::uint8_t interface_subclass = 0;         ///< Of its class (0: none).
  std::uint8_t interface_protocol = 0;         ///< Of its subclass (0: none).
  std::uint8_t string_index = 0;               ///< String that names it (0: none).
  std::vector<std::byte> report_descriptor;    ///< For HID: what the reports hold.
  std::vector<EndpointDescription> endpoints;  ///< But for the control endpoint.
};

/// A full-speed USB device with one configuration: what a host reads before it talks to the
/// device's endpoints. Interfaces are numbered from 0 in their order.
struct UsbDescription {
  std::uint16_t vendor_id = 0;                   ///< USB's, of the maker.
  std::uint16_t product_id = 0;                  ///< The maker's.
  std::uint16_t release = 0x0100;                ///< bcdDevice; some hosts tell chips apart by it.
  std::uint8_t power_2mA = 50;                   ///< bMaxPower: current from the bus, in 2 mA.
  std::string manufacturer, product, serial;     ///< ASCII; empty ones get no string descriptor.
  std::vector<InterfaceDescription> interfaces;  ///< At least one.

  /// Returns the endpoint of this address in any interface, or nullptr. Real-time: safe.
  const EndpointDescription* endpoint(std::uint8_t address) const noexcept;
};

/// The kind of a descriptor [USB 2.0, table 9-5; HID 1.11, 7.1].
enum DescriptorKind : std::uint8_t {
  kDeviceDescriptor = 1,
  kConfigurationDescriptor = 2,
  kStringDescriptor = 3,
  kInterfaceDescriptor = 4,
  kEndpointDescriptor = 5,
  kHidDescriptor = 0x21,
  kReportDescriptor = 0x22,
};

/// Builds the descriptor that a host asks for by GET_DESCRIPTOR with this kind and index; empty if
/// the device has none. `interface` says whose HID or report descriptor it is. Strings are cut at
/// 126 characters. Real-time: never from the servo thread.
std::vector<std::byte> build_descriptor(const UsbDescription& description, std::uint8_t kind,
                                        std::uint8_t index, std::uint8_t interface = 0);

/// Builds the report descriptor of a device that exchanges plain bytes: one report of `in_bytes` to
/// the host and one of `out_bytes` from it, no report ids, on a vendor's usage page, item by item
/// in the order of mbed's USBHID class and of Teensy's raw HID, which are the same [S mbed
/// USBHID.cpp; PaulStoffregen/cores teensy3/usb_desc.c]. Real-time: never from the servo thread.
std::vector<std::byte> build_raw_report_descriptor(std::uint16_t usage_page, std::uint16_t usage,
                                                   std::uint8_t in_bytes, std::uint8_t out_bytes);

}  // namespace thimble::device_sim::usb
