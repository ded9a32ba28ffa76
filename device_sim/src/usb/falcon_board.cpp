#include "usb/falcon_board.h"
#include "arms/falcon/falcon_packet.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace thimble::device_sim::usb {
namespace {

using driver::falcon::kPacketSize;

constexpr std::array<std::byte, 3> kGreeting{std::byte{0x0a}, std::byte{0x43}, std::byte{0x0d}};
constexpr std::array<std::byte, 4> kGreetingAnswer{std::byte{0x0a}, std::byte{0x44},
                                                   std::byte{0x2c}, std::byte{0x0d}};
constexpr std::byte kAutobaud{'A'};
constexpr double kBootRate = 9600;
constexpr double kUploadRate = 140'000;
constexpr double kRunRate = 1'500'000;
constexpr double kRateTolerance = 0.03;

// After this silence a host's request no longer counts. [chosen]
constexpr std::int64_t kAsked_ns = 500'000'000;

// Encoder values before homing; any value would do.
constexpr std::array<std::int32_t, 3> kUnhomed{911, -1733, 402};

}  // namespace

FalconBoard::FalconBoard(std::vector<std::byte> image, FalconHoming homing)
    : image_(std::move(image)), homing_(homing), offset_(kUnhomed) {}

void FalconBoard::forget_homes() noexcept {
  homed_ = 0;
  offset_ = kUnhomed;
}

bool FalconBoard::wants_homing() const noexcept {
  return running_ && (asked_.lights & driver::falcon::kHomingMode) != 0 &&
         homed_ != driver::falcon::kAllHomed && now_ns_ - last_packet_ns_ < kAsked_ns;
}

double FalconBoard::rate() const noexcept {
  if (running_) return kRunRate;
  return stage_ == Stage::kBoot ? kBootRate : kUploadRate;
}

void FalconBoard::wires(bool dtr, bool /*rts*/) noexcept {
  if (dtr && !dtr_) restart();
  dtr_ = dtr;
}

void FalconBoard::restart() noexcept {
  ++counters_.resets;
  stage_ = Stage::kBoot;
  running_ = false;
  image_right_ = true;
  greeted_ = uploaded_ = frame_size_ = 0;
  forget_homes();
  motors_on_ = false;
  asked_ = {};
}

void FalconBoard::host_rate(double baud) noexcept {
  if (running_ || stage_ != Stage::kUpload || uploaded_ == 0) return;
  if (!(std::abs(baud / kRunRate - 1) < kRateTolerance)) return;
  running_ = image_right_ && (image_.empty() || uploaded_ == image_.size());
}

void FalconBoard::set_encoders(const std::array<double, 3>& exact_counts) noexcept {
  before_ = seen_ ? exact_ : exact_counts;
  exact_ = exact_counts;
  seen_ = true;
  if (!running_ || (asked_.lights & driver::falcon::kHomingMode) == 0) return;
  for (std::size_t leg = 0; leg < 3; ++leg) {
    const bool passed = before_[leg] * exact_[leg] <= 0;  // home is where the true count is zero
    if (!passed) continue;
    homed_ = static_cast<std::uint8_t>(homed_ | (1U << leg));
    offset_[leg] = 0;
  }
}

void FalconBoard::watch(std::int64_t time_ns) noexcept {
  now_ns_ = time_ns;
  if (watchdog_ns_ > 0 && now_ns_ - last_packet_ns_ >= watchdog_ns_) motors_on_ = false;
}

void FalconBoard::hear(std::byte byte, ByteQueue& says) noexcept {
  if (running_) {
    run(byte, says);
    return;
  }
  switch (stage_) {
    case Stage::kBoot:
      greeted_ = byte == kGreeting[greeted_] ? greeted_ + 1 : (byte == kGreeting[0] ? 1 : 0);
      if (greeted_ < kGreeting.size()) return;
      greeted_ = 0;
      for (const std::byte letter : kGreetingAnswer) says.push(letter);
      stage_ = Stage::kReady;
      return;
    case Stage::kReady:
      if (byte != kAutobaud) return;
      says.push(byte);
      stage_ = Stage::kUpload;
      return;
    case Stage::kUpload:
      if (!image_.empty() && (uploaded_ >= image_.size() || image_[uploaded_] != byte)) {
        image_right_ = false;
      }
      ++uploaded_;
      says.push(byte);
      return;
  }
}

void FalconBoard::run(std::byte byte, ByteQueue& says) noexcept {
  if (frame_size_ == 0 && byte != std::byte{'<'}) {
    ++counters_.stray;
    return;
  }
  frame_[frame_size_++] = byte;
  if (frame_size_ < kPacketSize) return;
  frame_size_ = 0;
  const auto packet = driver::falcon::decode_host_packet(frame_);
  if (!packet) {
    ++counters_.malformed;
    return;
  }
  ++counters_.packets;
  asked_ = *packet;
  motors_on_ = true;
  last_packet_ns_ = now_ns_;
  const bool homing = (asked_.lights & driver::falcon::kHomingMode) != 0;
  if (!homing && homing_ == FalconHoming::kForgets) forget_homes();
  answer(says);
}

void FalconBoard::answer(ByteQueue& says) noexcept {
  for (std::size_t leg = 0; leg < 3; ++leg) {
    const auto count = static_cast<std::int32_t>(std::lround(exact_[leg])) + offset_[leg];
    answered_.counts[leg] = static_cast<std::int16_t>(static_cast<std::uint16_t>(count & 0xffff));
  }
  const bool homing = (asked_.lights & driver::falcon::kHomingMode) != 0;
  answered_.homed = homing || homing_ == FalconHoming::kKeeps ? homed_ : std::uint8_t{0};
  for (const std::byte letter : driver::falcon::encode_arm_packet(answered_)) says.push(letter);
}

}  // namespace thimble::device_sim::usb
