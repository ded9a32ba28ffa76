#include "compat/haply/haply_service.h"

#include <sys/socket.h>

#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <exception>
#include <list>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include "compat/haply/served_arms.h"
#include "thimble/version.h"
#include "transports/loopback_acceptor.h"
#include "transports/socket_owner.h"

namespace thimble::compat::haply {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using boost::system::error_code;

constexpr std::size_t kMessageMax = 256 * 1024;            // bytes; typical are some hundreds
constexpr std::size_t kProgramsMax = 16;                   // simultaneous programs [chosen]
constexpr auto kRequestTimeout = std::chrono::seconds(1);  // for a client that sends no request
constexpr auto kPause = std::chrono::milliseconds(1);

/// Returns whether the client is a program of this computer and not a web page of another: browsers
/// send the page's origin, programs send none.
bool is_local_origin(std::string_view origin) {
  if (origin.empty()) return true;
  const std::size_t scheme = origin.find("://");
  if (scheme == std::string_view::npos) return false;
  std::string_view host = origin.substr(scheme + 3);
  const std::size_t port = host.rfind(':');
  if (port != std::string_view::npos && !host.ends_with(']')) host = host.substr(0, port);
  return host == "localhost" || host == "127.0.0.1" || host == "[::1]";
}

/// One client program, with its own thread.
class Program {
 public:
  explicit Program(int session) : session_(session) {}
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;
  ~Program() {
    if (thread_.joinable()) thread_.join();
  }

  /// Waits for a program; false if none could be accepted.
  bool accept(tcp::acceptor& acceptor) {
    error_code failed;
    acceptor.accept(socket(), failed);
    if (failed) return false;
    error_code ignored;
    socket().set_option(tcp::no_delay(true), ignored);
    return true;
  }

  /// Returns why the program is refused, as a phrase; empty: it is accepted.
  std::string refusal_reason() { return driver::distrust_of_peer(socket().native_handle()); }

  void begin(ServedArms& arms) {
    thread_ = std::thread([this, &arms] {
      try {
        serve(arms);
      } catch (const std::exception&) {  // out of memory, say: as after a disconnect
      }
      arms.leave(session_);
      stream_.next_layer().close();
      done_.store(true, std::memory_order_release);
    });
  }
  bool done() const noexcept { return done_.load(std::memory_order_acquire); }
  /// Closes its connection, which ends pending operations. Any thread, while it exists.
  void cut() {
    asio::post(io_, [this] { stream_.next_layer().close(); });
  }

 private:
  tcp::socket& socket() { return stream_.next_layer().socket(); }

  /// Runs one operation to completion; returns whether it succeeded.
  template <class Begin>
  bool run(Begin&& begin) {
    std::optional<error_code> ended;
    begin([&ended](const error_code& code, auto...) { ended = code; });
    io_.restart();
    while (!ended && io_.run_one() > 0) {
    }
    return ended && !*ended;
  }

  bool greet() {
    http::request<http::string_body> request;
    stream_.next_layer().expires_after(kRequestTimeout);
    if (!run([&](auto done) { http::async_read(stream_.next_layer(), buffer_, request, done); })) {
      return false;
    }
    const auto origin = request[http::field::origin];
    if (!websocket::is_upgrade(request) || !is_local_origin({origin.data(), origin.size()})) {
      refuse(websocket::is_upgrade(request) ? http::status::forbidden
                                            : http::status::upgrade_required);
      return false;
    }
    stream_.next_layer().expires_never();
    stream_.set_option(
        websocket::stream_base::timeout{.handshake_timeout = kRequestTimeout,
                                        .idle_timeout = websocket::stream_base::none(),
                                        .keep_alive_pings = false});
    stream_.read_message_max(kMessageMax);
    stream_.set_option(websocket::stream_base::decorator([](websocket::response_type& response) {
      response.set(http::field::server, std::string(kServerName) + " " + THIMBLE_VERSION);
    }));
    return run([&](auto done) { stream_.async_accept(request, done); });
  }

  void refuse(http::status status) {
    http::response<http::string_body> response(status, 11);
    response.set(http::field::content_type, "text/plain");
    response.body() = "This is a WebSocket server for programs on this computer.\n";
    response.prepare_payload();
    run([&](auto done) { http::async_write(stream_.next_layer(), response, done); });
  }

  bool send(const std::string& text) {
    stream_.text(true);
    return run([&](auto done) { stream_.async_write(asio::buffer(text), done); });
  }

  void serve(ServedArms& arms) {
    if (!greet() || !send(arms.greet(session_))) return;
    buffer_.consume(buffer_.size());
    while (run([&](auto done) { stream_.async_read(buffer_, done); })) {
      const auto data = buffer_.cdata();
      const std::string answer =
          arms.answer(session_, {static_cast<const char*>(data.data()), data.size()});
      buffer_.consume(buffer_.size());
      if (!send(answer)) return;
    }
  }

  int session_;
  asio::io_context io_{1};
  websocket::stream<beast::tcp_stream> stream_{io_};
  beast::flat_buffer buffer_;
  std::atomic<bool> done_{false};
  std::thread thread_;
};

}  // namespace

class Service::Listener {
 public:
  explicit Listener(Report report) : report_(std::move(report)) {}
  ~Listener() {
    leave();
    if (thread_.joinable()) thread_.join();
  }

  /// Starts to listen.
  driver::Result<void> begin(std::uint16_t port) {
    const auto listens = driver::listen_on_loopback(
        acceptor_, port,
        "If Haply's own service is running, stop it, or choose another port (--port).");
    if (!listens) return listens.error();
    port_ = *listens;
    thread_ = std::thread([this] { listen(); });
    return {};
  }

  std::uint16_t port() const noexcept { return port_; }
  bool ready() const noexcept { return ready_.load(std::memory_order_acquire); }
  int programs() const noexcept { return came_.load(std::memory_order_relaxed); }
  int refused() const noexcept { return refused_.load(std::memory_order_acquire); }
  bool ended() const noexcept { return ended_.load(std::memory_order_acquire); }

  void leave() {
    leaves_.store(true, std::memory_order_release);
    ::shutdown(acceptor_.native_handle(), SHUT_RDWR);
    const std::lock_guard lock(mutex_);
    for (Program& program : programs_) program.cut();
  }

 private:
  void listen() {
    arms_.open();
    ready_.store(true, std::memory_order_release);
    for (int session = 1; !leaves_.load(std::memory_order_acquire); ++session) {
      std::list<Program> one;
      if (!one.emplace_back(session).accept(acceptor_)) {
        std::this_thread::sleep_for(kPause);  // too many open files, for example
        continue;
      }
      if (const std::string stranger = one.front().refusal_reason(); !stranger.empty()) {
        refuse(stranger);
        continue;
      }
      const std::lock_guard lock(mutex_);
      programs_.remove_if([](const Program& program) { return program.done(); });
      if (leaves_.load(std::memory_order_acquire)) break;
      if (programs_.size() >= kProgramsMax) continue;
      came_.fetch_add(1, std::memory_order_relaxed);
      one.front().begin(arms_);
      programs_.splice(programs_.end(), one);
    }
    for (Program* program = first(); program != nullptr; program = first()) {
      while (!program->done()) std::this_thread::sleep_for(kPause);
      const std::lock_guard lock(mutex_);
      programs_.pop_front();
    }
    arms_.close();
    ended_.store(true, std::memory_order_release);
  }

  void refuse(const std::string& stranger) {
    if (refused_.load(std::memory_order_relaxed) == 0 && report_) {
      report_("Refused " + stranger + " on port " + std::to_string(port_) +
              ": only programs of your user or of root may request forces.");
    }
    refused_.fetch_add(1, std::memory_order_release);
  }

  Program* first() {
    const std::lock_guard lock(mutex_);
    return programs_.empty() ? nullptr : &programs_.front();
  }

  asio::io_context io_{1};
  tcp::acceptor acceptor_{io_};
  ServedArms arms_;
  std::mutex mutex_;
  std::list<Program> programs_;  // connected programs
  std::atomic<bool> ready_{false}, leaves_{false}, ended_{false};
  std::atomic<int> came_{0}, refused_{0};
  Report report_;
  std::uint16_t port_ = 0;
  std::thread thread_;
};

Service::Service(std::unique_ptr<Listener> listener) : listener_(std::move(listener)) {}
Service::~Service() = default;

driver::Result<std::unique_ptr<Service>> Service::listen(std::uint16_t port, Report report) {
  auto listener = std::make_unique<Listener>(std::move(report));
  if (const auto begun = listener->begin(port); !begun) return begun.error();
  return std::unique_ptr<Service>(new Service(std::move(listener)));
}

std::uint16_t Service::port() const noexcept {
  return listener_->port();
}
bool Service::ready() const noexcept {
  return listener_->ready();
}
int Service::programs() const noexcept {
  return listener_->programs();
}
int Service::refused() const noexcept {
  return listener_->refused();
}
void Service::leave() {
  listener_->leave();
}
bool Service::ended() const noexcept {
  return listener_->ended();
}

}  // namespace thimble::compat::haply
