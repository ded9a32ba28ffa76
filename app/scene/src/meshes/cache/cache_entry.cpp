#include "meshes/cache/cache_entry.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <type_traits>

#include "disk_paging/checksum.h"

namespace thimble::scene {
namespace {

static_assert(std::endian::native == std::endian::little, "content_hash reads words so.");

constexpr std::array<char, 8> kEntryMagic{'T', 'H', 'M', 'B', 'P', 'R', 'E', 'P'};
constexpr std::uint32_t kEntryVersion = 1;
constexpr std::uint32_t kByteOrder = 0x01020304;
constexpr std::size_t kEntryPieceBytes = std::size_t{1} << 20;
// Largest size of key and text. [chosen: both have less than 4 KiB, and a damaged header must not
// reserve memory]
constexpr std::uint64_t kHeadMax = std::uint64_t{1} << 20;

struct EntryHeader {
  std::array<char, 8> magic = kEntryMagic;
  std::uint32_t version = kEntryVersion;
  std::uint32_t byte_order = kByteOrder;
  std::uint64_t key_bytes = 0, text_bytes = 0;
  std::array<std::uint64_t, CacheEntry::kArraysMax> array_bytes{}, array_sums{};
  std::uint64_t sum = 0;  // of header, key and text, computed while this is 0
};
static_assert(sizeof(EntryHeader) == 104 && std::has_unique_object_representations_v<EntryHeader>);

std::span<const std::byte> text_bytes(std::string_view text) {
  return std::as_bytes(std::span(text));
}

std::uint64_t entry_sum(EntryHeader header, std::string_view key, std::string_view text) {
  header.sum = 0;
  std::uint64_t sum = render::checksum(std::as_bytes(std::span(&header, 1)));
  sum = render::checksum(text_bytes(key), sum);
  return render::checksum(text_bytes(text), sum);
}

// Returns the checksum of an array, piece by piece.
std::uint64_t entry_sum(std::span<const std::byte> array) {
  std::uint64_t sum = 0;
  while (!array.empty()) {
    const auto piece = array.first(std::min(array.size(), kEntryPieceBytes));
    sum = render::checksum(piece, sum);
    array = array.subspan(piece.size());
  }
  return sum;
}

bool read_entry_bytes(int descriptor, std::span<std::byte> to, std::uint64_t at) noexcept {
  while (!to.empty()) {
    const ssize_t got = pread(descriptor, to.data(), to.size(), static_cast<off_t>(at));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    to = to.subspan(static_cast<std::size_t>(got));
    at += static_cast<std::uint64_t>(got);
  }
  return true;
}

// Returns 0, or the number of the error.
int append_bytes(int descriptor, std::span<const std::byte> bytes) noexcept {
  while (!bytes.empty()) {
    const ssize_t written =
        ::write(descriptor, bytes.data(), std::min(bytes.size(), kEntryPieceBytes));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return written < 0 ? errno : ENOSPC;
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return 0;
}

driver::Error entry_not_written(const std::filesystem::path& file, int number) {
  return driver::Error{fmt::format("{} cannot be written ({})", file.string(),
                                   std::generic_category().message(number))};
}

}  // namespace

CacheEntry::CacheEntry(CacheEntry&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)),
      file_bytes_(other.file_bytes_),
      text_(std::move(other.text_)),
      arrays_(other.arrays_) {}

CacheEntry::~CacheEntry() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

// Returns why the file cannot be used; empty if it can. A file that another user may have written
// is refused, because checksums can be computed for any contents.
std::string CacheEntry::open_file(const std::filesystem::path& file, bool& absent) {
  // A pipe would be waited for otherwise.
  descriptor_ = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NOCTTY | O_NONBLOCK);
  if (descriptor_ < 0) {
    absent = errno == ENOENT || errno == ENOTDIR;
    return fmt::format("cannot be read ({})", std::generic_category().message(errno));
  }
  struct stat status {};
  if (::fstat(descriptor_, &status) != 0 || !S_ISREG(status.st_mode)) return "is not a file";
  if (status.st_uid != ::geteuid() || (status.st_mode & (S_IWGRP | S_IWOTH)) != 0) {
    return "can be written by other users";
  }
  file_bytes_ = static_cast<std::uint64_t>(status.st_size);
  return {};
}

// Reads all data before the arrays. Returns why they cannot be used; empty if they can.
std::string CacheEntry::read_head(std::string& key) {
  EntryHeader header;
  if (file_bytes_ < sizeof(header) ||
      !read_entry_bytes(descriptor_, std::as_writable_bytes(std::span(&header, 1)), 0)) {
    return "is truncated";
  }
  if (header.magic != kEntryMagic) return "is not an entry";
  if (header.version != kEntryVersion || header.byte_order != kByteOrder) {
    return "has another version or byte order";
  }
  if (header.key_bytes > kHeadMax || header.text_bytes > kHeadMax) return "is damaged";
  std::uint64_t end = sizeof(header) + header.key_bytes + header.text_bytes;
  for (std::size_t i = 0; i < kArraysMax; ++i) {
    arrays_[i] = {.bytes = header.array_bytes[i], .begin = end, .sum = header.array_sums[i]};
    // Never above the size of the file, so no sum overflows.
    if (end > file_bytes_ || header.array_bytes[i] > file_bytes_ - end) return "is truncated";
    end += header.array_bytes[i];
  }
  if (end != file_bytes_) return "is damaged";
  key.resize(static_cast<std::size_t>(header.key_bytes));
  text_.resize(static_cast<std::size_t>(header.text_bytes));
  if (!read_entry_bytes(descriptor_, std::as_writable_bytes(std::span(key)), sizeof(header)) ||
      !read_entry_bytes(descriptor_, std::as_writable_bytes(std::span(text_)),
                        sizeof(header) + header.key_bytes)) {
    return "cannot be read";
  }
  return entry_sum(header, key, text_) == header.sum ? "" : "is damaged";
}

driver::Result<std::optional<CacheEntry>> CacheEntry::open(const std::filesystem::path& file,
                                                           std::string_view key) {
  CacheEntry entry;
  bool absent = false;
  std::string found;
  std::string problem = entry.open_file(file, absent);
  if (absent) return std::optional<CacheEntry>();
  if (problem.empty()) problem = entry.read_head(found);
  if (problem.empty() && found != key) problem = "belongs to another mesh";
  if (!problem.empty()) return driver::Error{problem};
  return std::optional<CacheEntry>(std::move(entry));
}

std::optional<std::string> CacheEntry::text_of(const std::filesystem::path& file) {
  CacheEntry entry;
  bool absent = false;
  std::string key;
  if (!entry.open_file(file, absent).empty() || !entry.read_head(key).empty()) return {};
  return std::move(entry.text_);
}

bool CacheEntry::read(std::size_t array, std::span<std::byte> to) const noexcept {
  const Array& stored = arrays_[array];
  if (to.size() != stored.bytes) return false;
  std::uint64_t sum = 0, at = stored.begin;
  while (!to.empty()) {
    const auto piece = to.first(std::min(to.size(), kEntryPieceBytes));
    if (!read_entry_bytes(descriptor_, piece, at)) return false;
    // While it is in the cache of the processor.
    sum = render::checksum(piece, sum);
    at += piece.size();
    to = to.subspan(piece.size());
  }
  return sum == stored.sum;
}

void CacheEntry::mark_used() const noexcept {
  // Only the order of removal depends on it.
  [[maybe_unused]] const int set = ::futimens(descriptor_, nullptr);
}

driver::Result<void> CacheEntry::write(const std::filesystem::path& file, std::string_view key,
                                       std::string_view text,
                                       std::span<const std::span<const std::byte>> arrays) {
  static std::atomic<unsigned> parts = 0;
  EntryHeader header;
  header.key_bytes = key.size();
  header.text_bytes = text.size();
  for (std::size_t i = 0; i < arrays.size(); ++i) {
    header.array_bytes[i] = arrays[i].size();
    header.array_sums[i] = entry_sum(arrays[i]);
  }
  header.sum = entry_sum(header, key, text);
  // Each writer has its own part, so that none waits for another.
  const std::filesystem::path part =
      file.string() + fmt::format(".{}-{}.part", ::getpid(), ++parts);
  const int opened =
      ::open(part.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC | O_NOCTTY, 0600);
  if (opened < 0) return entry_not_written(part, errno);
  int failed = append_bytes(opened, std::as_bytes(std::span(&header, 1)));
  if (failed == 0) failed = append_bytes(opened, text_bytes(key));
  if (failed == 0) failed = append_bytes(opened, text_bytes(text));
  for (const auto& array : arrays) {
    if (failed == 0) failed = append_bytes(opened, array);
  }
  // Some file systems report a full disk only on close.
  if (::close(opened) != 0 && failed == 0 && errno != EINTR) failed = errno;
  if (failed == 0 && ::rename(part.c_str(), file.c_str()) != 0) failed = errno;
  if (failed == 0) return {};
  ::unlink(part.c_str());
  return entry_not_written(file, failed);
}

}  // namespace thimble::scene
