#pragma once

#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "thimble/device_sim/usb/usbip_server.h"
#include "usb/setup_packet.h"
#include "usb/usbip_wire.h"

namespace thimble::support {

/// A USB host in this process: a USB/IP client of a server over a socket pair, on one thread and in
/// simulated time, frame by frame.
class UsbHost {
 public:
  /// Result of a transfer.
  struct Done {
    std::int32_t status = 0;
    std::vector<std::byte> data;  // to the host
    std::uint32_t moved = 0;
    std::int64_t frame = 0;  // in which it completed
  };

  explicit UsbHost(device_sim::usb::UsbipServer& server) : server_(server) {
    std::array<int, 2> pair{-1, -1};
    if (socketpair(AF_UNIX, SOCK_STREAM, 0, pair.data()) != 0) return;
    socket_ = pair[0];
    server_.adopt(pair[1]);
  }
  UsbHost(const UsbHost&) = delete;
  UsbHost& operator=(const UsbHost&) = delete;
  ~UsbHost() { hang_up(); }

  void hang_up() {
    if (socket_ >= 0) close(socket_);
    socket_ = -1;
    server_.serve(0);
  }

  /// Sends raw bytes.
  void say(std::span<const std::byte> bytes) {
    (void)!send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    server_.serve(0);
  }

  /// Returns the bytes from the server that were not an answer to a transfer.
  std::vector<std::byte> hear() {
    listen();
    return std::exchange(heard_, {});
  }

  /// Returns whether the server closed the connection.
  bool hung_up() {
    listen();
    return closed_;
  }

  /// Imports the device; returns whether the server granted it.
  bool import_device() {
    say(device_sim::usb::encode_request({.kind = device_sim::usb::UsbipRequest::Kind::kImport,
                                         .bus_id = server_.bus_id(),
                                         .size = 0}));
    const std::vector<std::byte> reply = hear();
    attached_ = reply.size() == device_sim::usb::kImportReplySize;
    return attached_;
  }

  /// Submits a transfer, whose answer comes in a later frame. Returns its sequence number.
  std::uint32_t submit(bool to_host, std::uint8_t endpoint, std::span<const std::byte> out,
                       std::uint32_t length, std::array<std::byte, 8> setup = {}) {
    device_sim::usb::UsbipCommand command;
    command.sequence = ++sequence_;
    command.device = 0x10001;
    command.to_host = to_host;
    command.endpoint = endpoint;
    command.length = to_host ? length : static_cast<std::uint32_t>(out.size());
    command.setup = setup;
    to_host_[command.sequence] = to_host;
    say(device_sim::usb::encode_command(command, out));
    return command.sequence;
  }

  /// Submits a read of a packet.
  std::uint32_t ask(std::uint8_t endpoint, std::uint32_t length) {
    return submit(true, endpoint, {}, length);
  }
  /// Submits a write of a packet.
  std::uint32_t tell(std::uint8_t endpoint, std::span<const std::byte> out) {
    return submit(false, endpoint, out, 0);
  }
  /// Cancels a transfer; the answer has the returned number.
  std::uint32_t take_back(std::uint32_t sequence) {
    device_sim::usb::UsbipCommand command;
    command.kind = device_sim::usb::UsbipCommand::Kind::kUnlink;
    command.sequence = ++sequence_;
    command.unlinked = sequence;
    say(device_sim::usb::encode_command(command));
    return command.sequence;
  }

  /// Runs frames.
  void frames(int count = 1) {
    for (int i = 0; i < count; ++i) {
      ++frame_;
      server_.frame(frame_ * device_sim::usb::UsbDevice::kFrame_ns);
      listen();
    }
  }
  std::int64_t frame() const { return frame_; }

  /// Sends pending bulk data to the device now, in the middle of a frame (ns).
  void send_bulk(std::int64_t time_ns) {
    server_.send_bulk(time_ns);
    listen();
  }

  /// Returns the answer to a transfer, if it has arrived.
  std::optional<Done> done(std::uint32_t sequence) {
    listen();
    const auto found = done_.find(sequence);
    if (found == done_.end()) return std::nullopt;
    Done result = found->second;
    done_.erase(found);
    return result;
  }

  /// Runs a control transfer in one frame.
  std::optional<Done> control(const device_sim::usb::SetupPacket& setup,
                              std::span<const std::byte> out = {}) {
    const auto byte = [](unsigned value) { return static_cast<std::byte>(value & 0xffU); };
    const std::array<std::byte, 8> bytes{
        byte(setup.request_type), byte(setup.request),      byte(setup.value),
        byte(setup.value >> 8U),  byte(setup.index),        byte(setup.index >> 8U),
        byte(setup.length),       byte(setup.length >> 8U),
    };
    const std::uint32_t sequence = submit(setup.to_host(), 0, out, setup.length, bytes);
    frames();
    return done(sequence);
  }

  /// Selects configuration 1, as every host does before it uses an endpoint.
  void configure() { (void)control({.request_type = 0, .request = 9, .value = 1}); }

 private:
  void listen() {
    std::array<std::byte, 4096> bytes;
    while (socket_ >= 0) {
      const ssize_t size = recv(socket_, bytes.data(), bytes.size(), MSG_DONTWAIT);
      if (size == 0) closed_ = true;
      if (size <= 0) break;
      heard_.insert(heard_.end(), bytes.begin(), bytes.begin() + size);
    }
    while (attached_ && heard_.size() >= device_sim::usb::kUsbipHeaderSize) {
      const auto reply = device_sim::usb::decode_reply(
          std::span<const std::byte>(heard_).first<device_sim::usb::kUsbipHeaderSize>());
      if (!reply) return;
      const auto direction = to_host_.find(reply->sequence);
      const bool data = direction != to_host_.end() && direction->second;
      const std::size_t size = device_sim::usb::kUsbipHeaderSize + (data ? reply->moved : 0);
      if (heard_.size() < size) return;
      Done result;
      result.status = reply->status;
      result.moved = reply->moved;
      result.frame = frame_;
      result.data.assign(heard_.begin() + device_sim::usb::kUsbipHeaderSize,
                         heard_.begin() + static_cast<std::ptrdiff_t>(size));
      done_[reply->sequence] = result;
      to_host_.erase(reply->sequence);
      heard_.erase(heard_.begin(), heard_.begin() + static_cast<std::ptrdiff_t>(size));
    }
  }

  device_sim::usb::UsbipServer& server_;
  int socket_ = -1;
  bool attached_ = false, closed_ = false;
  std::uint32_t sequence_ = 0;
  std::int64_t frame_ = 0;
  std::vector<std::byte> heard_;
  std::map<std::uint32_t, bool> to_host_;
  std::map<std::uint32_t, Done> done_;
};

}  // namespace thimble::support
