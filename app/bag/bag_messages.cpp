#include "bag/bag_messages.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace thimble::bag {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::size_t kHeaderBytes = 4;          // byte order and options
constexpr std::int64_t kSecond = 1'000'000'000;  // ns

/// Returns the number of numbers after the header of a message: a point and a rotation, or two
/// vectors.
std::size_t numbers_in(BagKind kind) {
  return kind == BagKind::kPositions ? 7 : 6;
}

class CdrReader {
 public:
  CdrReader(std::span<const unsigned char> body, bool swapped) : body_(body), swapped_(swapped) {}

  template <class T>
  bool read(T& value) {
    at_ = (at_ + sizeof value - 1) / sizeof value * sizeof value;
    if (at_ > body_.size() || body_.size() - at_ < sizeof value) return false;
    std::array<unsigned char, sizeof value> raw;
    std::memcpy(raw.data(), body_.data() + at_, sizeof value);
    if (swapped_) std::reverse(raw.begin(), raw.end());
    std::memcpy(&value, raw.data(), sizeof value);
    at_ += sizeof value;
    return true;
  }

  bool read(std::string& text) {
    std::uint32_t length = 0;  // including the terminating zero
    if (!read(length) || body_.size() - at_ < length) return false;
    text.assign(reinterpret_cast<const char*>(body_.data()) + at_, length == 0 ? 0 : length - 1);
    const bool ended = length == 0 || body_[at_ + length - 1] == 0;
    at_ += length;
    return ended && text.find('\0') == std::string::npos;
  }

  std::size_t left() const { return body_.size() - at_; }

 private:
  std::span<const unsigned char> body_;
  bool swapped_;
  std::size_t at_ = 0;
};

class CdrWriter {
 public:
  template <class T>
  void write(T value) {
    while ((bytes_.size() - kHeaderBytes) % sizeof value != 0) bytes_.push_back(0);
    const auto raw = std::bit_cast<std::array<unsigned char, sizeof value>>(value);
    bytes_.insert(bytes_.end(), raw.begin(), raw.end());
  }
  void write(const std::string& text) {
    write(static_cast<std::uint32_t>(text.size() + 1));
    bytes_.insert(bytes_.end(), text.begin(), text.end());
    bytes_.push_back(0);
  }
  std::vector<unsigned char> take() { return std::move(bytes_); }

 private:
  std::vector<unsigned char> bytes_{0, 1, 0, 0};
};

}  // namespace

std::string_view type_of(BagKind kind) noexcept {
  return kind == BagKind::kPositions ? "geometry_msgs/msg/PoseStamped"
                                     : "geometry_msgs/msg/WrenchStamped";
}

std::optional<StampedVector> decode(BagKind kind, std::span<const unsigned char> bytes) {
  // The first two bytes are 0 0 for big-endian and 0 1 for little-endian. Others are encodings that
  // ROS 2 does not write.
  if (bytes.size() < kHeaderBytes || bytes[0] != 0 || bytes[1] > 1) return {};
  CdrReader reader(bytes.subspan(kHeaderBytes), bytes[1] == 0);
  std::int32_t seconds = 0;
  std::uint32_t nanoseconds = 0;
  StampedVector message;
  if (!reader.read(seconds) || !reader.read(nanoseconds) || !reader.read(message.frame)) return {};
  if (nanoseconds >= kSecond) return {};
  message.stamp_ns = seconds * kSecond + nanoseconds;
  std::array<double, 7> numbers{};
  for (std::size_t i = 0; i < numbers_in(kind); ++i) {
    if (!reader.read(numbers[i])) return {};
  }
  // Writers may pad up to the next word; more bytes mean another message type.
  if (reader.left() >= sizeof(double)) return {};
  message.value = {numbers[0], numbers[1], numbers[2]};
  return message;
}

std::vector<unsigned char> encode(BagKind kind, const StampedVector& message,
                                  const std::array<double, 4>& q) {
  CdrWriter writer;
  // Rounds the seconds down, so that the rest is not negative.
  std::int64_t seconds = message.stamp_ns / kSecond, rest = message.stamp_ns % kSecond;
  if (rest < 0) --seconds, rest += kSecond;
  writer.write(static_cast<std::int32_t>(seconds));
  writer.write(static_cast<std::uint32_t>(rest));
  writer.write(message.frame);
  for (const double number : message.value) writer.write(number);
  if (kind == BagKind::kPositions) {
    for (const std::size_t i : {1U, 2U, 3U, 0U}) writer.write(q[i]);
  } else {
    for (int i = 0; i < 3; ++i) writer.write(0.0);
  }
  return writer.take();
}

}  // namespace thimble::bag
