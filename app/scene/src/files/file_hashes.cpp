#include "files/file_hashes.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <sstream>
#include <system_error>

#include "disk_paging/checksum.h"
#include "disk_paging/page_file.h"
#include "mesh/file/gltf/read_gltf.h"
#include "system/regular_file.h"

namespace thimble::scene {
namespace {

namespace fs = std::filesystem;

// First line of the text. Another way to hash needs another heading.
constexpr std::string_view kHeading = "checksum64-1";
constexpr std::size_t kDigits = 16;
constexpr std::string_view kNoHash = "----------------";

/// Returns the number of bytes at the begin of a page file that contain the checksums of all pages.
/// [chosen: box and checksum of a page take 32 bytes, a 2048th of the page; twice that, and 64 KiB
/// for header and padding]
constexpr std::uint64_t indexed_bytes(std::uint64_t size) {
  return (std::uint64_t{64} << 10) + size / 1024;
}

/// Returns the hash of a file; empty if it cannot be read. Of a page file only the part before the
/// pages is read, which has their checksums: the pages may not fit into memory.
std::optional<std::uint64_t> hash_of(const fs::path& path) {
  const auto file = driver::RegularFile::open(path);
  if (!file) return {};
  std::uint64_t left = file->size();
  std::uint64_t hash = left;
  if (render::is_page_file(path)) left = std::min(left, indexed_bytes(left));
  constexpr std::size_t kPiece = std::size_t{1} << 20;
  std::vector<std::byte> piece(static_cast<std::size_t>(std::min<std::uint64_t>(left, kPiece)));
  for (off_t at = 0; left > 0;) {
    const auto wanted = static_cast<std::size_t>(std::min<std::uint64_t>(left, piece.size()));
    // Pieces must not depend on how much a call returns.
    std::size_t got = 0;
    while (got < wanted) {
      const ssize_t more =
          pread(file->descriptor(), piece.data() + got, wanted - got, at + static_cast<off_t>(got));
      if (more < 0 && errno == EINTR) continue;
      if (more <= 0) return {};
      got += static_cast<std::size_t>(more);
    }
    hash = render::checksum(std::span(piece).first(wanted), hash);
    at += static_cast<off_t>(wanted);
    left -= wanted;
  }
  return hash;
}

/// Returns the files behind an input: itself, its buffers, or the files of a bag.
std::vector<fs::path> files_of(const fs::path& input) {
  std::error_code status;
  std::vector<fs::path> files;
  if (!fs::is_directory(input, status)) {
    files = render::gltf_buffer_files(input);
    files.insert(files.begin(), input);
    return files;
  }
  for (fs::directory_iterator at(input, status), end; !status && at != end; at.increment(status)) {
    if (at->path().extension() == ".db3") files.push_back(at->path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// A file with the text of its hash.
struct Hashed {
  fs::path path;
  std::string hash;
};

std::vector<Hashed> hashed(const fs::path& input) {
  std::vector<Hashed> all;
  for (const fs::path& path : files_of(input)) {
    const auto hash = hash_of(path);
    all.push_back({path, hash ? fmt::format("{:016x}", *hash) : std::string(kNoHash)});
  }
  return all;
}

}  // namespace

FileHashes::FileHashes(const std::vector<fs::path>& inputs) {
  files_.reserve(inputs.size());
  for (const fs::path& input : inputs) files_.push_back(noted(input));
}

FileHashes::Noted FileHashes::noted(const fs::path& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) return {.path = path};
  return {
      .path = path,
      .inode = status.st_ino,
      .bytes = status.st_size,
      .written_ns = status.st_mtim.tv_sec * std::int64_t{1'000'000'000} + status.st_mtim.tv_nsec};
}

std::string FileHashes::text() {
  const std::lock_guard lock(mutex_);
  if (!text_.empty()) return text_;
  std::string text = std::string(kHeading) + '\n';
  for (const Noted& file : files_) {
    for (Hashed& one : hashed(file.path)) {
      if (noted(file.path) != file) one.hash = kNoHash;
      std::string name = fs::absolute(one.path).lexically_normal().string();
      std::replace(name.begin(), name.end(), '\n', ' ');
      text += one.hash + ' ' + name + '\n';
    }
  }
  text_ = std::move(text);
  return text_;
}

driver::Result<void> check_file_hashes(const std::string& recorded,
                                       const std::vector<fs::path>& inputs) {
  std::istringstream lines(recorded);
  std::string line;
  if (!std::getline(lines, line) || line != kHeading) {
    return driver::Error{
        "the recording has file hashes of an unknown kind; use the version of thimble that made "
        "the recording."};
  }
  std::vector<std::string> hashes;
  while (std::getline(lines, line)) hashes.push_back(line.substr(0, kDigits));
  std::size_t count = 0;
  for (const fs::path& input : inputs) {
    for (const Hashed& now : hashed(input)) {
      if (count == hashes.size()) {
        return driver::Error{now.path.string() + " was not read in the recorded run."};
      }
      const std::string& then = hashes[count++];
      if (then == kNoHash) {
        return driver::Error{now.path.string() +
                             " was changed during the recorded run, before the recording began."};
      }
      if (now.hash == kNoHash) return driver::Error{now.path.string() + " cannot be read."};
      if (now.hash != then) {
        return driver::Error{now.path.string() + " has changed since the recording."};
      }
    }
  }
  if (count < hashes.size()) {
    return driver::Error{fmt::format(
        "the recorded run read {} files besides scene and arm, now {}.", hashes.size(), count)};
  }
  return {};
}

}  // namespace thimble::scene
