#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "arms/falcon/falcon_boot.h"
#include "support/random.h"

namespace thimble::support {

/// The far side of a Falcon's serial line, as strict as its boot loader: it responds only at the
/// right rate and with the right control lines. Produces faults on demand.
class ScriptedFalcon final : public driver::SerialLine {
 public:
  std::vector<std::byte> image;  ///< The firmware that starts it.
  bool running = false;          ///< Firmware is loaded.
  bool powered = true;
  bool gone = false;          ///< The converter accepts no requests any more.
  int greetings_unheard = 0;  ///< Number of greetings without an answer.
  int echoes_wrong = 0;       ///< Number of uploads with a wrong echo in their second block.
  int echoes_missing = 0;     ///< Number of uploads whose echo stops in their third block.
  std::uint8_t homed = 0;
  int stray = 0;   ///< Number of bytes of an earlier packet before an answer.
  int split = 64;  ///< Largest number of bytes per read.

  int resets = 0, host_packets = 0, uploads = 0;
  std::uint8_t latency_ms = 16;
  driver::falcon::HostPacket last;

  bool set_rate_divisor(std::uint16_t divisor) override {
    divisor_ = divisor;
    return !gone;
  }
  bool set_frame_8n1() override { return !gone; }
  bool set_rts(bool high) override {
    rts_ = high;
    return !gone;
  }
  bool set_dtr(bool high) override {
    if (high && !dtr_) {
      ++resets;
      running = false;
      loaded_.clear();
      uploading_ = false;
    }
    dtr_ = high;
    return !gone;
  }
  bool set_latency_ms(std::uint8_t latency) override {
    latency_ms = latency;
    return !gone;
  }
  bool purge() override {
    to_host_.clear();
    return !gone;
  }

  bool write(std::span<const std::byte> bytes) override {
    if (gone) return false;
    if (powered) hear(bytes);
    return true;
  }

  int read(std::span<std::byte> bytes, int) override {
    if (gone) return -1;
    int count = 0;
    while (!to_host_.empty() && count < split && static_cast<std::size_t>(count) < bytes.size()) {
      bytes[static_cast<std::size_t>(count++)] = to_host_.front();
      to_host_.pop_front();
    }
    return count;
  }

 private:
  void say(std::initializer_list<int> bytes) {
    for (const int byte : bytes) to_host_.push_back(static_cast<std::byte>(byte));
  }

  void hear(std::span<const std::byte> bytes) {
    using namespace driver::falcon;
    if (running) {
      if (divisor_ != kRunDivisor) return;
      if (const auto packet = decode_host_packet(bytes)) {
        ++host_packets;
        last = *packet;
        for (int i = 0; i < stray; ++i) say({'A' + i % 16});
        for (const std::byte b : encode_arm_packet({.counts = {5, -6, 7}, .homed = homed})) {
          to_host_.push_back(b);
        }
      }
    } else if (divisor_ == kBootDivisor && dtr_ && !rts_) {
      if (bytes.size() == 3 && bytes[0] == std::byte{0x0a} && greetings_unheard-- <= 0) {
        say({0x00, 0x0a, 0x44, 0x2c, 0x0d});
      }
    } else if (divisor_ == kUploadDivisor && !dtr_) {
      if (!uploading_) {
        uploading_ = bytes.size() == 1 && bytes[0] == std::byte{0x41};
        if (uploading_) ++uploads, say({0x41});
        block_ = 0;
        return;
      }
      take_block(bytes);
    }
  }

  void take_block(std::span<const std::byte> bytes) {
    ++block_;
    if (block_ == 3 && echoes_missing > 0) {
      --echoes_missing;
      return;
    }
    for (std::byte byte : bytes) {
      if (block_ == 2 && echoes_wrong > 0) {
        --echoes_wrong;
        byte ^= std::byte{4};
      }
      loaded_.push_back(byte);
      to_host_.push_back(byte);
    }
    if (loaded_ == image) running = true;
  }

  std::deque<std::byte> to_host_;
  std::vector<std::byte> loaded_;
  std::uint16_t divisor_ = 0;
  bool rts_ = true, dtr_ = true, uploading_ = false;
  int block_ = 0;
};

}  // namespace thimble::support
