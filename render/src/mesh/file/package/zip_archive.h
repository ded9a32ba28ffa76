#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "thimble/driver/result.h"

namespace thimble::render {

/// The files in a ZIP archive of one volume, stored or deflated, with or without ZIP64 numbers
/// [PKWARE, APPNOTE 4.3]. The bytes must outlive it.
class ZipArchive {
 public:
  /// Reads the directory of an archive; the error is half a sentence. Real-time: never from the
  /// servo thread.
  static driver::Result<ZipArchive> open(std::string_view bytes);

  /// Returns the names of the files.
  std::vector<std::string> names() const;

  /// Returns whether it holds a file of this name.
  bool holds(std::string_view name) const { return find(name) != nullptr; }

  /// Returns the contents of a file. Its name is case-insensitive and a leading slash is ignored,
  /// as for parts of packages [ISO/IEC 29500-2]. The error is half a sentence: no such file,
  /// encrypted, unknown compression, or damaged. Takes memory of the unpacked size, at most a
  /// thousand times the packed one. Real-time: never from the servo thread.
  driver::Result<std::string> read(std::string_view name) const;

 private:
  struct Entry {
    std::string name;
    std::uint64_t flags = 0, method = 0, packed = 0, size = 0, place = 0;
  };

  explicit ZipArchive(std::string_view bytes) : bytes_(bytes) {}
  const Entry* find(std::string_view name) const;

  std::string_view bytes_;
  std::vector<Entry> entries_;
};

}  // namespace thimble::render
