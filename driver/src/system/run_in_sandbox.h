#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <span>
#include <string>
#include <utility>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::driver {

/// Limits of work in a separate process.
struct SandboxLimits {
  int seconds = 10;  ///< Processor time, s.
  /// Max. memory above the present use of this process; also max. size of the result. Bytes.
  std::size_t bytes = std::size_t{1} << 30;
};

/// Receives the result of work in a separate process.
class THIMBLE_EXPORT SandboxWriter {
 public:
  explicit SandboxWriter(int file) noexcept : file_(file) {}
  /// Adds bytes. Returns false if there is no room for them; then nothing is returned.
  bool write(const void* bytes, std::size_t size) noexcept;
  /// Adds the number of items, then the items, as SandboxReader::take_array reads them.
  template <class Item>
  bool write_array(const Item* items, std::size_t count) noexcept {
    const std::uint64_t number = count;
    return write(&number, sizeof number) && write(items, count * sizeof(Item));
  }
  /// Drops all bytes written. Returns false if that fails.
  bool restart() noexcept;
  /// Returns whether there was room for all bytes.
  bool good() const noexcept { return good_; }
  /// Returns the number of bytes written.
  std::size_t size() const noexcept { return size_; }

 private:
  int file_;
  std::size_t size_ = 0;
  bool good_ = true;
};

/// The result of work in a separate process, in memory that no longer changes.
class THIMBLE_EXPORT SandboxMemory {
 public:
  SandboxMemory(const std::byte* at, std::size_t mapped, std::span<const std::byte> bytes) noexcept
      : at_(at), mapped_(mapped), bytes_(bytes) {}
  SandboxMemory(SandboxMemory&& other) noexcept
      : at_(std::exchange(other.at_, nullptr)), mapped_(other.mapped_), bytes_(other.bytes_) {}
  SandboxMemory& operator=(SandboxMemory&&) = delete;
  SandboxMemory(const SandboxMemory&) = delete;
  SandboxMemory& operator=(const SandboxMemory&) = delete;
  ~SandboxMemory();

  /// Returns the bytes, aligned for any number.
  std::span<const std::byte> bytes() const noexcept { return bytes_; }

 private:
  const std::byte* at_;
  std::size_t mapped_;
  std::span<const std::byte> bytes_;
};

/// Reads the result of work in a separate process, in the order in which it was written.
///
/// Malformed input may have corrupted that process, so its output is untrusted: nothing is read
/// beyond its bytes, and nothing is allocated that they do not hold.
class SandboxReader {
 public:
  explicit SandboxReader(std::span<const std::byte> bytes) noexcept : left_(bytes) {}

  /// Copies bytes. Returns false, and takes nothing, if fewer are left.
  bool take(void* into, std::size_t size) noexcept {
    if (left_.size() < size) return false;
    if (size > 0) std::memcpy(into, left_.data(), size);
    left_ = left_.subspan(size);
    return true;
  }
  /// Copies an array of SandboxWriter::write_array into a std::string or std::vector of plain
  /// items. Returns false if its item count exceeds the bytes left.
  template <class Array>
  bool take_array(Array& items) {
    std::uint64_t number = 0;
    constexpr std::size_t kItem = sizeof(typename Array::value_type);
    if (!take(&number, sizeof number) || number > left_.size() / kItem) return false;
    items.resize(number);
    return take(static_cast<void*>(items.data()), number * kItem);
  }
  /// Returns the bytes that are left.
  std::span<const std::byte> left() const noexcept { return left_; }

 private:
  std::span<const std::byte> left_;
};

/// Returns the bytes that `work` writes, run in a child process. The child cannot crash or hang
/// this process. Its standard output and error are lost; its changes to files and memory stay its
/// own. The error states, as half a sentence, how the child ended ("takes more than 10 s").
/// Real-time: never from the servo thread.
THIMBLE_EXPORT Result<SandboxMemory> run_in_sandbox(const std::function<void(SandboxWriter&)>& work,
                                                    const SandboxLimits& limits);

/// As above, for work that returns a string.
THIMBLE_EXPORT Result<std::string> run_in_sandbox(const std::function<std::string()>& work,
                                                  const SandboxLimits& limits);

}  // namespace thimble::driver
