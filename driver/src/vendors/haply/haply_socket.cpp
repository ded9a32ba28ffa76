#include "vendors/haply/haply_socket.h"

#include <sys/eventfd.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <cerrno>
#include <chrono>
#include <utility>

#include "transports/socket_owner.h"

namespace thimble::driver::haply {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using boost::system::error_code;

constexpr std::size_t kMessageMax =
    256 * 1024;  // bytes; a message of one arm has some hundreds. [chosen]
constexpr auto kCloseTimeout = std::chrono::milliseconds(100);

}  // namespace

class Socket::Connection {
 public:
  Connection() : ring_fd_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
    if (ring_fd_ >= 0) bell_.assign(ring_fd_);
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// Connects and waits for the first message; returns an error message, empty on success.
  std::string open(std::uint16_t port, std::chrono::nanoseconds timeout) {
    if (ring_fd_ < 0)
      return "Cannot create an event descriptor, because too many files are open. Close some of "
             "them.";
    const auto until = std::chrono::steady_clock::now() + timeout;
    error_code failed;
    for (const char* host : {"127.0.0.1", "::1"}) {
      tcp::socket& socket = stream_.next_layer();
      error_code ignored;
      socket.close(ignored);
      failed = asio::error::timed_out;
      socket.async_connect({asio::ip::make_address(host), port},
                           [&failed](const error_code& code) { failed = code; });
      wait(until);
      if (!failed) break;
    }
    if (failed) return "No server listens on port " + std::to_string(port) + " of this computer.";
    error_code ignored;
    stream_.next_layer().set_option(tcp::no_delay(true), ignored);
    stream_.read_message_max(kMessageMax);
    failed = asio::error::timed_out;
    stream_.async_handshake(answer_, "localhost:" + std::to_string(port), "/",
                            [&failed](const error_code& code) { failed = code; });
    wait(until);
    if (failed)
      return "The server on port " + std::to_string(port) +
             " does not accept WebSocket connections.";
    failed = asio::error::timed_out;
    stream_.async_read(buffer_, [&failed](const error_code& code, std::size_t) { failed = code; });
    wait(until);
    if (failed) return "The server on port " + std::to_string(port) + " sends no messages.";
    first_ = take_text();
    // The service has accepted the connection only now, so the kernel knows its process.
    const std::string stranger = distrust_of_peer(stream_.next_layer().native_handle());
    if (!stranger.empty()) {
      return "The server on port " + std::to_string(port) + " is " + stranger +
             ". Only a service of your own user or of root is used.";
    }
    return {};
  }

  const std::string& first() const { return first_; }
  bool is_stand_in() const {
    const auto server = answer_[beast::http::field::server];
    return server.starts_with("Thimble");
  }

  void serve(SocketCallbacks& traffic) {
    traffic_ = &traffic;
    io_.restart();
    read();
    listen();
    io_.run();
    if (!leave_.load(std::memory_order_acquire)) traffic.lost();
  }

  void ring() noexcept {
    const std::uint64_t one = 1;
    // Fails only if a wake-up is already pending, or if a signal interrupts it.
    constexpr int kInterruptionsMax = 16;  // chosen: more than a timer sends in a tick
    for (int i = 0; i < kInterruptionsMax; ++i) {
      if (::write(ring_fd_, &one, sizeof one) >= 0 || errno != EINTR) break;
    }
  }

  void leave() noexcept {
    leave_.store(true, std::memory_order_release);
    ring();
  }

 private:
  /// Runs the pending operation until it is done; cancels it at `until`.
  void wait(std::chrono::steady_clock::time_point until) {
    io_.restart();
    io_.run_until(until);
    if (io_.stopped()) return;
    error_code ignored;
    stream_.next_layer().close(ignored);
    io_.restart();
    io_.run();
  }

  std::string take_text() {
    std::string text = beast::buffers_to_string(buffer_.data());
    buffer_.consume(buffer_.size());
    return text;
  }

  void read() {
    stream_.async_read(buffer_, [this](const error_code& failed, std::size_t) {
      // During closing, the close operation ends it.
      if (failed && leaving_) return;
      if (failed) return end();
      const auto data = buffer_.data();
      traffic_->received({static_cast<const char*>(data.data()), data.size()});
      buffer_.consume(buffer_.size());
      push();
      read();
    });
  }

  void listen() {
    bell_.async_read_some(asio::buffer(rings_), [this](const error_code& failed, std::size_t) {
      if (failed) return end();
      if (leave_.load(std::memory_order_acquire)) schedule_close();
      push();
      listen();
    });
  }

  /// Ends the connection within kCloseTimeout, independent of the server.
  void schedule_close() {
    if (close_scheduled_) return;
    close_scheduled_ = true;
    deadline_.expires_after(kCloseTimeout);
    deadline_.async_wait([this](const error_code&) { io_.stop(); });
  }

  void push() {
    if (writing_ || leaving_) return;
    if (leave_.load(std::memory_order_acquire)) return send_last_message();
    auto message = traffic_->next_message();
    if (message) write(std::move(*message));
  }

  void write(std::string message) {
    writing_ = true;
    message_ = std::move(message);
    stream_.text(true);
    stream_.async_write(asio::buffer(message_), [this](const error_code& failed, std::size_t) {
      writing_ = false;
      if (failed) return end();
      if (leaving_) return close();
      push();
    });
  }

  void send_last_message() {
    leaving_ = true;
    write(traffic_->last_message());
  }

  void close() {
    stream_.async_close(websocket::close_code::normal, [this](const error_code&) { io_.stop(); });
  }

  void end() { io_.stop(); }

  asio::io_context io_{1};
  websocket::stream<tcp::socket> stream_{io_};
  asio::posix::stream_descriptor bell_{io_};
  asio::steady_timer deadline_{io_};
  websocket::response_type answer_;
  beast::flat_buffer buffer_;
  std::array<std::uint64_t, 1> rings_{};
  std::string first_, message_;
  SocketCallbacks* traffic_ = nullptr;
  bool writing_ = false, leaving_ = false, close_scheduled_ = false;
  std::atomic<bool> leave_{false};
  int ring_fd_;
};

Socket::Socket(std::unique_ptr<Connection> connection) : connection_(std::move(connection)) {}
Socket::~Socket() = default;

Result<std::unique_ptr<Socket>> Socket::connect(std::uint16_t port, std::int64_t timeout_ns) {
  auto connection = std::make_unique<Connection>();
  std::string trouble = connection->open(port, std::chrono::nanoseconds(timeout_ns));
  if (!trouble.empty()) return Error{std::move(trouble)};
  return std::unique_ptr<Socket>(new Socket(std::move(connection)));
}

const std::string& Socket::first() const {
  return connection_->first();
}
bool Socket::is_stand_in() const {
  return connection_->is_stand_in();
}
void Socket::serve(SocketCallbacks& traffic) {
  connection_->serve(traffic);
}
void Socket::ring() noexcept {
  connection_->ring();
}
void Socket::leave() noexcept {
  connection_->leave();
}

}  // namespace thimble::driver::haply
