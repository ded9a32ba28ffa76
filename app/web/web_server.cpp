#include "web/web_server.h"

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <list>
#include <optional>
#include <string_view>
#include <utility>

#include "transports/loopback_acceptor.h"
#include "transports/socket_owner.h"
#include "web/connection.h"
#include "web/live_feed.h"
#include "web/request_guard.h"
#include "web/steer_run.h"

namespace thimble::web {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using boost::system::error_code;

constexpr std::size_t kConnectionsMax = 64;  // including refused ones; chosen
constexpr std::size_t kClosingMax = 64;      // additional connections that are closing; chosen

std::string_view view_of(beast::string_view text) {
  return {text.data(), text.size()};
}

}  // namespace

class WebServer::Parts {
 public:
  Parts(session::RunAttachment& runs, RequestGuard guard) : runs_(runs), guard_(std::move(guard)) {}
  ~Parts() {
    error_code ignored;
    acceptor_.close(ignored);
    cut_all();
  }

  /// Starts to listen.
  driver::Result<void> begin(std::uint16_t port) {
    const auto listens = driver::listen_on_loopback(
        acceptor_, port, "Choose another one with --port, or omit it to use any free port.");
    if (!listens) return listens.error();
    port_ = *listens;
    accept();
    return {};
  }

  const RequestGuard& guard() const noexcept { return guard_; }
  std::uint16_t port() const noexcept { return port_; }
  std::size_t pages() const noexcept {
    return static_cast<std::size_t>(
        std::count_if(connections_.begin(), connections_.end(),
                      [](const Connection& one) { return one.is_page(); }));
  }

  void step() {
    serve_for(kStep);
    if (runs_.step()) {
      // Pages of the previous run must reload. Pages that connected before the first run wait for
      // it.
      for (Connection& connection : connections_) {
        if (feed_) connection.close(websocket::close_code::service_restart, "another run");
      }
      feed_.emplace(*runs_.reader());
    }
    if (!feed_) return;
    feed_->step();
    for (Connection& connection : connections_) connection.send_updates(*feed_);
  }

  void leave(std::chrono::milliseconds max_time) {
    error_code ignored;
    acceptor_.close(ignored);
    const auto end = std::chrono::steady_clock::now() + max_time;
    const auto has_all = [this](const Connection& one) {
      return !one.is_page() || one.has_all(feed_ ? &*feed_ : nullptr);
    };
    while (!std::all_of(connections_.begin(), connections_.end(), has_all) &&
           std::chrono::steady_clock::now() < end) {
      for (Connection& connection : connections_) {
        if (feed_) connection.send_updates(*feed_);
      }
      serve_for(std::chrono::milliseconds(10));
    }
    for (Connection& connection : connections_)
      connection.close(websocket::close_code::normal, "ended");
    while (!connections_.empty() && std::chrono::steady_clock::now() < end) {
      serve_for(std::chrono::milliseconds(10));
    }
    cut_all();
  }

 private:
  // Ends all pending operations; their callbacks use visitors, which still exist here.
  void cut_all() {
    for (Connection& connection : connections_) connection.cut();
    io_.restart();
    io_.run();
    connections_.clear();
  }
  void serve_for(std::chrono::milliseconds time) {
    io_.restart();
    io_.run_for(time);
    connections_.remove_if([](const Connection& connection) { return connection.done(); });
  }

  void accept() {
    coming_.emplace_back(io_, kIncomingMax);
    acceptor_.async_accept(coming_.front().socket(), [this](const error_code& failed) {
      if (failed && !acceptor_.is_open()) return coming_.clear();
      if (!failed && is_accepted(coming_.front())) {
        Connection& connection = coming_.front();
        connections_.splice(connections_.end(), coming_);
        connection.begin([this](Connection& one, const auto& request) { answer(one, request); });
      }
      coming_.clear();
      accept();
    });
  }

  /// Returns whether a connection is accepted: from the same user, and within the limit. If the
  /// limit is reached, the oldest connection that is no page is closed.
  bool is_accepted(Connection& connection) {
    if (!driver::distrust_of_peer(connection.socket().native_handle()).empty()) return false;
    connections_.remove_if([](const Connection& one) { return one.done(); });
    if (connections_.size() < kConnectionsMax) return true;
    const auto oldest =
        std::find_if(connections_.begin(), connections_.end(),
                     [](const Connection& one) { return !one.is_page() && !one.is_cut(); });
    if (oldest != connections_.end()) oldest->cut();
    // A closed connection exists until its pending operations have ended.
    return connections_.size() < kConnectionsMax + kClosingMax;
  }

  template <class Request>
  void answer(Connection& connection, const Request& request) {
    const bool live = websocket::is_upgrade(request);
    const bool asks = !live && request.method() == http::verb::post;
    const RequestGuard::Request named{.target = view_of(request.target()),
                                      .host = view_of(request[http::field::host]),
                                      .origin = view_of(request[http::field::origin]),
                                      .token = view_of(request["X-Thimble-Token"])};
    const std::string wrong = asks ? guard_.refuse_change(named, "/steer", port_)
                                   : guard_.refuse(named, live ? "/live" : "/", port_);
    if (!wrong.empty()) return refuse(connection, http::status::forbidden, wrong);
    if (live) {
      if (pages() < kPagesMax) return connection.open();
      return refuse(connection, http::status::service_unavailable,
                    "Too many pages are connected already.");
    }
    if (!asks && request.method() != http::verb::get && request.method() != http::verb::head) {
      return refuse(connection, http::status::method_not_allowed,
                    "Only GET and HEAD requests are supported.");
    }
    if (!feed_) return wait(connection);
    if (asks) {
      const std::string_view run = view_of(request["X-Thimble-Run"]);
      if (!run.empty() && run != feed_->run()) {
        return refuse(connection, http::status::conflict,
                      "The run of this page is over. Reload the page.");
      }
      return steer(connection, request.body());
    }
    auto page = feed_->page(port_);
    if (!page) {
      return refuse(connection, http::status::internal_server_error, page.error().message);
    }
    auto response = response_of(http::status::ok, "text/html; charset=utf-8");
    response.body() = std::move(page).value();
    connection.respond(std::move(response));
  }

  void steer(Connection& connection, const std::string& asked) {
    if (const auto done = steer_run(*runs_.reader(), asked); !done) {
      return refuse(connection, http::status::conflict, done.error().message);
    }
    connection.respond(response_of(http::status::ok, "text/plain; charset=utf-8"));
  }

  static http::response<http::string_body> response_of(http::status status, const char* type) {
    http::response<http::string_body> response(status, 11);
    response.set(http::field::content_type, type);
    response.set(http::field::cache_control, "no-store");
    response.set("X-Content-Type-Options", "nosniff");
    response.set("Referrer-Policy", "no-referrer");  // the URL contains the token
    response.set("Cross-Origin-Resource-Policy", "same-origin");
    // The page itself contains the other directives.
    response.set("Content-Security-Policy", "frame-ancestors 'none'");
    return response;
  }
  static void refuse(Connection& connection, http::status status, const std::string& why) {
    auto response = response_of(status, "text/plain; charset=utf-8");
    response.body() = why + "\n";
    connection.respond(std::move(response));
  }
  void wait(Connection& connection) const {
    auto response = response_of(http::status::service_unavailable, "text/plain; charset=utf-8");
    response.set("Refresh", "1");
    response.body() = runs_.notice() + "\n";
    connection.respond(std::move(response));
  }

  session::RunAttachment& runs_;
  RequestGuard guard_;
  asio::io_context io_{1};
  tcp::acceptor acceptor_{io_};
  std::list<Connection> coming_;  // the connection to be accepted next
  std::list<Connection> connections_;
  std::optional<LiveFeed> feed_;
  std::uint16_t port_ = 0;
};

driver::Result<std::unique_ptr<WebServer>> WebServer::listen(session::RunAttachment& runs,
                                                             std::uint16_t port) {
  auto guard = RequestGuard::make();
  if (!guard) return guard.error();
  auto parts = std::make_unique<Parts>(runs, std::move(guard).value());
  if (const auto begun = parts->begin(port); !begun) return begun.error();
  return std::unique_ptr<WebServer>(new WebServer(std::move(parts)));
}

WebServer::WebServer(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
WebServer::~WebServer() = default;

std::string WebServer::address() const {
  return "http://127.0.0.1:" + std::to_string(port()) + "/?token=" + parts_->guard().token();
}
std::uint16_t WebServer::port() const noexcept {
  return parts_->port();
}
std::size_t WebServer::pages() const noexcept {
  return parts_->pages();
}
void WebServer::step() {
  parts_->step();
}
void WebServer::leave(std::chrono::milliseconds max_time) {
  parts_->leave(max_time);
}

}  // namespace thimble::web
