// The server of a live page, with clients in this process instead of browsers.
#include "web/web_server.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "live_updates.h"
#include "report/html/page_libraries.h"
#include "share/shared_run.h"
#include "web/request_guard.h"

namespace thimble::web {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using boost::system::error_code;

/// Headers of a client; empty: those of the page itself.
struct Asking {
  std::string target;
  std::string host{};
  std::string origin{};
};

class WebServerTest : public ::testing::Test {
 protected:
  WebServerTest() {
    begin_run();
    auto server = WebServer::listen(runs_, 0);
    EXPECT_TRUE(server) << server.error().message;
    server_ = std::move(server).value();
    port_ = server_->port();
    const std::string address = server_->address();
    token_ = address.substr(address.find("?token="));
    thread_ = std::thread([this] {
      while (!stop_.load()) server_->step();
      server_->step();
      server_->leave(std::chrono::seconds(2));
    });
  }
  ~WebServerTest() override { end(); }

  void begin_run() {
    run_.reset();
    run_ = session::SharedRun::create(name_, live_scene(), 20'000).value();
    run_->set_state(session::RunState::kRunning);
  }
  void end() {
    stop_.store(true);
    if (thread_.joinable()) thread_.join();
  }
  void run_ticks(std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) run_->store_tick(live_tick(next_++));
  }
  std::string here() const { return "127.0.0.1:" + std::to_string(port_); }

  tcp::socket connect() {
    tcp::socket socket(io_);
    socket.connect({asio::ip::address_v4::loopback(), port_});
    return socket;
  }
  /// Requests a page; returns status and body.
  std::pair<unsigned, std::string> get(const Asking& asking, bool upgrade = false) {
    tcp::socket socket = connect();
    http::request<http::empty_body> request(http::verb::get, asking.target, 11);
    request.set(http::field::host, asking.host.empty() ? here() : asking.host);
    if (!asking.origin.empty()) request.set(http::field::origin, asking.origin);
    if (upgrade) {
      request.set(http::field::upgrade, "websocket");
      request.set(http::field::connection, "Upgrade");
      request.set(http::field::sec_websocket_version, "13");
      request.set(http::field::sec_websocket_key, "dGhlIHNhbXBsZSBub25jZQ==");  // RFC 6455, 1.3
    }
    http::write(socket, request);
    beast::flat_buffer buffer;
    http::response_parser<http::string_body> parser;
    parser.body_limit(100'000'000);
    http::read(socket, buffer, parser);
    return {parser.get().result_int(), parser.get().body()};
  }

  /// Sends a command to the run, as a page does; returns the status.
  unsigned post(const std::string& words, const Asking& asking, const std::string& token,
                const std::string& run = {}) {
    tcp::socket socket = connect();
    http::request<http::string_body> request(http::verb::post, asking.target, 11);
    request.set(http::field::host, here());
    request.set(http::field::origin, asking.origin);
    if (!token.empty()) request.set("X-Thimble-Token", token);
    if (!run.empty()) request.set("X-Thimble-Run", run);
    request.body() = words;
    request.prepare_payload();
    http::write(socket, request);
    beast::flat_buffer buffer;
    http::response<http::string_body> response;
    http::read(socket, buffer, response);
    return response.result_int();
  }

  using Page = websocket::stream<tcp::socket>;
  /// Opens a page; returns the status of the response, 101 if it is open.
  unsigned open(Page& page) {
    page.next_layer() = connect();
    page.read_message_max(0);
    const std::string origin = "http://" + here();
    page.set_option(websocket::stream_base::decorator(
        [origin](websocket::request_type& request) { request.set(http::field::origin, origin); }));
    websocket::response_type response;
    error_code failed;
    page.handshake(response, here(), "/live" + token_, failed);
    return failed ? 0 : response.result_int();
  }
  /// Reads until the given number of ticks arrived, or the page is closed; returns them.
  std::vector<std::uint32_t> read_ticks(Page& page, std::size_t count) {
    std::vector<std::uint32_t> ticks;
    while (ticks.size() < count) {
      beast::flat_buffer buffer;
      error_code failed;
      page.read(buffer, failed);
      if (failed) break;
      const std::string message = beast::buffers_to_string(buffer.data());
      const auto own = ticks_of(message);
      ticks.insert(ticks.end(), own.begin(), own.end());
      for (const LiveUpdate& update : updates_of(message)) {
        if (update.json.contains("state")) state_ = update.json["state"];
        lost_ += update.json.value("lost_here", std::uint64_t{0});
      }
    }
    return ticks;
  }

  std::string name_ = "web-" + std::to_string(getpid());
  std::unique_ptr<session::SharedRun> run_;
  session::RunAttachment runs_{name_};
  std::unique_ptr<WebServer> server_;
  std::uint16_t port_ = 0;
  std::string token_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
  std::uint64_t next_ = 0;
  asio::io_context io_{1};
  std::string state_;
  std::uint64_t lost_ = 0;
};

TEST(RequestGuard, RequiresTheTokenAndTheServedOrigin) {
  const RequestGuard guard = RequestGuard::make().value();
  EXPECT_EQ(guard.token().size(), 32U);
  EXPECT_NE(guard.token(), RequestGuard::make().value().token());
  const std::string token = guard.token();
  const std::string target = "/?token=" + token;
  const auto refused = [&](const std::string& to, const char* host, const char* origin) {
    return !guard.refuse({to, host, origin}, "/", 8080).empty();
  };
  EXPECT_FALSE(refused(target, "127.0.0.1:8080", ""));
  EXPECT_FALSE(refused(target, "localhost:8080", ""));
  EXPECT_FALSE(refused(target, "localhost:8080", "http://localhost:8080"));
  for (const char* host : {"", "127.0.0.1", "127.0.0.1:80", "evil.example:8080", "0.0.0.0:8080",
                           "127.0.0.1:8080.evil.example", "[::1]:8080"}) {
    EXPECT_TRUE(refused(target, host, "")) << host;
  }
  for (const char* origin : {"null", "http://evil.example", "https://127.0.0.1:8080", "http://",
                             "http://localhost:8080", "http://127.0.0.1:8080/", "file://"}) {
    EXPECT_TRUE(refused(target, "127.0.0.1:8080", origin)) << origin;
  }
  for (const std::string& to :
       {std::string("/"), std::string(), std::string("/?token="), "/?token=" + token + "0",
        "/?token=" + token.substr(1), "/?token=" + std::string(32, '0'), "/?x=1&token=" + token,
        "/other?token=" + token, "/../?token=" + token}) {
    EXPECT_TRUE(refused(to, "127.0.0.1:8080", "")) << to;
  }
}

TEST_F(WebServerTest, NothingIsSentWithoutTheToken) {
  run_ticks(10);
  const std::string page = "/" + token_, live = "/live" + token_;
  for (const Asking& asking : {Asking{"/"}, Asking{"/?token=0123456789abcdef0123456789abcdef"},
                               Asking{"/favicon.ico"}, Asking{page, "evil.example"},
                               Asking{page, {}, "http://evil.example"}, Asking{page + "0"}}) {
    const auto [status, body] = get(asking);
    EXPECT_EQ(status, 403U) << asking.target;
    EXPECT_TRUE(body.ends_with(".\n") && body.size() > 20) << body;
    EXPECT_EQ(body.find(token_.substr(7)), std::string::npos);
  }
  for (const Asking& asking :
       {Asking{"/live"}, Asking{"/live?token=", {}, "http://" + here()},
        Asking{live, {}, "http://evil.example"}, Asking{live, "evil.example:80"},
        Asking{page, {}, "http://" + here()}}) {
    EXPECT_EQ(get(asking, true).first, 403U) << asking.target;
  }
  Page own(io_);
  EXPECT_EQ(open(own), 101U);
  EXPECT_EQ(read_ticks(own, 10).size(), 10U);
  const auto [status, body] = get({page});
  if (report::read_page_libraries()) {
    EXPECT_EQ(status, 200U);
    EXPECT_NE(body.find("connect-src ws://127.0.0.1:" + std::to_string(port_) + " ws://localhost:"),
              std::string::npos);
    EXPECT_NE(body.find(" http://localhost:" + std::to_string(port_) + "\""), std::string::npos);
  } else {
    EXPECT_EQ(status, 500U);
    EXPECT_NE(body.find("apt install"), std::string::npos) << body;
  }
}

TEST_F(WebServerTest, AcceptsCommandsOnlyFromThePage) {
  const std::string own = "http://" + here(), token = token_.substr(7);
  run_ticks(1);
  Page page(io_);
  ASSERT_EQ(open(page), 101U);
  ASSERT_EQ(read_ticks(page, 1).size(), 1U);
  EXPECT_EQ(post("pause", {"/steer", {}, "http://evil.example"}, token), 403U);
  EXPECT_EQ(post("pause", {"/steer", {}, own}, ""), 403U);
  EXPECT_EQ(post("pause", {"/steer" + token_, {}, own}, ""), 403U);
  EXPECT_EQ(get({"/steer" + token_, {}, own}).first, 403U) << "commands by GET are refused";
  EXPECT_FALSE(run_->pause_asked());
  EXPECT_EQ(post("pause", {"/steer", {}, own}, token), 200U);
  EXPECT_TRUE(run_->pause_asked());
  EXPECT_EQ(post("restart", {"/steer", {}, own}, token), 409U) << "the run cannot be restarted";
}

TEST_F(WebServerTest, IdleConnectionsDoNotKeepPagesOut) {
  constexpr std::size_t kMoreThanPlaces = 100;
  run_ticks(1);
  std::vector<tcp::socket> idle;
  for (std::size_t i = 0; i < kMoreThanPlaces; ++i) idle.push_back(connect());
  EXPECT_EQ(get({"/"}).first, 403U) << "it is answered";
  Page page(io_);
  EXPECT_EQ(open(page), 101U);
}

TEST_F(WebServerTest, OpenPagesSurviveIdleConnections) {
  run_ticks(1);
  Page page(io_);
  ASSERT_EQ(open(page), 101U);
  ASSERT_EQ(read_ticks(page, 1).size(), 1U);
  std::vector<tcp::socket> idle;
  for (std::size_t i = 0; i < 200; ++i) idle.push_back(connect());
  run_ticks(5);
  EXPECT_EQ(read_ticks(page, 5).size(), 5U);
}

TEST_F(WebServerTest, ConnectionOfOtherUserIsRefused) {
  if (geteuid() != 0) GTEST_SKIP() << "only root may act as another user";
  const pid_t other = fork();
  if (other == 0) {
    alarm(60);
    if (setgid(65534) != 0 || setuid(65534) != 0) _exit(2);
    const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(port_);
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (::connect(socket, reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0) _exit(3);
    const std::string request = "GET / HTTP/1.1\r\nHost: " + here() + "\r\n\r\n";
    if (send(socket, request.data(), request.size(), MSG_NOSIGNAL) < 0) _exit(0);
    char byte = 0;
    _exit(recv(socket, &byte, 1, 0) > 0 ? 4 : 0);
  }
  int status = 0;
  waitpid(other, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

TEST_F(WebServerTest, GarbageEndsOnlyItsConnection) {
  run_ticks(10);
  for (const std::string& bytes :
       {std::string("\0\xff\xfe garbage \r\n\r\n", 17), std::string("GET"),
        "GET /" + std::string(200'000, 'a') + " HTTP/1.1\r\n\r\n",
        "POST /" + token_ + " HTTP/1.1\r\nHost: " + here() +
            "\r\nContent-Length: 99999999\r\n\r\nmuch"}) {
    tcp::socket socket = connect();
    error_code failed;
    asio::write(socket, asio::buffer(bytes), failed);
    socket.shutdown(tcp::socket::shutdown_send, failed);
    std::array<char, 4096> answer{};
    while (!failed) socket.read_some(asio::buffer(answer), failed);
    EXPECT_TRUE(failed);
  }
  Page good(io_), long_winded(io_), rude(io_);
  ASSERT_EQ(open(good), 101U);
  ASSERT_EQ(open(long_winded), 101U);
  ASSERT_EQ(open(rude), 101U);
  error_code failed;
  long_winded.write(asio::buffer(std::string(100 * WebServer::kIncomingMax, 'x')), failed);
  // A frame with a stated length of 2^62 bytes.
  const std::string huge("\x82\xff\x40\0\0\0\0\0\0\0\1\2\3\4", 14);
  asio::write(rude.next_layer(), asio::buffer(huge), failed);
  good.write(asio::buffer(std::string("something short")), failed);
  const auto closed = [&](Page& page) {
    read_ticks(page, 1'000'000);
    return true;
  };
  EXPECT_TRUE(closed(long_winded));
  EXPECT_TRUE(closed(rude));
  EXPECT_EQ(read_ticks(good, 10).size(), 10U);
  run_ticks(5);
  EXPECT_EQ(read_ticks(good, 5).size(), 5U);
}

TEST_F(WebServerTest, SlowClientDoesNotStallOthers) {
  Page stuck(io_), first(io_), second(io_);
  ASSERT_EQ(open(stuck), 101U);
  stuck.next_layer().set_option(asio::socket_base::receive_buffer_size(65'536));
  ASSERT_EQ(open(first), 101U);
  ASSERT_EQ(open(second), 101U);
  std::vector<std::uint32_t> to_first, to_second;
  for (int part = 0; part < 25; ++part) {
    run_ticks(4000);
    for (auto* ticks : {&to_first, &to_second}) {
      const auto own = read_ticks(ticks == &to_first ? first : second, 4000);
      ticks->insert(ticks->end(), own.begin(), own.end());
    }
  }
  ASSERT_EQ(to_first.size(), 100'000U);
  EXPECT_EQ(to_second, to_first);
  for (std::size_t i = 0; i < to_first.size(); ++i) ASSERT_EQ(to_first[i], i);
  EXPECT_EQ(lost_, 0U);
  // Once it reads again, it gets the number of lost ticks.
  run_ticks(1);
  std::size_t came = 0;
  while (came + lost_ < 100'001) {
    const auto own = read_ticks(stuck, 1);
    if (own.empty()) break;
    came += own.size();
  }
  EXPECT_EQ(came + lost_, 100'001U);
  EXPECT_GT(lost_, 0U);
}

TEST_F(WebServerTest, ThePageHasTheLastTickOfARunThatEnds) {
  Page page(io_);
  ASSERT_EQ(open(page), 101U);
  run_ticks(10);
  EXPECT_EQ(read_ticks(page, 10).size(), 10U);
  run_ticks(100);
  run_->set_state(session::RunState::kEnded);
  end();
  const auto ticks = read_ticks(page, 1'000'000);
  ASSERT_EQ(ticks.size(), 100U);
  EXPECT_EQ(ticks.back(), 109U);
  EXPECT_EQ(state_, "ended");
  EXPECT_EQ(page.reason().code, websocket::close_code::normal);
}

TEST_F(WebServerTest, ReloadShowsNewRunOfSameName) {
  Page page(io_);
  ASSERT_EQ(open(page), 101U);
  run_ticks(10);
  EXPECT_EQ(read_ticks(page, 10).size(), 10U);
  begin_run();
  read_ticks(page, 1'000'000);
  EXPECT_EQ(page.reason().code, websocket::close_code::service_restart);
  next_ = 0;
  run_ticks(7);
  Page next(io_);
  ASSERT_EQ(open(next), 101U);
  EXPECT_EQ(read_ticks(next, 7), (std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5, 6}));
}

TEST_F(WebServerTest, SlowPagesAreClosedWithTheCodeOfAnotherRun) {
  constexpr std::uint32_t kNextRun = 5'000'000;
  Page page(io_);
  ASSERT_EQ(open(page), 101U);
  // More data than the sockets buffer, so that the server is still sending.
  for (int part = 0; part < 20; ++part) {
    run_ticks(10'000);
    std::this_thread::sleep_for(2 * WebServer::kStep);
  }
  begin_run();
  std::this_thread::sleep_for(std::chrono::milliseconds(600));  // it checks four times a second
  next_ = kNextRun;
  run_ticks(10);
  for (const std::uint32_t tick : read_ticks(page, 10'000'000)) ASSERT_LT(tick, kNextRun);
  EXPECT_EQ(page.reason().code, websocket::close_code::service_restart);
}

TEST_F(WebServerTest, TheFirstUpdateNamesTheRun) {
  std::vector<std::string> runs;
  for (int run = 0; run < 2; ++run) {
    if (run > 0) begin_run();
    // The server checks for another run four times a second.
    std::this_thread::sleep_for(std::chrono::milliseconds(600));
    run_ticks(1);
    Page page(io_);
    ASSERT_EQ(open(page), 101U);
    beast::flat_buffer buffer;
    page.read(buffer);
    const auto updates = updates_of(beast::buffers_to_string(buffer.data()));
    ASSERT_FALSE(updates.empty());
    runs.push_back(updates.front().json.value("run", std::string()));
  }
  EXPECT_FALSE(runs[0].empty());
  EXPECT_NE(runs[0], runs[1]);
}

TEST_F(WebServerTest, PageOfAnotherRunCannotSteerARun) {
  const std::string own = "http://" + here(), token = token_.substr(7);
  run_ticks(1);
  Page page(io_);
  ASSERT_EQ(open(page), 101U);
  ASSERT_EQ(read_ticks(page, 1).size(), 1U);
  EXPECT_EQ(post("pause", {"/steer", {}, own}, token, "1"), 409U);
  EXPECT_FALSE(run_->pause_asked());
}

TEST(WebServer, UsedPortIsAnError) {
  session::RunAttachment runs("none");
  const auto first = WebServer::listen(runs, 0);
  ASSERT_TRUE(first);
  const auto second = WebServer::listen(runs, (*first)->port());
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().message.find("is not available"), std::string::npos);
}

}  // namespace
}  // namespace thimble::web
