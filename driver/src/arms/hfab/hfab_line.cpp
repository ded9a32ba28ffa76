#include "arms/hfab/hfab_line.h"

#include <charconv>

namespace thimble::driver::hfab {
namespace {

/// Reads exactly numbers.size() numbers between brackets.
bool decode(std::span<const std::byte> bytes, std::span<std::int32_t> numbers) noexcept {
  if (bytes.empty() || bytes.size() > kLineCapacity) return false;
  const char* at = reinterpret_cast<const char*>(bytes.data());
  const char* const end = at + bytes.size();
  char expected = '[';
  for (std::int32_t& number : numbers) {
    if (at == end || *at != expected) return false;
    const auto [after, failure] = std::from_chars(at + 1, end, number);
    if (failure != std::errc()) return false;
    at = after;
    expected = ',';
  }
  if (at == end || *at != ']') return false;
  for (++at; at != end; ++at) {
    if (*at != '\n' && *at != '\r' && *at != '\0') return false;
  }
  return true;
}

std::size_t encode(std::span<const std::int32_t> numbers,
                   std::span<std::byte, kLineCapacity> bytes) noexcept {
  char* const begin = reinterpret_cast<char*>(bytes.data());
  char* const end = begin + bytes.size();
  char* at = begin;
  char before = '[';
  for (const std::int32_t number : numbers) {
    *at++ = before;
    at = std::to_chars(at, end, number).ptr;
    before = ',';
  }
  *at++ = ']';
  *at++ = '\n';
  return static_cast<std::size_t>(at - begin);
}

}  // namespace

std::optional<ArmLine> decode_arm_line(std::span<const std::byte> bytes) noexcept {
  std::array<std::int32_t, 8> numbers{};
  if (!decode(bytes, numbers)) return std::nullopt;
  ArmLine line;
  line.model = numbers[0];
  for (std::size_t i = 0; i < 6; ++i) line.counts[i] = numbers[1 + i];
  line.error = numbers[7];
  return line;
}

std::size_t encode_arm_line(const ArmLine& line,
                            std::span<std::byte, kLineCapacity> bytes) noexcept {
  std::array<std::int32_t, 8> numbers{};
  numbers[0] = line.model;
  for (std::size_t i = 0; i < 6; ++i) numbers[1 + i] = line.counts[i];
  numbers[7] = line.error;
  return encode(numbers, bytes);
}

std::optional<HostLine> decode_host_line(std::span<const std::byte> bytes) noexcept {
  HostLine line;
  if (!decode(bytes, line.current_mA)) return std::nullopt;
  return line;
}

std::size_t encode_host_line(const HostLine& line,
                             std::span<std::byte, kLineCapacity> bytes) noexcept {
  return encode(line.current_mA, bytes);
}

}  // namespace thimble::driver::hfab
