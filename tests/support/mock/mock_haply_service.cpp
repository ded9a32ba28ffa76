#include "support/mock/mock_haply_service.h"

#include <sys/socket.h>

#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>

#include "support/pose_arm.h"

namespace thimble::support {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
using asio::ip::tcp;
using boost::system::error_code;
using nlohmann::json;

constexpr const char* kId = "049D";
/// Time for which the service keeps a force after the last message, ns.
constexpr std::int64_t kKept_ns = 20'000'000;
/// Delay of a late answer, ns.
constexpr std::int64_t kLate_ns = 60'000'000;

json vector(const Eigen::Vector3d& v) {
  return {{"x", v.x()}, {"y", v.y()}, {"z", v.z()}};
}

}  // namespace

class MockHaplyService::Server {
 public:
  Server(HaplyGreeting greeting, bool old_spelling, std::uint16_t port, const driver::Clock* clock)
      : clock_(clock == nullptr ? world_ : *clock),
        greeting_(greeting),
        old_spelling_(old_spelling),
        acceptor_(io_, tcp::endpoint(asio::ip::address_v4::loopback(), port)) {
    arm_.p_BT = arm_.p_BH = {0.01, -0.13, 0.17};
    arm_.time_ns = clock_.now_ns();
    thread_ = std::thread([this] { run(); });
  }

  ~Server() {
    ended_ = true;
    ::shutdown(acceptor_.native_handle(), SHUT_RDWR);
    if (const int client = client_.load(); client >= 0) ::shutdown(client, SHUT_RDWR);
    thread_.join();
  }

  std::uint16_t port() const { return acceptor_.local_endpoint().port(); }
  void begin(HaplyMischief mischief) { mischief_ = mischief; }
  void hand_to(const Eigen::Vector3d& p_BH) {
    const std::lock_guard lock(mutex_);
    arm_.p_BH = p_BH;
  }
  HaplyLog log() const {
    const std::lock_guard lock(mutex_);
    HaplyLog log = log_;
    log.p_BT = arm_.p_BT;
    log.f_T_B =
        clock_.now_ns() - last_message_ns_ > kKept_ns ? Eigen::Vector3d(0, 0, 0) : arm_.f_T_B;
    return log;
  }
  std::uint64_t dealt_with() const { return dealt_with_; }

 private:
  void run() {
    while (!ended_) {
      error_code failed;
      tcp::socket socket(io_);
      acceptor_.accept(socket, failed);
      if (failed) return;
      client_ = socket.native_handle();
      if (!ended_) serve(std::move(socket));
      client_ = -1;
      if (mischief_ == HaplyMischief::kDie) return;
    }
  }

  void serve(tcp::socket socket) {
    beast::websocket::stream<tcp::socket> stream(std::move(socket));
    error_code failed;
    stream.accept(failed);
    if (failed) return;
    if (greeting_ != HaplyGreeting::kNothing) stream.write(asio::buffer(greeting()), failed);
    beast::flat_buffer buffer;
    bool answers = false;
    while (!failed && !ended_) {
      stream.read(buffer, failed);
      if (failed) break;
      take(beast::buffers_to_string(buffer.data()));
      buffer.consume(buffer.size());
      const HaplyMischief mischief = mischief_;
      answers = !answers;
      if (mischief == HaplyMischief::kSilent ||
          (mischief == HaplyMischief::kLeavesOneOut && !answers)) {
        ++dealt_with_;
        continue;
      }
      if (mischief == HaplyMischief::kLate) {
        ++dealt_with_;
        for (const std::int64_t begin_ns = clock_.now_ns();
             clock_.now_ns() - begin_ns < kLate_ns && !ended_;) {
          std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
      }
      if (mischief == HaplyMischief::kDie) return;  // the kernel closes the connection
      if (mischief == HaplyMischief::kClose) {
        stream.close(beast::websocket::close_code::going_away, failed);
        return;
      }
      stream.write(asio::buffer(answer(mischief)), failed);
      if (mischief != HaplyMischief::kLate) ++dealt_with_;
    }
    const std::lock_guard lock(mutex_);
    log_.closed_by_client = failed == beast::websocket::error::closed;
  }

  json state(HaplyMischief mischief) {
    json arm = {{"device_id", kId},
                {"state",
                 {{"cursor_position", vector(arm_.p_BT)},
                  {"cursor_velocity", vector(arm_.v_BT)},
                  {"current_cursor_force", vector(arm_.f_T_B)},
                  {"angular_position", {{"a0", 1.0}, {"a1", 2.0}, {"a2", 3.0}}}}},
                {"status",
                 {{"calibrated", greeting_ != HaplyGreeting::kUncalibrated},
                  {"ready", mischief != HaplyMischief::kNotReady},
                  {"started", true},
                  {"power_supply", true},
                  {"in_use", greeting_ == HaplyGreeting::kInUse && log_.messages == 0}}}};
    if (mischief == HaplyMischief::kNull) arm["state"]["cursor_position"]["y"] = nullptr;
    if (mischief == HaplyMischief::kMillimetres) arm["state"]["cursor_position"]["y"] = -130.0;
    json message = {{"inverse3", json::array({arm})}};
    if (mischief == HaplyMischief::kUnplugged) message["inverse3"] = json::array();
    if (greeting_ == HaplyGreeting::kWithGrip) {
      // A quarter turn about z, and button b.
      message["wireless_verse_grip"] =
          json::array({{{"device_id", "9B2F"},
                        {"state",
                         {{"orientation", {{"x", 0}, {"y", 0}, {"z", 0.7071068}, {"w", 0.7071068}}},
                          {"buttons", {{"a", false}, {"b", true}, {"c", false}}}}}}});
    }
    return message;
  }

  std::string greeting() {
    const std::lock_guard lock(mutex_);
    if (greeting_ == HaplyGreeting::kOther) return R"({"status":"ok","devices":[]})";
    if (greeting_ == HaplyGreeting::kNoJson) return "hello";
    json message = state(HaplyMischief::kNone);
    message["session_id"] = 7;
    if (greeting_ == HaplyGreeting::kNoArm) message["inverse3"] = json::array();
    if (!message["inverse3"].empty()) {
      message["inverse3"][0]["config"] = {
          {"device_info", {{"major_version", 3}, {"minor_version", 1}}}, {"handedness", "right"}};
    }
    return message.dump();
  }

  std::string answer(HaplyMischief mischief) {
    const std::lock_guard lock(mutex_);
    arm_.advance_to(clock_.now_ns());
    if (mischief == HaplyMischief::kGarbage) return R"({"inverse3":[{"device_id":"049D","state")";
    if (mischief == HaplyMischief::kHuge) return std::string(1'000'000, ' ');
    std::string text = state(mischief).dump();
    const auto replace = [&text](const char* with) {
      const std::string key = R"("cursor_position":{"x":)";
      const std::size_t from = text.find(key) + key.size();
      text.replace(from, text.find(',', from) - from, with);
    };
    if (mischief == HaplyMischief::kNan) replace("NaN");
    if (mischief == HaplyMischief::kInfinite) replace("1e999");
    return text;
  }

  /// Handles a message as one version of the service does, and records its errors.
  void take(const std::string& text) {
    const std::lock_guard lock(mutex_);
    ++log_.messages;
    const std::int64_t now_ns = clock_.now_ns();
    if (now_ns - last_message_ns_ > kKept_ns) {
      arm_.advance_to(last_message_ns_ + kKept_ns);
      arm_.f_T_B.setZero();
    }
    arm_.advance_to(now_ns);
    last_message_ns_ = now_ns;
    const json message = json::parse(text, nullptr, false);
    const json force =
        message.value(json::json_pointer("/inverse3/0/commands/set_cursor_force"), json());
    const json commanded =
        force.is_object() ? force.value(old_spelling_ ? "values" : "vector", json()) : json();
    const bool right = message.value(json::json_pointer("/inverse3/0/device_id"), "") == kId &&
                       message["inverse3"].size() == 1 &&
                       message["inverse3"][0]["commands"].size() == 1 && commanded.is_object() &&
                       commanded.size() == 3 && commanded["x"].is_number() &&
                       commanded["y"].is_number() && commanded["z"].is_number();
    if (!right) {
      ++log_.wrong;
      return;
    }
    arm_.f_T_B = {commanded["x"].get<double>(), commanded["y"].get<double>(),
                  commanded["z"].get<double>()};
    log_.taken_B.push_back(arm_.f_T_B);
  }

  const driver::WallClock world_{0};
  const driver::Clock& clock_;
  const HaplyGreeting greeting_;
  const bool old_spelling_;
  asio::io_context io_;
  tcp::acceptor acceptor_;
  std::atomic<HaplyMischief> mischief_{HaplyMischief::kNone};
  std::atomic<bool> ended_{false};
  std::atomic<std::uint64_t> dealt_with_{0};
  std::atomic<int> client_{-1};
  mutable std::mutex mutex_;
  PoseArm arm_;
  HaplyLog log_;
  std::int64_t last_message_ns_ = 0;
  std::thread thread_;
};

MockHaplyService::MockHaplyService(HaplyGreeting greeting, bool old_spelling, std::uint16_t port,
                                   const driver::Clock* clock)
    : server_(std::make_unique<Server>(greeting, old_spelling, port, clock)) {}
MockHaplyService::~MockHaplyService() = default;

std::uint16_t MockHaplyService::port() const {
  return server_->port();
}
void MockHaplyService::begin(HaplyMischief mischief) {
  server_->begin(mischief);
}
void MockHaplyService::hand_to(const Eigen::Vector3d& p_BH) {
  server_->hand_to(p_BH);
}
HaplyLog MockHaplyService::log() const {
  return server_->log();
}
std::uint64_t MockHaplyService::dealt_with() const {
  return server_->dealt_with();
}

}  // namespace thimble::support
