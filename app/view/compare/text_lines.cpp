#include "view/compare/text_lines.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace thimble::view {

bool TextLines::fill() {
  if (begin_ > 0) {
    std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
    end_ -= begin_;
    begin_ = 0;
  }
  ssize_t got = 0;
  do {
    got = ::read(file_.descriptor(), buffer_.data() + end_, buffer_.size() - end_);
  } while (got < 0 && errno == EINTR);
  if (got < 0) return false;
  if (got == 0) at_end_ = true;
  end_ += static_cast<std::size_t>(got);
  read_ += static_cast<std::uint64_t>(got);
  return true;
}

TextLines::Next TextLines::next(std::string_view& line) {
  std::size_t searched = 0;
  for (;;) {
    const std::string_view rest(buffer_.data() + begin_, end_ - begin_);
    const std::size_t found = rest.find('\n', searched);
    if (found == std::string_view::npos && !at_end_) {
      if (rest.size() == buffer_.size()) {
        ++number_;
        return Next::kTooLong;
      }
      searched = rest.size();
      if (!fill()) return Next::kUnreadable;
      continue;
    }
    if (found == std::string_view::npos && rest.empty()) return Next::kEnd;
    line = rest.substr(0, found);
    begin_ += found == std::string_view::npos ? rest.size() : found + 1;
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    ++number_;
    return Next::kLine;
  }
}

}  // namespace thimble::view
