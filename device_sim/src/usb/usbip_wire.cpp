#include "usb/usbip_wire.h"
#include "usb/usb_description.h"

#include <algorithm>

namespace thimble::device_sim::usb {
namespace {

using Bytes = std::vector<std::byte>;

constexpr std::uint16_t kRequestList = 0x8005, kReplyList = 0x0005;
constexpr std::uint16_t kRequestImport = 0x8003, kReplyImport = 0x0003;
constexpr std::uint32_t kCommandSubmit = 1, kCommandUnlink = 2;
constexpr std::uint32_t kReplySubmit = 3, kReplyUnlink = 4;
constexpr std::size_t kRequestHeaderSize = 8;
constexpr std::size_t kPathSize = 256;
constexpr std::uint32_t kNotIsochronous = 0xffffffffU;
constexpr std::uint32_t kFullSpeed = 2;  // enum usb_device_speed of Linux
constexpr std::uint32_t kBus = 1, kDevice = 1;

std::uint32_t get(std::span<const std::byte> bytes, std::size_t at, std::size_t size) noexcept {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < size; ++i) {
    value = (value << 8) | std::to_integer<std::uint32_t>(bytes[at + i]);
  }
  return value;
}

void put(Bytes& bytes, std::uint32_t value, std::size_t size) {
  for (std::size_t i = size; i-- > 0;) {
    bytes.push_back(static_cast<std::byte>((value >> (8 * i)) & 0xffU));
  }
}

void put_text(Bytes& bytes, const std::string& text, std::size_t size) {
  for (std::size_t i = 0; i < size; ++i) {
    // The last byte stays zero, so that the text is always terminated.
    const bool inside = i < text.size() && i + 1 < size;
    bytes.push_back(inside ? static_cast<std::byte>(text[i]) : std::byte{0});
  }
}

void put_device(Bytes& bytes, const UsbDescription& device, const std::string& bus_id) {
  put_text(bytes, "/simulated/" + bus_id, kPathSize);
  put_text(bytes, bus_id, kBusIdSize);
  put(bytes, kBus, 4);
  put(bytes, kDevice, 4);
  put(bytes, kFullSpeed, 4);
  put(bytes, device.vendor_id, 2);
  put(bytes, device.product_id, 2);
  put(bytes, device.release, 2);
  put(bytes, 0, 3);  // class, subclass and protocol are those of the interfaces
  put(bytes, 1, 1);  // configuration
  put(bytes, 1, 1);  // number of configurations
  put(bytes, static_cast<std::uint32_t>(device.interfaces.size()), 1);
}

void put_header(Bytes& bytes, std::uint32_t command, std::uint32_t sequence, std::uint32_t device,
                bool to_host, std::uint32_t endpoint) {
  put(bytes, command, 4);
  put(bytes, sequence, 4);
  put(bytes, device, 4);
  put(bytes, to_host ? 1 : 0, 4);
  put(bytes, endpoint, 4);
}

void pad_to_header(Bytes& bytes, std::size_t begin) {
  bytes.resize(begin + kUsbipHeaderSize, std::byte{0});
}

}  // namespace

Decode decode_request(std::span<const std::byte> bytes, UsbipRequest& request) {
  if (bytes.size() < kRequestHeaderSize) return Decode::kPartial;
  // Versions differ in the kernel's protocol, not in these messages; only the code matters.
  const std::uint32_t code = get(bytes, 2, 2);
  if (code == kRequestList) {
    request = {.kind = UsbipRequest::Kind::kList, .bus_id = {}, .size = kRequestHeaderSize};
    return Decode::kWhole;
  }
  if (code != kRequestImport) return Decode::kInvalid;
  if (bytes.size() < kRequestHeaderSize + kBusIdSize) return Decode::kPartial;
  request = {
      .kind = UsbipRequest::Kind::kImport, .bus_id = {}, .size = kRequestHeaderSize + kBusIdSize};
  for (const std::byte letter : bytes.subspan(kRequestHeaderSize, kBusIdSize)) {
    if (letter == std::byte{0}) break;
    request.bus_id.push_back(static_cast<char>(letter));
  }
  return Decode::kWhole;
}

Decode decode_command(std::span<const std::byte> bytes, UsbipCommand& command) noexcept {
  if (bytes.size() < 4) return Decode::kPartial;
  const std::uint32_t code = get(bytes, 0, 4);
  if (code != kCommandSubmit && code != kCommandUnlink) return Decode::kInvalid;
  if (bytes.size() < kUsbipHeaderSize) return Decode::kPartial;
  const std::uint32_t direction = get(bytes, 12, 4);
  const std::uint32_t endpoint = get(bytes, 16, 4);
  if (direction > 1 || endpoint > 15) return Decode::kInvalid;
  UsbipCommand decoded;
  decoded.sequence = get(bytes, 4, 4);
  decoded.device = get(bytes, 8, 4);
  decoded.to_host = direction == 1;
  decoded.endpoint = static_cast<std::uint8_t>(endpoint);
  decoded.size = kUsbipHeaderSize;
  if (code == kCommandUnlink) {
    decoded.kind = UsbipCommand::Kind::kUnlink;
    decoded.unlinked = get(bytes, 20, 4);
    command = decoded;
    return Decode::kWhole;
  }
  decoded.length = get(bytes, 24, 4);
  const std::uint32_t packets = get(bytes, 32, 4);
  // Older kernels send 0 packets instead of "not isochronous".
  if (packets != kNotIsochronous && packets != 0) return Decode::kInvalid;
  if (decoded.length > kTransferMax) return Decode::kInvalid;
  std::copy_n(bytes.begin() + 40, decoded.setup.size(), decoded.setup.begin());
  if (!decoded.to_host) decoded.size += decoded.length;
  if (bytes.size() < decoded.size) return Decode::kPartial;
  command = decoded;
  return Decode::kWhole;
}

std::vector<std::byte> encode_list(const UsbDescription* device, const std::string& bus_id) {
  Bytes bytes;
  put(bytes, kUsbipVersion, 2);
  put(bytes, kReplyList, 2);
  put(bytes, 0, 4);
  put(bytes, device != nullptr ? 1 : 0, 4);
  if (device == nullptr) return bytes;
  put_device(bytes, *device, bus_id);
  for (const InterfaceDescription& interface : device->interfaces) {
    put(bytes, interface.interface_class, 1);
    put(bytes, interface.interface_subclass, 1);
    put(bytes, interface.interface_protocol, 1);
    put(bytes, 0, 1);
  }
  return bytes;
}

std::vector<std::byte> encode_import(const UsbDescription* device, const std::string& bus_id) {
  Bytes bytes;
  put(bytes, kUsbipVersion, 2);
  put(bytes, kReplyImport, 2);
  put(bytes, device != nullptr ? 0 : 1, 4);
  if (device != nullptr) put_device(bytes, *device, bus_id);
  return bytes;
}

void append_submit_reply(std::vector<std::byte>& bytes, std::uint32_t sequence, std::int32_t status,
                         std::uint32_t moved, std::span<const std::byte> data) {
  const std::size_t begin = bytes.size();
  put_header(bytes, kReplySubmit, sequence, 0, false, 0);
  put(bytes, static_cast<std::uint32_t>(status), 4);
  put(bytes, moved, 4);
  put(bytes, 0, 4);
  put(bytes, kNotIsochronous, 4);
  pad_to_header(bytes, begin);
  bytes.insert(bytes.end(), data.begin(), data.end());
}

void append_unlink_reply(std::vector<std::byte>& bytes, std::uint32_t sequence,
                         std::int32_t status) {
  const std::size_t begin = bytes.size();
  put_header(bytes, kReplyUnlink, sequence, 0, false, 0);
  put(bytes, static_cast<std::uint32_t>(status), 4);
  pad_to_header(bytes, begin);
}

std::vector<std::byte> encode_request(const UsbipRequest& request) {
  Bytes bytes;
  const bool list = request.kind == UsbipRequest::Kind::kList;
  put(bytes, kUsbipVersion, 2);
  put(bytes, list ? kRequestList : kRequestImport, 2);
  put(bytes, 0, 4);
  if (!list) put_text(bytes, request.bus_id, kBusIdSize);
  return bytes;
}

std::vector<std::byte> encode_command(const UsbipCommand& command,
                                      std::span<const std::byte> data) {
  Bytes bytes;
  const bool submit = command.kind == UsbipCommand::Kind::kSubmit;
  put_header(bytes, submit ? kCommandSubmit : kCommandUnlink, command.sequence, command.device,
             command.to_host, command.endpoint);
  if (submit) {
    put(bytes, 0, 4);
    put(bytes, command.length, 4);
    put(bytes, 0, 4);
    put(bytes, kNotIsochronous, 4);
    put(bytes, 0, 4);
    bytes.insert(bytes.end(), command.setup.begin(), command.setup.end());
  } else {
    put(bytes, command.unlinked, 4);
    pad_to_header(bytes, 0);
  }
  bytes.insert(bytes.end(), data.begin(), data.end());
  return bytes;
}

std::optional<UsbipReply> decode_reply(
    std::span<const std::byte, kUsbipHeaderSize> bytes) noexcept {
  const std::uint32_t code = get(bytes, 0, 4);
  if (code != kReplySubmit && code != kReplyUnlink) return std::nullopt;
  UsbipReply reply;
  reply.unlink = code == kReplyUnlink;
  reply.sequence = get(bytes, 4, 4);
  reply.status = static_cast<std::int32_t>(get(bytes, 20, 4));
  if (!reply.unlink) reply.moved = get(bytes, 24, 4);
  return reply;
}

}  // namespace thimble::device_sim::usb
