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

/// One connection: it asks for one thing and gets it, the page or what the page is told.
class Visitor {
  using tcp = boost::asio::ip::tcp;
  using error_code = boost::system::error_code;

 public:
  /// A connection that sends at most `said_most` bytes at a time over WebSocket.
  Visitor(boost::asio::io_context& io, std::size_t said_most) : stream_(io) {
    parser_.body_limit(kBodyMost);
    stream_.read_message_max(said_most);
    stream_.binary(true);
  }
  Visitor(const Visitor&) = delete;
  Visitor& operator=(const Visitor&) = delete;

  tcp::socket& socket() { return stream_.next_layer().socket(); }
  /// Returns whether nothing of it is under way any more.
  bool done() const noexcept { return under_way_ == 0; }
  /// Returns whether it has been disconnected by this side.
  bool is_cut() const noexcept { return cut_; }
  /// Returns whether it is a page that is told what goes on.
  bool is_page() const noexcept { return open_ && !closing_; }
  /// Returns whether it has been sent all that there is.
  bool has_all(const LiveFeed* feed) const noexcept {
    return !sending_ && (feed == nullptr || !feed->has_message(place_));
  }

  /// Reads what it asks for; `answer` is called then, once.
  template <class Answer>
  void begin(Answer answer) {
    error_code ignored;
    socket().set_option(tcp::no_delay(true), ignored);
    // What waits for a slow reader waits here, where it is counted, and not in the kernel.
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
                                      // Whoever is refused may still be speaking; the answer shall
                                      // reach him.
                                      error_code ignored;
                                      socket().shutdown(tcp::socket::shutdown_send, ignored);
                                      cut();
                                    });
  }

  /// Becomes a page that is told what goes on.
  void open() {
    stream_.next_layer().expires_never();
    stream_.set_option(boost::beast::websocket::stream_base::timeout{
        .handshake_timeout = kPatience,
        .idle_timeout = std::chrono::seconds(30),  // a browser answers for its page; chosen
        .keep_alive_pings = true});
    ++under_way_;
    stream_.async_accept(parser_.get(), [this](const error_code& failed) {
      --under_way_;
      if (failed) return cut();
      open_ = true;
      listen();
    });
  }

  /// Sends what is new; a page that is slow gets it with what comes meanwhile.
  void tell(const LiveFeed& feed) {
    if (!is_page() || sending_ || !feed.has_message(place_)) return;
    send(feed.message(place_));
  }
  /// Closes it with a code and a word of why, once it has what is being sent, however slow it is.
  /// It is told nothing from now on.
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
      std::chrono::seconds(5);                    // with who connects and does not go on; chosen
  static constexpr std::size_t kBodyMost = 1024;  // bytes of a request's: a knob's name; chosen

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
  // Whatever a page says is read and forgotten, so that its closing is seen.
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
