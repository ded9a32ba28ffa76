#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <cstddef>
#include <string>
#include <utility>

#include "web/live_feed.h"

namespace thimble::web {

/// One connection. It makes one request and gets the page, or the updates of a page.
class Connection {
  using tcp = boost::asio::ip::tcp;
  using error_code = boost::system::error_code;

 public:
  /// A connection that accepts at most `max_incoming` bytes per message over WebSocket.
  Connection(boost::asio::io_context& io, std::size_t max_incoming) : stream_(io) {
    parser_.body_limit(kBodyMax);
    stream_.read_message_max(max_incoming);
    stream_.binary(true);
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  tcp::socket& socket() { return stream_.next_layer().socket(); }
  /// Returns whether no operation of it is pending.
  bool done() const noexcept { return under_way_ == 0; }
  /// Returns whether this side has disconnected it.
  bool is_cut() const noexcept { return cut_; }
  /// Returns whether it is a page that gets updates.
  bool is_page() const noexcept { return open_ && !closing_; }
  /// Returns whether everything was sent to it.
  bool has_all(const LiveFeed* feed) const noexcept {
    return !sending_ && (feed == nullptr || !feed->has_message(place_));
  }

  /// Reads the request, then calls `answer` once.
  template <class Answer>
  void begin(Answer answer) {
    error_code ignored;
    socket().set_option(tcp::no_delay(true), ignored);
    // Keeps data for a slow reader in this process, where it is counted, and not in the kernel.
    socket().set_option(boost::asio::socket_base::send_buffer_size(LiveFeed::kMessageBytes),
                        ignored);
    stream_.next_layer().expires_after(kPatience);
    ++under_way_;
    boost::beast::http::async_read(stream_.next_layer(), buffer_, parser_,
                                   [this, answer](const error_code& failed, std::size_t) {
                                     --under_way_;
                                     if (failed) return cut();
                                     answer(*this, parser_.get());
                                   });
  }

  void respond(boost::beast::http::response<boost::beast::http::string_body> response) {
    response_ = std::move(response);
    response_.keep_alive(false);
    response_.prepare_payload();
    ++under_way_;
    stream_.next_layer().expires_after(kPatience);
    boost::beast::http::async_write(stream_.next_layer(), response_,
                                    [this](const error_code&, std::size_t) {
                                      --under_way_;
                                      // A refused client may still be sending; closing only our
                                      // side lets the answer reach it.
                                      error_code ignored;
                                      socket().shutdown(tcp::socket::shutdown_send, ignored);
                                      cut();
                                    });
  }

  /// Makes it a page that gets updates.
  void open() {
    stream_.next_layer().expires_never();
    stream_.set_option(boost::beast::websocket::stream_base::timeout{
        .handshake_timeout = kPatience,
        .idle_timeout = std::chrono::seconds(30),  // browsers answer pings by themselves; chosen
        .keep_alive_pings = true});
    ++under_way_;
    stream_.async_accept(parser_.get(), [this](const error_code& failed) {
      --under_way_;
      if (failed) return cut();
      open_ = true;
      listen();
    });
  }

  /// Sends the new updates. A slow page gets several at once.
  void send_updates(const LiveFeed& feed) {
    if (!is_page() || sending_ || !feed.has_message(place_)) return;
    send(feed.message(place_));
  }
  /// Closes the connection with a code and a reason, once the current message is sent. No update is
  /// sent after this call.
  void close(boost::beast::websocket::close_code why, const char* words) {
    if (!open_ || closing_) return;
    closing_ = true;
    ++under_way_;
    stream_.async_close({why, words}, [this](const error_code&) {
      --under_way_;
      cut();
    });
  }
  void cut() {
    open_ = false;
    cut_ = true;
    stream_.next_layer().close();
  }

 private:
  static constexpr auto kPatience =
      std::chrono::seconds(5);                   // for a client that sends no request; chosen
  static constexpr std::size_t kBodyMax = 1024;  // bytes: a command with a knob's name; chosen

  void send(std::string bytes) {
    message_ = std::move(bytes);
    sending_ = true;
    ++under_way_;
    stream_.async_write(boost::asio::buffer(message_),
                        [this](const error_code& failed, std::size_t) {
                          --under_way_;
                          sending_ = false;
                          if (failed) cut();
                        });
  }
  // Reads and discards what a page sends, so that its closing is detected.
  void listen() {
    ++under_way_;
    stream_.async_read(buffer_, [this](const error_code& failed, std::size_t) {
      --under_way_;
      buffer_.consume(buffer_.size());
      if (failed) return cut();
      listen();
    });
  }

  boost::beast::websocket::stream<boost::beast::tcp_stream> stream_;
  boost::beast::flat_buffer buffer_;
  boost::beast::http::request_parser<boost::beast::http::string_body> parser_;
  boost::beast::http::response<boost::beast::http::string_body> response_;
  LiveFeed::Place place_;
  std::string message_;
  int under_way_ = 0;
  bool open_ = false, sending_ = false, closing_ = false, cut_ = false;
};

}  // namespace thimble::web
