#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "system/regular_file.h"

namespace thimble::view {

/// Reads the lines of a file one after the other, with bounded memory. Real-time: never from the
/// servo thread.
class TextLines {
 public:
  enum class Next { kLine, kEnd, kTooLong, kUnreadable };

  /// `line_max`: maximum length of a line, bytes.
  TextLines(driver::RegularFile file, std::size_t line_max)
      : file_(std::move(file)), buffer_(line_max + 1) {}

  /// Reads the next line, without its end (LF or CR LF). `line` is valid until the next call.
  Next next(std::string_view& line);

  /// Returns the number of the line that was read last, from 1.
  std::size_t number() const { return number_; }
  /// Returns the number of bytes read so far.
  std::uint64_t read() const { return read_; }
  /// Returns the size of the file, bytes.
  std::uint64_t size() const { return file_.size(); }

 private:
  bool fill();  // false: the file cannot be read

  driver::RegularFile file_;
  std::vector<char> buffer_;
  std::size_t begin_ = 0, end_ = 0;  // the part of the buffer that was not returned yet
  bool at_end_ = false;
  std::size_t number_ = 0;
  std::uint64_t read_ = 0;
};

}  // namespace thimble::view
