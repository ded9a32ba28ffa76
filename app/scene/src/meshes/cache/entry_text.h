#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

namespace thimble::scene {

// Values as bytes, for keys and texts of cache entries: numbers as 8 bytes, doubles by their bits,
// a text after its length. Real-time: never from the servo thread.

/// Appends values to bytes.
class EntryWriter {
 public:
  template <class T>
  requires std::integral<T> || std::is_enum_v<T>
  void add(T number) {
    const auto wide = static_cast<std::uint64_t>(number);
    bytes_.append(reinterpret_cast<const char*>(&wide), sizeof(wide));
  }
  void add(double number) { add(std::bit_cast<std::uint64_t>(number)); }
  void add(std::string_view text) {
    add(text.size());
    bytes_.append(text);
  }
  template <class T>
  void add(const std::optional<T>& value) {
    add(value.has_value());
    if (value) add(*value);
  }

  /// Returns the bytes.
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

/// Reads values in the order in which they were added. After the end, or if a value is impossible,
/// all values are 0 or empty, and `good` is false.
class EntryReader {
 public:
  explicit EntryReader(std::string_view bytes) : left_(bytes) {}

  std::uint64_t number() {
    std::uint64_t wide = 0;
    const std::string_view bytes = take(sizeof(wide));
    if (good_) std::memcpy(&wide, bytes.data(), sizeof(wide));
    return wide;
  }
  /// Returns a number below `limit`.
  std::uint64_t number_below(std::uint64_t limit) {
    const std::uint64_t read = number();
    good_ = good_ && read < limit;
    return good_ ? read : 0;
  }
  bool flag() { return number_below(2) != 0; }
  double real() { return std::bit_cast<double>(number()); }
  std::optional<double> optional_real() {
    if (!flag()) return {};
    return real();
  }
  std::string text() { return std::string(take(number())); }

  /// Returns whether all values were there, and all bytes have been read.
  bool complete() const { return good_ && left_.empty(); }
  /// Returns whether all values were there so far.
  bool good() const { return good_; }

 private:
  std::string_view take(std::uint64_t count) {
    good_ = good_ && count <= left_.size();
    if (!good_) return {};
    const std::string_view taken = left_.substr(0, static_cast<std::size_t>(count));
    left_.remove_prefix(taken.size());
    return taken;
  }

  std::string_view left_;
  bool good_ = true;
};

}  // namespace thimble::scene
