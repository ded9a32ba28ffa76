#include "thimble/device_sim/usb/vhci.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <vector>

#include "usb/usbip_wire.h"

namespace thimble::device_sim::usb {
namespace {

constexpr int kPortIsFree = 4;         // VDEV_ST_NULL [Linux, usbip_common.h]
constexpr unsigned kDevice = 0x10001;  // bus 1, device 1
constexpr int kFullSpeed = 2;          // enum usb_device_speed of Linux

/// Closes a file descriptor at the end of a block.
struct Descriptor {
  int number = -1;
  explicit Descriptor(int n) : number(n) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (number >= 0) close(number);
  }
};

driver::Error trouble(const std::string& what) {
  return {what + ": " + std::strerror(errno) + "."};
}

driver::Result<std::string> read_text(const std::filesystem::path& file) {
  const Descriptor in(open(file.c_str(), O_RDONLY | O_CLOEXEC));
  if (in.number < 0) {
    return driver::Error{
        "This kernel has no virtual USB host. Run as root: modprobe vhci-hcd (Debian: part of the "
        "kernel package). Then attach again."};
  }
  std::array<char, 4096> text;
  const ssize_t size = read(in.number, text.data(), text.size());
  if (size < 0) return trouble("Cannot read " + file.string());
  return std::string(text.data(), static_cast<std::size_t>(size));
}

// Requests the device from the server; leaves the socket ready for transfers.
driver::Result<void> import_device(int socket, std::uint16_t port, const std::string& bus_id) {
  const timeval limit{5, 0};
  setsockopt(socket, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
  const int yes = 1;
  setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    return trouble("Cannot reach the USB/IP server on port " + std::to_string(port));
  }
  const std::vector<std::byte> request =
      encode_request({.kind = UsbipRequest::Kind::kImport, .bus_id = bus_id, .size = 0});
  if (send(socket, request.data(), request.size(), MSG_NOSIGNAL) !=
      static_cast<ssize_t>(request.size())) {
    return trouble("Cannot request the device from the USB/IP server");
  }
  std::array<std::byte, kImportReplySize> reply{};
  std::size_t size = 0;
  while (size < reply.size()) {
    const ssize_t more = recv(socket, reply.data() + size, reply.size() - size, 0);
    if (more <= 0) break;
    size += static_cast<std::size_t>(more);
  }
  const bool refused = size >= kImportRefusalSize && reply[7] != std::byte{0};
  if (size < reply.size() || refused) {
    return driver::Error{"The USB/IP server refused the device " + bus_id +
                         "; another client may use it."};
  }
  const timeval forever{0, 0};
  setsockopt(socket, SOL_SOCKET, SO_RCVTIMEO, &forever, sizeof forever);
  return {};
}

}  // namespace

std::optional<int> find_free_port(std::string_view status) {
  // Lines: "hs  0000 004 000 00000000 000000 0-0": hub, port, state, speed, device, socket, bus id.
  while (!status.empty()) {
    const std::size_t end = std::min(status.find('\n'), status.size());
    const std::string line(status.substr(0, end));
    status.remove_prefix(std::min(end + 1, status.size()));
    int port = 0, state = 0;
    if (std::sscanf(line.c_str(), "hs %d %d", &port, &state) != 2) continue;  // NOLINT
    if (state == kPortIsFree) return port;
  }
  return std::nullopt;
}

driver::Result<int> attach_to_kernel(std::uint16_t port, const std::string& bus_id,
                                     const std::filesystem::path& vhci) {
  const auto status = read_text(vhci / "status");
  if (!status) return status.error();
  const std::optional<int> free_port = find_free_port(*status);
  if (!free_port) {
    return driver::Error{"All ports of the virtual USB host are in use. Detach a device first."};
  }
  const Descriptor attach(open((vhci / "attach").c_str(), O_WRONLY | O_CLOEXEC));
  if (attach.number < 0) {
    return driver::Error{
        "Only root can attach a device to the kernel. Run the command as root, or run as root: "
        "usbip attach -r 127.0.0.1 -b " +
        bus_id + "."};
  }
  const Descriptor socket(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  if (socket.number < 0) return trouble("Cannot create a socket to the USB/IP server");
  if (const auto imported = import_device(socket.number, port, bus_id); !imported) {
    return imported.error();
  }
  const std::string order = std::to_string(*free_port) + " " + std::to_string(socket.number) + " " +
                            std::to_string(kDevice) + " " + std::to_string(kFullSpeed);
  if (write(attach.number, order.data(), order.size()) != static_cast<ssize_t>(order.size())) {
    return trouble("The kernel refused the device");
  }
  return *free_port;
}

}  // namespace thimble::device_sim::usb
