#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace thimble::device_sim::usb {

/// Transfer type of an endpoint (bmAttributes of its descriptor [USB 2.0, 9.6.6]).
enum class TransferKind : std::uint8_t { kBulk = 2, kInterrupt = 3 };

/// An endpoint other than the control pipe.
struct EndpointDescription {
  std::uint8_t address = 0;  ///< Number, with bit 7 set if it sends to the host.
  TransferKind kind = TransferKind::kInterrupt;  ///< Transfer type.
  std::uint16_t packet_size = 64;                ///< Bytes; at most 64 at full speed.
  std::uint8_t interval = 0;  ///< Frames between two polls of an interrupt endpoint.

  bool to_host() const noexcept { return (address & 0x80U) != 0; }  ///< Returns the direction.
  std::uint8_t number() const noexcept { return address & 0x0fU; }  ///< Returns the number.
};

/// One interface of a device: a host binds a driver to each.
struct InterfaceDescription {
  std::uint8_t interface_class = 0xff;         ///< 3 for HID, 0xff for vendor-specific.
  std::uint8_t interface_subclass = 0;         ///< Subclass (0: none).
  std::uint8_t interface_protocol = 0;         ///< Protocol (0: none).
  std::uint8_t string_index = 0;               ///< String with its name (0: none).
  std::vector<std::byte> report_descriptor;    ///< For HID: the report descriptor.
  std::vector<EndpointDescription> endpoints;  ///< Endpoints other than the control endpoint.
};

/// A full-speed USB device with one configuration: the data that a host reads before it uses the
/// device's endpoints. Interfaces are numbered from 0 in their order.
struct UsbDescription {
  std::uint16_t vendor_id = 0;                   ///< Assigned to the maker by USB.
  std::uint16_t product_id = 0;                  ///< Assigned by the maker.
  std::uint16_t release = 0x0100;                ///< bcdDevice; some hosts distinguish chips by it.
  std::uint8_t power_2mA = 50;                   ///< bMaxPower: current from the bus, in 2 mA.
  std::string manufacturer, product, serial;     ///< ASCII; empty ones get no string descriptor.
  std::vector<InterfaceDescription> interfaces;  ///< At least one.

  /// Returns the endpoint with this address in any interface, or nullptr. Real-time: safe.
  const EndpointDescription* endpoint(std::uint8_t address) const noexcept;
};

/// Descriptor types [USB 2.0, table 9-5; HID 1.11, 7.1].
enum DescriptorKind : std::uint8_t {
  kDeviceDescriptor = 1,
  kConfigurationDescriptor = 2,
  kStringDescriptor = 3,
  kInterfaceDescriptor = 4,
  kEndpointDescriptor = 5,
  kHidDescriptor = 0x21,
  kReportDescriptor = 0x22,
};

/// Builds the descriptor that a host requests by GET_DESCRIPTOR with this kind and index; empty if
/// the device has none. `interface` selects the interface of a HID or report descriptor. Strings
/// are cut at 126 characters. Real-time: never from the servo thread.
std::vector<std::byte> build_descriptor(const UsbDescription& description, std::uint8_t kind,
                                        std::uint8_t index, std::uint8_t interface = 0);

/// Builds the report descriptor of a device that exchanges plain bytes. It has one report of
/// `in_bytes` to the host and one of `out_bytes` from it, without report ids, on a vendor's usage
/// page. The order of items is that of mbed's USBHID class and of Teensy's raw HID, which are the
/// same [S mbed USBHID.cpp; PaulStoffregen/cores teensy3/usb_desc.c]. Real-time: never from the
/// servo thread.
std::vector<std::byte> build_raw_report_descriptor(std::uint16_t usage_page, std::uint16_t usage,
                                                   std::uint8_t in_bytes, std::uint8_t out_bytes);

}  // namespace thimble::device_sim::usb
