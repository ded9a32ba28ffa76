#include "usb/usb_description.h"

#include <algorithm>
#include <initializer_list>

namespace thimble::device_sim::usb {
namespace {

using Bytes = std::vector<std::byte>;

constexpr std::uint8_t kControlPacketSize = 64;
constexpr std::uint8_t kSelfPowered = 0xc0;  // bit 7 is always set; an arm has its own supply
constexpr std::uint16_t kEnglish = 0x0409;
constexpr std::size_t kStringMax = 126;  // a descriptor's length is one byte

void put(Bytes& bytes, std::initializer_list<unsigned> values) {
  for (const unsigned value : values) bytes.push_back(static_cast<std::byte>(value & 0xffU));
}

void put_word(Bytes& bytes, unsigned value) {
  put(bytes, {value & 0xffU, (value >> 8) & 0xffU});
}

Bytes device_descriptor(const UsbDescription& d) {
  Bytes bytes;
  put(bytes, {18, kDeviceDescriptor});
  put_word(bytes, 0x0200);
  put(bytes, {0, 0, 0, kControlPacketSize});
  put_word(bytes, d.vendor_id);
  put_word(bytes, d.product_id);
  put_word(bytes, d.release);
  put(bytes, {d.manufacturer.empty() ? 0U : 1U, d.product.empty() ? 0U : 2U,
              d.serial.empty() ? 0U : 3U, 1});
  return bytes;
}

Bytes hid_descriptor(const InterfaceDescription& interface) {
  Bytes bytes;
  put(bytes, {9, kHidDescriptor, 0x11, 0x01, 0, 1, kReportDescriptor});
  put_word(bytes, static_cast<unsigned>(interface.report_descriptor.size()));
  return bytes;
}

// Interface, HID and endpoint descriptors, in the order that the HID class requires [HID 1.11,
// 7.1].
void put_interface(Bytes& bytes, const InterfaceDescription& interface, std::size_t number) {
  put(bytes, {9, kInterfaceDescriptor, static_cast<unsigned>(number), 0,
              static_cast<unsigned>(interface.endpoints.size()), interface.interface_class,
              interface.interface_subclass, interface.interface_protocol, interface.string_index});
  if (!interface.report_descriptor.empty()) {
    const Bytes hid = hid_descriptor(interface);
    bytes.insert(bytes.end(), hid.begin(), hid.end());
  }
  for (const EndpointDescription& endpoint : interface.endpoints) {
    put(bytes,
        {7, kEndpointDescriptor, endpoint.address, static_cast<std::uint8_t>(endpoint.kind)});
    put_word(bytes, endpoint.packet_size);
    put(bytes, {endpoint.interval});
  }
}

Bytes configuration_descriptor(const UsbDescription& d) {
  Bytes inner;
  for (std::size_t i = 0; i < d.interfaces.size(); ++i) put_interface(inner, d.interfaces[i], i);
  Bytes bytes;
  put(bytes, {9, kConfigurationDescriptor});
  put_word(bytes, static_cast<unsigned>(9 + inner.size()));
  put(bytes, {static_cast<unsigned>(d.interfaces.size()), 1, 0, kSelfPowered, d.power_2mA});
  bytes.insert(bytes.end(), inner.begin(), inner.end());
  return bytes;
}

Bytes string_descriptor(const std::string& text) {
  Bytes bytes;
  const std::size_t length = std::min(text.size(), kStringMax);
  put(bytes, {static_cast<unsigned>(2 + 2 * length), kStringDescriptor});
  for (std::size_t i = 0; i < length; ++i) {
    put_word(bytes, static_cast<unsigned char>(text[i]));  // UTF-16 of ASCII
  }
  return bytes;
}

Bytes string_by_index(const UsbDescription& d, std::uint8_t index) {
  Bytes bytes;
  switch (index) {
    case 0:
      put(bytes, {4, kStringDescriptor});
      put_word(bytes, kEnglish);
      return bytes;
    case 1:
      return d.manufacturer.empty() ? bytes : string_descriptor(d.manufacturer);
    case 2:
      return d.product.empty() ? bytes : string_descriptor(d.product);
    case 3:
      return d.serial.empty() ? bytes : string_descriptor(d.serial);
    default:
      return bytes;
  }
}

}  // namespace

const EndpointDescription* UsbDescription::endpoint(std::uint8_t address) const noexcept {
  for (const InterfaceDescription& interface : interfaces) {
    for (const EndpointDescription& found : interface.endpoints) {
      if (found.address == address) return &found;
    }
  }
  return nullptr;
}

std::vector<std::byte> build_descriptor(const UsbDescription& description, std::uint8_t kind,
                                        std::uint8_t index, std::uint8_t interface) {
  const InterfaceDescription* const asked =
      interface < description.interfaces.size() ? &description.interfaces[interface] : nullptr;
  switch (kind) {
    case kDeviceDescriptor:
      return index == 0 ? device_descriptor(description) : Bytes{};
    case kConfigurationDescriptor:
      return index == 0 ? configuration_descriptor(description) : Bytes{};
    case kStringDescriptor:
      return string_by_index(description, index);
    case kHidDescriptor:
      if (asked == nullptr || asked->report_descriptor.empty()) return {};
      return hid_descriptor(*asked);
    case kReportDescriptor:
      return asked == nullptr ? Bytes{} : asked->report_descriptor;
    default:
      return {};
  }
}

std::vector<std::byte> build_raw_report_descriptor(std::uint16_t usage_page, std::uint16_t usage,
                                                   std::uint8_t in_bytes, std::uint8_t out_bytes) {
  Bytes bytes;
  put(bytes, {0x06});  // usage page
  put_word(bytes, usage_page);
  put(bytes, {0x0a});  // usage
  put_word(bytes, usage);
  put(bytes, {0xa1, 0x01});                               // application collection
  put(bytes, {0x75, 0x08});                               // report size 8 bits
  put(bytes, {0x15, 0x00});                               // logical minimum 0
  put(bytes, {0x26, 0xff, 0x00});                         // logical maximum 255
  put(bytes, {0x95, in_bytes, 0x09, 0x01, 0x81, 0x02});   // number of inputs: data, variable
  put(bytes, {0x95, out_bytes, 0x09, 0x02, 0x91, 0x02});  // number of outputs
  put(bytes, {0xc0});
  return bytes;
}

}  // namespace thimble::device_sim::usb
