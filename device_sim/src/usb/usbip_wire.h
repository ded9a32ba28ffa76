#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "usb/usb_description.h"

namespace thimble::device_sim::usb {

// Messages of USB/IP, version 1.1.1, as the kernel documents them [Linux,
// Documentation/usb/usbip_protocol.rst]; all numbers big endian. Decoders are total: any bytes are
// one message, the start of one, or rejected, and nothing is read beyond the span.
// Real-time: never from the servo thread (they are socket code).

inline constexpr std::uint16_t kUsbipVersion = 0x0111;
inline constexpr std::size_t kBusIdSize = 32;          ///< Bytes of a bus id, zero-padded.
inline constexpr std::size_t kUsbipHeaderSize = 48;    ///< Bytes before a transfer's data.
inline constexpr std::size_t kTransferMax = 1U << 16;  ///< Larger transfers are refused, bytes.

/// What a client asks before a device is attached.
struct UsbipRequest {
  /// What a client asks.
  enum class Kind : std::uint8_t { kList, kImport };
  Kind kind = Kind::kList;  ///< What is asked.
  std::string bus_id;       ///< For kImport: the device it wants.
  std::size_t size = 0;     ///< Bytes of the message.
};

/// One transfer that the host's controller hands over, or takes back.
struct UsbipCommand {
  /// What the host asks.
  enum class Kind : std::uint8_t { kSubmit, kUnlink };
  Kind kind = Kind::kSubmit;         ///< What is asked.
  std::uint32_t sequence = 0;        ///< Number of the command.
  std::uint32_t device = 0;          ///< (bus << 16) | device number.
  bool to_host = false;              ///< Direction of the data.
  std::uint8_t endpoint = 0;         ///< Number, 0 to 15.
  std::uint32_t length = 0;          ///< Bytes to move.
  std::uint32_t unlinked = 0;        ///< For kUnlink: sequence number of the transfer taken back.
  std::array<std::byte, 8> setup{};  ///< For endpoint 0.
  std::size_t size = 0;  ///< Bytes of the whole message; its last `length` are the data if
                         ///< they go to the device.
};

/// How far a decoder came.
enum class Decode : std::uint8_t {
  kWhole,    ///< A whole message.
  kPartial,  ///< More bytes are needed.
  kInvalid,  ///< No message can begin like this; the connection is of no use any more.
};

/// Decodes what a client says before a device is attached.
Decode decode_request(std::span<const std::byte> bytes, UsbipRequest& request);

/// Decodes what the host's controller says once a device is attached. Isochronous transfers,
/// endpoints beyond 15 and transfers beyond kTransferMax are invalid.
Decode decode_command(std::span<const std::byte> bytes, UsbipCommand& command) noexcept;

/// Encodes the answer to a list request: this one device, or none.
std::vector<std::byte> encode_list(const UsbDescription* device, const std::string& bus_id);

/// Encodes the answer to an import request; a null device means "not here".
std::vector<std::byte> encode_import(const UsbDescription* device, const std::string& bus_id);

/// Appends the answer to a transfer: `status` is 0 or a negative errno of Linux, `moved` the bytes
/// moved, `data` what goes to the host.
void append_submit_reply(std::vector<std::byte>& bytes, std::uint32_t sequence, std::int32_t status,
                         std::uint32_t moved, std::span<const std::byte> data);

/// Appends the answer to an unlink.
void append_unlink_reply(std::vector<std::byte>& bytes, std::uint32_t sequence,
                         std::int32_t status);

// The other side, for tests and for attaching to the kernel.

/// Encodes a client's request.
std::vector<std::byte> encode_request(const UsbipRequest& request);

/// Encodes a transfer or an unlink with the data that goes to the device.
std::vector<std::byte> encode_command(const UsbipCommand& command,
                                      std::span<const std::byte> data = {});

/// The answer to a transfer or an unlink.
struct UsbipReply {
  bool unlink = false;         ///< Whether it answers an unlink.
  std::uint32_t sequence = 0;  ///< Number of the command that it answers.
  std::int32_t status = 0;     ///< 0, or a negative errno.
  std::uint32_t moved = 0;     ///< Bytes that went over.
};

/// Decodes the header of an answer; data to the host follow it. Empty if it is none.
std::optional<UsbipReply> decode_reply(std::span<const std::byte, kUsbipHeaderSize> bytes) noexcept;

/// The bytes of an import's answer when the device is there, and when it is not.
inline constexpr std::size_t kImportReplySize = 8 + 0x138;
inline constexpr std::size_t kImportRefusalSize = 8;

}  // namespace thimble::device_sim::usb
