#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <utility>

#include "thimble/driver/result.h"

namespace thimble::driver {

/// What work in a process of its own may use.
struct ApartLimits {
  int seconds = 10;  ///< Of processor time.
  /// Of memory, above what this process has now; and of what it returns.
  std::size_t bytes = std::size_t{1} << 30;
};

/// Takes what work in a process of its own returns.
class ApartWriter {
 public:
  explicit ApartWriter(int file) noexcept : file_(file) {}
  /// Adds bytes. Returns false if there is no room for them; then nothing is returned.
  bool write(const void* bytes, std::size_t size) noexcept;
  /// Drops what was written. Returns false if that fails.
  bool restart() noexcept;
  /// Returns whether all bytes found room.
  bool good() const noexcept { return good_; }
  /// Returns the number of bytes written.
  std::size_t size() const noexcept { return size_; }

 private:
  int file_;
  std::size_t size_ = 0;
  bool good_ = true;
};

/// What work in a process of its own returned: memory that nothing changes any longer.
class ApartMemory {
 public:
  ApartMemory(const std::byte* at, std::size_t mapped, std::span<const std::byte> bytes) noexcept
      : at_(at), mapped_(mapped), bytes_(bytes) {}
  ApartMemory(ApartMemory&& other) noexcept
      : at_(std::exchange(other.at_, nullptr)), mapped_(other.mapped_), bytes_(other.bytes_) {}
  ApartMemory& operator=(ApartMemory&&) = delete;
  ApartMemory(const ApartMemory&) = delete;
  ApartMemory& operator=(const ApartMemory&) = delete;
  ~ApartMemory();

  /// Returns the bytes, aligned for any number.
  std::span<const std::byte> bytes() const noexcept { return bytes_; }

 private:
  const std::byte* at_;
  std::size_t mapped_;
  std::span<const std::byte> bytes_;
};

/// Returns what `work` writes, done by a child of this process: whatever it does, this process
/// neither crashes nor hangs. What the child writes to standard output or error is lost; files and
/// memory that it changes are its own. The error says in half a sentence how the child ended
/// ("takes more than 10 s"). Real-time: never from the servo thread.
Result<ApartMemory> run_apart(const std::function<void(ApartWriter&)>& work,
                              const ApartLimits& limits);

/// As above, for work that returns a text.
Result<std::string> run_apart(const std::function<std::string()>& work, const ApartLimits& limits);

}  // namespace thimble::driver
