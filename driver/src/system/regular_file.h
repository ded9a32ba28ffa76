#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::driver {

/// A regular file, open for reading. Folders, pipes, sockets and devices are refused without
/// waiting for them: a path may come from a file of unknown origin. Real-time: never from the servo
/// thread.
class THIMBLE_EXPORT RegularFile {
 public:
  /// Opens a file; follows symbolic links. The error is a sentence without the path, for the caller
  /// to complete ("there is no such file.").
  static Result<RegularFile> open(const std::filesystem::path& path);
  RegularFile(RegularFile&& other) noexcept
      : descriptor_(std::exchange(other.descriptor_, -1)), size_(other.size_) {}
  RegularFile& operator=(RegularFile&&) = delete;
  RegularFile(const RegularFile&) = delete;
  RegularFile& operator=(const RegularFile&) = delete;
  ~RegularFile();

  /// Returns the descriptor, which this object closes.
  int descriptor() const noexcept { return descriptor_; }
  /// Returns the descriptor. The caller must close it.
  int release() noexcept { return std::exchange(descriptor_, -1); }
  /// Returns the size in bytes at the time of opening, holes included.
  std::uint64_t size() const noexcept { return size_; }
  /// Returns the number of bytes stored, without holes: at least the bytes that are not 0, rounded
  /// up to blocks of the file system.
  std::uint64_t stored() const noexcept;

 private:
  RegularFile(int descriptor, std::uint64_t size) noexcept : descriptor_(descriptor), size_(size) {}

  int descriptor_;
  std::uint64_t size_;
};

/// Returns whether `path` is a regular file, without opening it.
THIMBLE_EXPORT bool is_regular(const std::filesystem::path& path) noexcept;

/// Reads a whole regular file of at most `max_bytes` bytes. Errors as of `RegularFile::open`.
/// Real-time: never from the servo thread.
THIMBLE_EXPORT Result<std::string> read_file(const std::filesystem::path& path,
                                             std::uint64_t max_bytes);

/// Reads the first `bytes` bytes of a regular file; fewer if it is shorter, none if it cannot be
/// read. Real-time: never from the servo thread.
THIMBLE_EXPORT std::string read_head(const std::filesystem::path& path, std::size_t bytes);

}  // namespace thimble::driver
