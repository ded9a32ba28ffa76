#include "system/regular_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <iterator>
#include <string>
#include <system_error>

namespace thimble::driver {
namespace {

constexpr const char* kNotRegular =
    "this is not a regular file (a pipe or a device, say); give the path of a file.";

/// Reads up to `size` bytes; fewer at the end of the file. Returns -1 if reading fails.
ssize_t read_up_to(int descriptor, char* bytes, std::size_t size) {
  std::size_t done = 0;
  while (done < size) {
    const ssize_t got = read(descriptor, bytes + done, size - done);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return -1;
    if (got == 0) break;
    done += static_cast<std::size_t>(got);
  }
  return static_cast<ssize_t>(done);
}

std::string size_text(std::uint64_t bytes) {
  const auto value = static_cast<double>(bytes);
  const auto three_digits = [](double number) {
    char text[32];
    const auto end = std::to_chars(text, std::end(text), number, std::chars_format::general, 3);
    return std::string(text, end.ptr);
  };
  if (value >= 1e9) return three_digits(value * 1e-9) + " GB";
  if (value >= 1e6) return three_digits(value * 1e-6) + " MB";
  return three_digits(value * 1e-3) + " kB";
}

}  // namespace

Result<RegularFile> RegularFile::open(const std::filesystem::path& path) {
  // A pipe without a writer is opened without waiting, and refused; a terminal does not become the
  // controlling terminal of this process.
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  if (descriptor < 0) {
    if (errno == ENOENT || errno == ENOTDIR) return Error{"there is no such file."};
    if (errno == ENXIO) return Error{kNotRegular};
    return Error{"it cannot be opened (" + std::generic_category().message(errno) +
                 "); check its permissions."};
  }
  struct stat status {};
  if (fstat(descriptor, &status) != 0 || !S_ISREG(status.st_mode)) {
    const bool folder = S_ISDIR(status.st_mode);
    close(descriptor);
    return Error{folder ? "this is not a file but a folder; give the path of a file."
                        : kNotRegular};
  }
  return RegularFile(descriptor, static_cast<std::uint64_t>(std::max<off_t>(status.st_size, 0)));
}

RegularFile::~RegularFile() {
  if (descriptor_ >= 0) close(descriptor_);
}

std::uint64_t RegularFile::stored() const noexcept {
  std::uint64_t stored = 0;
  const auto end = static_cast<off_t>(size_);
  for (off_t at = 0; at < end;) {
    const off_t data = lseek(descriptor_, at, SEEK_DATA);
    if (data < 0 && errno == ENXIO) break;  // a hole up to the end
    const off_t hole = data < 0 ? -1 : lseek(descriptor_, data, SEEK_HOLE);
    if (hole <= data) {  // a file system without holes
      stored = size_;
      break;
    }
    stored += static_cast<std::uint64_t>(hole - data);
    at = hole;
  }
  lseek(descriptor_, 0, SEEK_SET);
  return stored;
}

bool is_regular(const std::filesystem::path& path) noexcept {
  struct stat status {};
  return stat(path.c_str(), &status) == 0 && S_ISREG(status.st_mode);
}

Result<std::string> read_file(const std::filesystem::path& path, std::uint64_t max_bytes) {
  const auto file = RegularFile::open(path);
  if (!file) return file.error();
  const Error too_large{"it is larger than " + size_text(max_bytes) +
                        ", the limit for this kind of file."};
  if (file->size() > max_bytes) return too_large;
  // Files of /proc have a size of 0 and content.
  std::string bytes(file->size() + 1, '\0');
  std::size_t done = 0;
  for (;;) {
    const ssize_t got = read_up_to(file->descriptor(), bytes.data() + done, bytes.size() - done);
    if (got < 0) {
      return Error{"reading it failed (" + std::generic_category().message(errno) + ")."};
    }
    done += static_cast<std::size_t>(got);
    if (done > max_bytes) return too_large;
    if (done < bytes.size()) break;
    bytes.resize(std::min<std::uint64_t>(2 * bytes.size() + 4096, max_bytes + 1));
  }
  bytes.resize(done);
  return bytes;
}

std::string read_head(const std::filesystem::path& path, std::size_t bytes) {
  std::string head(bytes, '\0');
  const auto file = RegularFile::open(path);
  const ssize_t got = file ? read_up_to(file->descriptor(), head.data(), bytes) : 0;
  head.resize(static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
  return head;
}

}  // namespace thimble::driver
