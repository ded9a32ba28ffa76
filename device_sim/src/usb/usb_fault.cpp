#include "thimble/device_sim/usb/usb_fault.h"

#include <algorithm>
#include <charconv>
#include <string>
#include <system_error>

#include "usb/setup_packet.h"
#include "usb/usbip_session.h"

namespace thimble::device_sim::usb {
namespace {

constexpr std::array<std::string_view, kFaultKinds> kNames{
    "stall",     "short",   "long",       "torn",   "stale",
    "duplicate", "silence", "bit_errors", "unplug", "lost"};
constexpr std::size_t kTooMany = 8;  // additional bytes of an overlong packet

std::string_view next_word(std::string_view& line) {
  const std::size_t begin = std::min(line.find_first_not_of(" \t\r\n"), line.size());
  line.remove_prefix(begin);
  const std::size_t end = std::min(line.find_first_of(" \t\r\n"), line.size());
  const std::string_view word = line.substr(0, end);
  line.remove_prefix(end);
  return word;
}

template <class Number>
bool parse(std::string_view text, Number& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size();
}

driver::Error bad(std::string_view word, const char* why) {
  std::string text(1, '\'');
  text.append(word).append("' ").append(why);
  text.append(
      ". A fault is: KIND [in|out] [after=FRAMES] [for=FRAMES] [rate=CHANCE]. KIND is one of "
      "stall, short, long, torn, stale, duplicate, silence, bit_errors, unplug, lost.");
  return {text};
}

}  // namespace

std::string_view name(FaultKind kind) noexcept {
  const auto i = static_cast<std::size_t>(kind);
  return i < kNames.size() ? kNames[i] : "unknown";
}

driver::Result<FaultOrder> parse_fault(std::string_view line) {
  FaultOrder order;
  const std::string_view kind = next_word(line);
  const auto* found = std::find(kNames.begin(), kNames.end(), kind);
  if (found == kNames.end()) return bad(kind, "is not a kind of fault");
  order.kind = static_cast<FaultKind>(found - kNames.begin());
  for (std::string_view word = next_word(line); !word.empty(); word = next_word(line)) {
    if (word == "in" || word == "out") {
      order.to_host = word == "in";
    } else if (word.starts_with("after=")) {
      if (!parse(word.substr(6), order.after) || order.after < 0 ||
          order.after > FaultOrder::kForever) {
        return bad(word, "needs a whole number of frames, 0 or more");
      }
    } else if (word.starts_with("for=")) {
      if (!parse(word.substr(4), order.frames) || order.frames < 1 ||
          order.frames > FaultOrder::kForever) {
        return bad(word, "needs a whole number of frames, 1 or more");
      }
    } else if (word.starts_with("rate=")) {
      if (!parse(word.substr(5), order.rate) || !(order.rate >= 0 && order.rate <= 1)) {
        return bad(word, "needs a probability from 0 to 1");
      }
    } else {
      return bad(word, "is not a known option of a fault");
    }
  }
  return order;
}

void FaultyDevice::order(const FaultOrder& order) noexcept {
  if (order_count_ == kOrders) {
    std::move(orders_.begin() + 1, orders_.end(), orders_.begin());
    --order_count_;
  }
  const std::int64_t begin = frame_ + order.after;
  const std::int64_t end = order.frames >= FaultOrder::kForever ? INT64_MAX : begin + order.frames;
  orders_[order_count_++] = {order, begin, end};
}

void FaultyDevice::heal() noexcept {
  order_count_ = 0;
  repeat_in_ = false;
}

const FaultyDevice::OpenOrder* FaultyDevice::active(bool to_host,
                                                    std::optional<FaultKind> kind) const noexcept {
  for (std::size_t i = order_count_; i-- > 0;) {
    const OpenOrder& open = orders_[i];
    if (frame_ < open.begin || frame_ >= open.end) continue;
    if (kind ? open.order.kind == *kind : open.order.to_host == to_host) return &open;
  }
  return nullptr;
}

const FaultyDevice::OpenOrder* FaultyDevice::hit(bool to_host) noexcept {
  const OpenOrder* open = active(to_host, FaultKind::kUnplug);
  if (open == nullptr) open = active(to_host);
  if (open != nullptr) ++hits_[index(open->order.kind)];
  return open;
}

void FaultyDevice::advance_to(std::int64_t time_ns) noexcept {
  frame_ = time_ns / UsbDevice::kFrame_ns;
  const auto* over = std::remove_if(orders_.begin(), orders_.begin() + order_count_,
                                    [&](const OpenOrder& open) { return frame_ >= open.end; });
  order_count_ = static_cast<std::size_t>(over - orders_.begin());
  device_.advance_to(time_ns);
}

PacketResult FaultyDevice::control(const SetupPacket& setup, std::span<std::byte> data) noexcept {
  if (!plugged()) return {Answer::kGone, 0};
  return device_.control(setup, data);
}

// Corrupts a good packet; `before` is the previous packet in the same direction.
void FaultyDevice::corrupt(const FaultOrder& order, std::span<std::byte> packet, std::size_t& size,
                           const Kept& before) noexcept {
  switch (order.kind) {
    case FaultKind::kShort:
      size /= 2;
      break;
    case FaultKind::kLong:
      std::fill(packet.begin() + static_cast<std::ptrdiff_t>(size), packet.end(), std::byte{0});
      size += kTooMany;
      break;
    case FaultKind::kTorn:
      for (std::size_t i = size / 2; i < std::min(size, before.size); ++i) {
        packet[i] = before.bytes[i];
      }
      break;
    case FaultKind::kStale:
      if (before.size == 0) break;
      std::copy_n(before.bytes.begin(), before.size, packet.begin());
      size = before.size;
      break;
    case FaultKind::kBitErrors: {
      std::bernoulli_distribution flips(order.rate);
      for (std::size_t bit = 0; bit < 8 * size; ++bit) {
        if (flips(random_)) packet[bit / 8] ^= std::byte{1} << (bit % 8);
      }
      break;
    }
    default:
      break;
  }
}

PacketResult FaultyDevice::in(std::uint8_t address, std::span<std::byte> packet) noexcept {
  const OpenOrder* open = hit(true);
  if (open == nullptr) repeat_in_ = false;
  if (open != nullptr) {
    if (open->order.kind == FaultKind::kUnplug) return {Answer::kGone, 0};
    if (open->order.kind == FaultKind::kStall) return {Answer::kStall, 0};
    if (open->order.kind == FaultKind::kSilence) return {Answer::kNak, 0};
    if (open->order.kind == FaultKind::kDuplicate && repeat_in_) {
      repeat_in_ = false;
      std::copy_n(last_in_.bytes.begin(), last_in_.size, packet.begin());
      return {Answer::kDone, last_in_.size};
    }
  }
  PacketResult result = device_.in(address, packet);
  if (result.answer != Answer::kDone) return result;
  const Kept before = last_in_;
  const bool stale = open != nullptr && open->order.kind == FaultKind::kStale;
  if (!stale) {  // a stale packet stays the one before the fault began
    last_in_.size = std::min(result.size, kPacketMax);
    std::copy_n(packet.begin(), last_in_.size, last_in_.bytes.begin());
  }
  if (open == nullptr) return result;
  if (open->order.kind == FaultKind::kLost) return {Answer::kNak, 0};
  repeat_in_ = open->order.kind == FaultKind::kDuplicate;
  corrupt(open->order, packet, result.size, before);
  return result;
}

PacketResult FaultyDevice::out(std::uint8_t address, std::span<const std::byte> packet) noexcept {
  const OpenOrder* open = hit(false);
  if (open != nullptr) {
    if (open->order.kind == FaultKind::kUnplug) return {Answer::kGone, 0};
    if (open->order.kind == FaultKind::kStall) return {Answer::kStall, 0};
    if (open->order.kind == FaultKind::kSilence) return {Answer::kNak, 0};
    if (open->order.kind == FaultKind::kLost) return {Answer::kDone, packet.size()};
  }
  std::array<std::byte, kPacketMax + kTooMany> bytes{};
  std::size_t size = std::min(packet.size(), kPacketMax);
  std::copy_n(packet.begin(), size, bytes.begin());
  const Kept before = last_out_;
  const bool stale = open != nullptr && open->order.kind == FaultKind::kStale;
  if (!stale) {
    last_out_.size = size;
    std::copy_n(bytes.begin(), size, last_out_.bytes.begin());
  }
  if (open != nullptr) corrupt(open->order, bytes, size, before);
  const PacketResult result = device_.out(address, std::span<const std::byte>(bytes).first(size));
  if (open != nullptr && open->order.kind == FaultKind::kDuplicate) {
    device_.out(address, std::span<const std::byte>(bytes).first(size));
  }
  if (result.answer != Answer::kDone) return result;
  return {Answer::kDone, packet.size()};
}

}  // namespace thimble::device_sim::usb
