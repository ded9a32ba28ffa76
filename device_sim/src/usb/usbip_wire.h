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

/// A request of a client before a device is attached.
struct UsbipRequest {
  /// Kind of a request.
  enum class Kind : std::uint8_t { kList, kImport };
  Kind kind = Kind::kList;  ///< Kind of this request.
  std::string bus_id;       ///< For kImport: the requested device.
  std::size_t size = 0;     ///< Bytes of the message.
};

/// One transfer that the host's controller submits, or cancels.
struct UsbipCommand {
  /// Kind of a command.
  enum class Kind : std::uint8_t { kSubmit, kUnlink };
  Kind kind = Kind::kSubmit;         ///< Kind of this command.
  std::uint32_t sequence = 0;        ///< Number of the command.
  std::uint32_t device = 0;          ///< (bus << 16) | device number.
  bool to_host = false;              ///< Direction of the data.
  std::uint8_t endpoint = 0;         ///< Number, 0 to 15.
  std::uint32_t length = 0;          ///< Bytes to move.
  std::uint32_t unlinked = 0;        ///< For kUnlink: sequence number of the cancelled transfer.
  std::array<std::byte, 8> setup{};  ///< For endpoint 0.
  std::size_t size = 0;  ///< Bytes of the message; data to the device are the last `length`.
};

/// Result of a decoder.
enum class Decode : std::uint8_t {
  kWhole,    ///< A whole message.
  kPartial,  ///< More bytes are needed.
  kInvalid,  ///< Not the start of a message; the connection must be closed.
};

/// Decodes a message of a client before a device is attached.
Decode decode_request(std::span<const std::byte> bytes, UsbipRequest& request);

/// Decodes a message of the host's controller after a device is attached. Isochronous transfers,
/// endpoints beyond 15 and transfers beyond kTransferMax are invalid.
Decode decode_command(std::span<const std::byte> bytes, UsbipCommand& command) noexcept;

/// Encodes the answer to a list request: this one device, or none.
std::vector<std::byte> encode_list(const UsbDescription* device, const std::string& bus_id);

/// Encodes the answer to an import request; a null device means "not here".
std::vector<std::byte> encode_import(const UsbDescription* device, const std::string& bus_id);

/// Appends the answer to a transfer: `status` is 0 or a negative errno of Linux, `moved` the bytes
/// moved, `data` the bytes for the host.
void append_submit_reply(std::vector<std::byte>& bytes, std::uint32_t sequence, std::int32_t status,
                         std::uint32_t moved, std::span<const std::byte> data);

/// Appends the answer to an unlink.
void append_unlink_reply(std::vector<std::byte>& bytes, std::uint32_t sequence,
                         std::int32_t status);

// The client's side, for tests and for attaching to the kernel.

/// Encodes a client's request.
std::vector<std::byte> encode_request(const UsbipRequest& request);

/// Encodes a transfer or an unlink with its data for the device.
std::vector<std::byte> encode_command(const UsbipCommand& command,
                                      std::span<const std::byte> data = {});

/// Answer to a transfer or an unlink.
struct UsbipReply {
  bool unlink = false;         ///< Whether it answers an unlink.
  std::uint32_t sequence = 0;  ///< Number of the answered command.
  std::int32_t status = 0;     ///< 0, or a negative errno.
  std::uint32_t moved = 0;     ///< Bytes transferred.
};

/// Decodes the header of an answer; data for the host follow it. Empty if it is not an answer.
std::optional<UsbipReply> decode_reply(std::span<const std::byte, kUsbipHeaderSize> bytes) noexcept;

/// Size of an import's answer, bytes, if the device is present, and if it is not.
inline constexpr std::size_t kImportReplySize = 8 + 0x138;
inline constexpr std::size_t kImportRefusalSize = 8;

}  // namespace thimble::device_sim::usb
