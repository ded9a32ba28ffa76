#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::scene {

/// A file of the mesh cache, open for reading.
///
///     header | key | text | up to four arrays
///
/// The header has the format's version, the byte order, the sizes of all parts, a checksum of
/// header, key and text, and one of each array. So each byte of the file is checked, and it may
/// have neither more nor fewer. Real-time: never from the servo thread.
class THIMBLE_EXPORT CacheEntry {
 public:
  static constexpr std::size_t kArraysMax = 4;  ///< Maximum number of arrays.

  /// Opens an entry with this key. None if there is no such file. The error is a part of a sentence
  /// after "it": the file is damaged, has another version or key, or can be written by other users.
  static driver::Result<std::optional<CacheEntry>> open(const std::filesystem::path& file,
                                                        std::string_view key);

  /// Writes an entry. Replaces a file of the name at once and as a whole; of several writers the
  /// last one remains. Fails if it cannot be written; then nothing is left of it.
  static driver::Result<void> write(const std::filesystem::path& file, std::string_view key,
                                    std::string_view text,
                                    std::span<const std::span<const std::byte>> arrays);

  /// Returns the text of an entry without looking at its key and its arrays; empty if it is not one
  /// of this version.
  static std::optional<std::string> text_of(const std::filesystem::path& file);

  CacheEntry(CacheEntry&& other) noexcept;
  CacheEntry& operator=(CacheEntry&&) = delete;
  CacheEntry(const CacheEntry&) = delete;
  CacheEntry& operator=(const CacheEntry&) = delete;
  ~CacheEntry();

  /// Returns the text: values for the owner of the key.
  const std::string& text() const noexcept { return text_; }
  /// Returns the number of bytes of an array; 0 if there is none.
  std::uint64_t bytes_of(std::size_t array) const noexcept { return arrays_[array].bytes; }
  /// Reads an array into `to`, which has its size. Returns false if it cannot be read or is
  /// damaged.
  bool read(std::size_t array, std::span<std::byte> to) const noexcept;
  /// Sets the time of the last use to now.
  void mark_used() const noexcept;

 private:
  struct Array {
    std::uint64_t bytes = 0, begin = 0, sum = 0;
  };

  CacheEntry() = default;
  std::string open_file(const std::filesystem::path& file, bool& absent);
  std::string read_head(std::string& key);

  int descriptor_ = -1;
  std::uint64_t file_bytes_ = 0;
  std::string text_;
  std::array<Array, kArraysMax> arrays_{};
};

}  // namespace thimble::scene
