#include "files/regular_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

namespace thimble::scene {
namespace {

/// An open file, closed with this object.
class OpenFile {
 public:
  // O_NONBLOCK: a pipe without a writer would keep the program waiting in open().
  explicit OpenFile(const std::filesystem::path& file)
      : descriptor_(open(file.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC)) {}
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  ~OpenFile() {
    if (descriptor_ >= 0) close(descriptor_);
  }
  int descriptor() const { return descriptor_; }

 private:
  int descriptor_;
};

}  // namespace

driver::Result<std::string> read_regular_file(const std::filesystem::path& file,
                                              std::uintmax_t size_max, std::string_view expected) {
  const auto failed = [&file](const std::string& what) {
    return driver::Error{file.string() + ": " + what};
  };
  const OpenFile opened(file);
  struct stat status {};
  if (opened.descriptor() < 0 && (errno == ENOENT || errno == ENOTDIR)) {
    return failed("there is no such file.");
  }
  if (opened.descriptor() < 0 && (errno == ENXIO || errno == ENODEV)) {
    return failed(fmt::format("this is not a file; give the path of {}.", expected));
  }
  if (opened.descriptor() < 0 || fstat(opened.descriptor(), &status) != 0) {
    return failed(fmt::format("cannot be read ({}); check its permissions.", std::strerror(errno)));
  }
  if (!S_ISREG(status.st_mode)) {
    return failed(fmt::format("this is not a file; give the path of {}.", expected));
  }
  const std::string too_large = fmt::format("is larger than {:.0f} MB, so it cannot be {}.",
                                            static_cast<double>(size_max) / (1 << 20), expected);
  if (static_cast<std::uintmax_t>(status.st_size) > size_max) return failed(too_large);
  std::string text;
  std::array<char, 1 << 16> part;
  for (;;) {
    const ssize_t size = read(opened.descriptor(), part.data(), part.size());
    if (size < 0 && errno == EINTR) continue;
    if (size < 0) return failed(fmt::format("cannot be read ({}).", std::strerror(errno)));
    if (size == 0) return text;
    text.append(part.data(), static_cast<std::size_t>(size));
    if (text.size() > size_max) return failed(too_large);
  }
}

}  // namespace thimble::scene
