#include "thimble/device_sim/usb/usbip_server.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/timerfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <utility>

#include "usb/usbip_session.h"

namespace thimble::device_sim::usb {
namespace {

std::int64_t monotonic_ns() noexcept {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * std::int64_t{1'000'000'000} + now.tv_nsec;
}

driver::Error trouble(const std::string& what) {
  return {what + ": " + std::strerror(errno) + "."};
}

void add(UsbipCounters& sum, const UsbipCounters& more) noexcept {
  sum.submitted += more.submitted;
  sum.completed += more.completed;
  sum.stalled += more.stalled;
  sum.babbled += more.babbled;
  sum.unlinked += more.unlinked;
}

}  // namespace

driver::Result<std::unique_ptr<UsbipServer>> UsbipServer::open(
    FaultyDevice& device, const UsbipServerSettings& settings) {
  auto server = std::make_unique<UsbipServer>(device, settings.bus_id);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(settings.port);
  if (inet_pton(AF_INET, settings.address.c_str(), &address.sin_addr) != 1) {
    return driver::Error{"'" + settings.address +
                         "' is not an IPv4 address. Use 127.0.0.1 to serve this machine only."};
  }
  server->listener_ = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (server->listener_ < 0) return trouble("Cannot create a socket for the USB/IP server");
  const int yes = 1;
  setsockopt(server->listener_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  socklen_t size = sizeof address;
  if (bind(server->listener_, reinterpret_cast<const sockaddr*>(&address), size) != 0 ||
      listen(server->listener_, 8) != 0 ||
      getsockname(server->listener_, reinterpret_cast<sockaddr*>(&address), &size) != 0) {
    return trouble("Cannot listen on " + settings.address + ":" + std::to_string(settings.port) +
                   "; select another port by --port, or end the other USB/IP server");
  }
  server->port_ = ntohs(address.sin_port);
  return server;
}

UsbipServer::UsbipServer(FaultyDevice& device, std::string bus_id)
    : device_(device), bus_id_(std::move(bus_id)) {}

UsbipServer::~UsbipServer() {
  for (const Client& client : clients_) close(client.socket);
  if (listener_ >= 0) close(listener_);
}

void UsbipServer::adopt(int socket) {
  fcntl(socket, F_SETFL, fcntl(socket, F_GETFL) | O_NONBLOCK);
  // Answers are small and the client waits for each. Not every socket is TCP; then this fails.
  const int yes = 1;
  setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  clients_.push_back({socket, std::make_unique<UsbipSession>(device_, bus_id_), false, now_ns_});
}

bool UsbipServer::attached() const noexcept {
  return std::any_of(clients_.begin(), clients_.end(), [](const Client& client) {
    return client.session->state() == UsbipSession::State::kAttached;
  });
}

UsbipCounters UsbipServer::counters() const noexcept {
  UsbipCounters sum = past_;
  for (const Client& client : clients_) add(sum, client.session->counters());
  return sum;
}

void UsbipServer::accept_client() {
  const int socket = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
  if (socket < 0) return;
  if (clients_.size() >= kClientsMax && !make_room()) {
    close(socket);
    return;
  }
  adopt(socket);
}

/// Disconnects the oldest client that has not attached the device; false if there is none.
bool UsbipServer::make_room() {
  const auto oldest = std::find_if(clients_.begin(), clients_.end(), [](const Client& client) {
    return client.session->state() != UsbipSession::State::kAttached;
  });
  if (oldest == clients_.end()) return false;
  oldest->heard_all = true;
  drop_finished();
  return true;
}

/// Disconnects clients that keep the server waiting for too long.
void UsbipServer::drop_late() {
  for (Client& client : clients_) {
    const bool waits = client.session->state() != UsbipSession::State::kAttached ||
                       !client.session->output().empty();
    if (waits && now_ns_ - client.since_ns > kPatience_ns) client.heard_all = true;
  }
}

void UsbipServer::take(Client& client) {
  std::array<std::byte, 4096> bytes;
  const bool was_attached = client.session->state() == UsbipSession::State::kAttached;
  const ssize_t size = recv(client.socket, bytes.data(), bytes.size(), MSG_DONTWAIT);
  if (size > 0) {
    const bool available = device_.plugged() && !attached();
    client.session->receive(std::span<const std::byte>(bytes).first(static_cast<std::size_t>(size)),
                            available);
    const bool attached_now = client.session->state() == UsbipSession::State::kAttached;
    if (attached_now && !was_attached) client.since_ns = now_ns_;
  } else if (size == 0 || (errno != EAGAIN && errno != EINTR)) {
    client.heard_all = true;
  }
}

void UsbipServer::send_ready(Client& client) {
  std::vector<std::byte>& output = client.session->output();
  const bool attached = client.session->state() == UsbipSession::State::kAttached;
  if (attached && output.empty()) client.since_ns = now_ns_;
  while (!output.empty()) {
    const ssize_t size =
        send(client.socket, output.data(), output.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (size <= 0) {
      if (size < 0 && errno != EAGAIN && errno != EINTR) client.heard_all = true;
      return;
    }
    output.erase(output.begin(), output.begin() + size);
    if (attached) client.since_ns = now_ns_;
  }
}

void UsbipServer::drop_finished() {
  std::erase_if(clients_, [this](const Client& client) {
    const bool sent_all = client.session->state() == UsbipSession::State::kClosing &&
                          client.session->output().empty();
    if (!client.heard_all && !sent_all) return false;
    add(past_, client.session->counters());
    close(client.socket);
    return true;
  });
}

void UsbipServer::serve(int timeout_ms) {
  std::vector<pollfd> waits;
  for (const Client& client : clients_) {
    const int in = client.session->takes_more() ? POLLIN : 0;
    const int out = client.session->output().empty() ? 0 : POLLOUT;
    waits.push_back({client.socket, static_cast<short>(in | out), 0});
  }
  const std::size_t known = waits.size();
  if (listener_ >= 0) waits.push_back({listener_, POLLIN, 0});
  if (poll(waits.data(), waits.size(), timeout_ms) <= 0) return;
  for (std::size_t i = 0; i < known; ++i) {
    if (!clients_[i].session->takes_more()) {
      if ((waits[i].revents & (POLLHUP | POLLERR)) != 0) clients_[i].heard_all = true;
    } else if ((waits[i].revents & (POLLIN | POLLHUP | POLLERR)) != 0) {
      take(clients_[i]);
    }
    send_ready(clients_[i]);
  }
  if (listener_ >= 0 && waits.back().revents != 0) accept_client();
  drop_finished();
}

void UsbipServer::frame(std::int64_t time_ns) {
  now_ns_ = time_ns;
  device_.advance_to(time_ns);
  drop_late();
  for (Client& client : clients_) {
    if (client.session->state() != UsbipSession::State::kAttached) continue;
    client.session->frame(time_ns);
    if (!device_.plugged()) client.heard_all = true;
    send_ready(client);
  }
  drop_finished();
}

void UsbipServer::send_bulk(std::int64_t time_ns) {
  for (Client& client : clients_) {
    if (!client.session->has_bulk_to_send()) continue;
    device_.advance_to(time_ns);
    client.session->send_bulk();
    send_ready(client);
  }
}

void UsbipServer::run(const std::atomic<bool>& stop, const FrameObserver& observer) {
  const int timer = timerfd_create(CLOCK_MONOTONIC, TFD_CLOEXEC | TFD_NONBLOCK);
  const itimerspec every_frame{{0, UsbDevice::kFrame_ns}, {0, UsbDevice::kFrame_ns}};
  const std::int64_t start_ns = monotonic_ns();
  timerfd_settime(timer, 0, &every_frame, nullptr);
  std::int64_t number = 0;
  while (!stop.load(std::memory_order_relaxed)) {
    std::uint64_t passed = 0;
    if (read(timer, &passed, sizeof passed) == sizeof passed && passed > 0) {
      late_frames_ += passed - 1;
      number += static_cast<std::int64_t>(passed);
      serve(0);  // requests from before the frame belong to it
      frame(number * UsbDevice::kFrame_ns);
      if (observer) observer(number);
      continue;
    }
    wait_for(timer);
    serve(0);
    // The running frame ends only when its timer expires.
    const std::int64_t end_ns = (number + 1) * UsbDevice::kFrame_ns - 1;
    send_bulk(std::min(monotonic_ns() - start_ns, end_ns));
  }
  close(timer);
}

void UsbipServer::wait_for(int timer) {
  std::array<pollfd, kClientsMax + 2> waits;
  nfds_t count = 0;
  waits[count++] = {timer, POLLIN, 0};
  if (listener_ >= 0) waits[count++] = {listener_, POLLIN, 0};
  for (const Client& client : clients_) {
    if (count < waits.size() && client.session->takes_more()) {
      waits[count++] = {client.socket, POLLIN, 0};
    }
  }
  poll(waits.data(), count, 100);
}

}  // namespace thimble::device_sim::usb
