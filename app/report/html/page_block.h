#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace thimble::report {

/// The numbers of a page: arrays of plain numbers one after the other, little-endian, each at a
/// multiple of 8 bytes, so that a browser looks at them in place. Real-time: never from the servo
/// thread.
class PageBlock {
 public:
  /// Adds an array under a name of its own; its type in the page is that of JavaScript's typed
  /// arrays: f64, f32, u32, u16, i16 or u8.
  void add(const std::string& name, std::span<const double> numbers);
  void add(const std::string& name, std::span<const float> numbers);          ///< As above.
  void add(const std::string& name, std::span<const std::uint32_t> numbers);  ///< As above.
  void add(const std::string& name, std::span<const std::uint16_t> numbers);  ///< As above.
  void add(const std::string& name, std::span<const std::int16_t> numbers);   ///< As above.
  void add(const std::string& name, std::span<const std::uint8_t> numbers);   ///< As above.

  /// Returns where each array lies: {"NAME": {"type", "offset", "count"}}, offsets in bytes.
  const nlohmann::ordered_json& arrays() const noexcept { return arrays_; }
  /// Returns all bytes.
  std::span<const std::uint8_t> bytes() const noexcept { return bytes_; }

 private:
  void append(const std::string& name, const char* type, const void* data, std::size_t count,
              std::size_t size);

  nlohmann::ordered_json arrays_ = nlohmann::ordered_json::object();
  std::vector<std::uint8_t> bytes_;
};

/// Writes bytes as base64 (RFC 4648), without line breaks.
std::string base64(std::span<const std::uint8_t> bytes);

/// Writes text so that it may stand in HTML, between tags or in a quoted attribute.
std::string html_text(std::string_view text);

}  // namespace thimble::report
