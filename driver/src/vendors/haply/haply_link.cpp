#include "vendors/haply/haply_link.h"

#include <charconv>
#include <cstdlib>
#include <exception>
#include <string_view>
#include <thread>
#include <utility>

#include "vendors/slot_link.h"

namespace thimble::driver::haply {
namespace {

/// Max. wait for an answer before the next force is sent: a service that missed one message must
/// not stay silent for ever. [chosen: half of the time that counts as silence]
constexpr std::int64_t kAnswer_ns = 10'000'000;

class HaplyLink final : public SlotLink, private SocketCallbacks {
 public:
  HaplyLink(std::unique_ptr<Socket> socket, FoundInverse3 arm, Clock& clock)
      : SlotLink({.has_velocity = true, .has_orientation = arm.state.has_grip}, clock),
        clock_(clock),
        socket_(std::move(socket)),
        device_id_(std::move(arm.device_id)),
        state_(arm.state) {
    thread_ = std::thread([this] { serve(); });
  }

  ~HaplyLink() override {
    socket_->leave();
    thread_.join();
  }

 private:
  void ring() noexcept override { socket_->ring(); }

  // Called by the thread of the socket.
  void serve() noexcept {
    try {
      socket_->serve(*this);
    } catch (const std::exception&) {  // for example out of memory: the arm gets no more messages
      lose();
    }
  }
  void received(std::string_view text) override {
    waits_ = false;
    const StateRead read = read_state(text, device_id_, state_);
    if (read == StateRead::kGone) {
      lose();
      // Done now and not in the destructor: by then a successor may drive the arm.
      return socket_->leave();
    }
    trusted_ = read == StateRead::kOk;
    if (!trusted_) return reject();
    ArmSample sample;
    sample.pose.p_BT = state_.p_BT;
    sample.v_BT = state_.v_BT;
    sample.R_BT = state_.R_BT;
    sample.buttons = state_.buttons;
    publish(sample);
  }
  std::optional<std::string> next_message() override {
    const std::int64_t now_ns = clock_.now_ns();
    if (waits_ && now_ns - sent_at_ns_ < kAnswer_ns) return std::nullopt;
    Eigen::Vector3d f_T_B;
    if (!take_force(f_T_B)) return std::nullopt;
    waits_ = true;
    sent_at_ns_ = now_ns;
    // An arm with an unknown pose gets no force.
    if (!trusted_) f_T_B.setZero();
    return force_message(device_id_, f_T_B);
  }
  std::string last_message() override { return force_message(device_id_, {0, 0, 0}); }
  void lost() override { lose(); }

  const Clock& clock_;
  std::unique_ptr<Socket> socket_;
  std::string device_id_;
  // Used only by the socket's thread.
  ArmState state_;
  bool waits_ = false, trusted_ = true;
  std::int64_t sent_at_ns_ = 0;
  std::thread thread_;
};

}  // namespace

std::uint16_t port_of_user() {
  const char* text = std::getenv("THIMBLE_HAPLY_PORT");
  if (text == nullptr) return kPort;
  const std::string_view digits(text);
  std::uint16_t port = 0;
  const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), port);
  const bool whole = read.ec == std::errc() && read.ptr == digits.data() + digits.size();
  return whole && port > 0 ? port : kPort;
}

Result<std::vector<FoundInverse3>> find_arms(std::uint16_t port, std::int64_t timeout_ns) {
  const auto socket = Socket::connect(port, timeout_ns);
  if (!socket) return socket.error();
  auto arms = read_first((*socket)->first());
  if (!arms) return arms;
  for (FoundInverse3& arm : *arms) arm.stand_in = (*socket)->is_stand_in();
  return arms;
}

Result<std::unique_ptr<ArmLink>> open_link(const std::string& device_id, std::uint16_t port,
                                           Clock& clock) {
  auto socket = Socket::connect(port, kConnectTimeout_ns);
  if (!socket) {
    return Error{socket.error().message + " Start Haply's service, or see `thimble doctor`."};
  }
  auto arms = read_first((*socket)->first());
  if (!arms) return Error{arms.error().message + " Nothing was sent to it."};
  for (FoundInverse3& arm : *arms) {
    if (arm.device_id != device_id) continue;
    if (!arm.trouble.empty()) return Error{"Inverse3 " + device_id + ": " + arm.trouble};
    return std::unique_ptr<ArmLink>(
        std::make_unique<HaplyLink>(std::move(socket).value(), std::move(arm), clock));
  }
  return Error{"Haply's service lists no Inverse3 named " + device_id + ". See `thimble devices`."};
}

}  // namespace thimble::driver::haply
