#pragma once

#include "hid_device.h"

namespace thimble {
namespace firmware {

/// Divides the answer to a control request into packets, for controllers that send one at a time.
class ControlAnswer {
 public:
  void begin(const UsbReply& reply) noexcept {
    data_ = reply.data;
    left_ = reply.size;
    more_ = true;
    ends_empty_ = reply.ends_empty;
    active_ = true;
  }

  void cancel() noexcept { active_ = false; }

  /// Returns whether an answer is being sent: from `begin` until `next` has returned false.
  bool active() const noexcept { return active_; }

  /// Takes the next packet; returns false after the last one.
  bool next(const uint8_t*& data, uint16_t& size) noexcept {
    active_ = active_ && more_;
    if (!active_) return false;
    data = data_;
    size = left_ < HidDevice::kPacketSize ? left_ : HidDevice::kPacketSize;
    data_ += size;
    left_ = static_cast<uint16_t>(left_ - size);
    more_ = left_ > 0 || (ends_empty_ && size > 0);
    return true;
  }

 private:
  const uint8_t* data_ = nullptr;
  uint16_t left_ = 0;
  bool active_ = false, more_ = false, ends_empty_ = false;
};

}  // namespace firmware
}  // namespace thimble
