#include "meshes/cache/cache_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <span>
#include <system_error>

#include "disk_paging/checksum.h"
#include "log/logger.h"
#include "meshes/cache/cache_entry.h"
#include "meshes/cache/entry_text.h"
#include "user_folders.h"

namespace thimble::scene {
namespace {

namespace fs = std::filesystem;

constexpr const char* kCacheVariable = "THIMBLE_MESH_CACHE";
constexpr std::string_view kEntryEnding = ".prepared";
constexpr std::string_view kPartEnding = ".part";
constexpr std::size_t kNameDigits = 32;
// A part that is older was left by a writer that was killed. [chosen: writing takes seconds]
constexpr std::chrono::hours kPartAgeMax{1};

/// Returns whether a file name begins as that of an entry.
bool is_named(std::string_view name) {
  return name.size() >= kNameDigits + kEntryEnding.size() &&
         std::all_of(name.begin(), name.begin() + kNameDigits,
                     [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); }) &&
         name.substr(kNameDigits, kEntryEnding.size()) == kEntryEnding;
}

/// Calls `take(entry, is_part)` for each entry and each part of one.
template <class Take>
void for_each_entry(const fs::path& folder, const Take& take) {
  std::error_code status;
  for (fs::directory_iterator at(folder, status), end; !status && at != end; at.increment(status)) {
    const std::string name = at->path().filename().string();
    const bool whole = name.size() == kNameDigits + kEntryEnding.size();
    if (!is_named(name) || (!whole && !name.ends_with(kPartEnding))) continue;
    // Another process may remove a file meanwhile.
    std::error_code gone;
    if (at->symlink_status(gone).type() != fs::file_type::regular || gone) continue;
    EntryFile entry{.file = at->path(), .bytes = at->file_size(gone), .used = {}};
    if (!gone) entry.used = at->last_write_time(gone);
    if (!gone) take(entry, !whole);
  }
}

}  // namespace

fs::path default_mesh_cache() {
  return cache_folder() / "prepared";
}

std::optional<fs::path> mesh_cache_of_environment() {
  const char* const value = std::getenv(kCacheVariable);
  if (value == nullptr || *value == 0 || std::string_view(value) == "0") return {};
  if (std::string_view(value) == "1") return default_mesh_cache();
  if (fs::path folder = value; folder.is_absolute()) return folder;
  logger().warn("{}={}: expected 0, 1 or an absolute path. It is ignored.", kCacheVariable, value);
  return {};
}

fs::path chosen_mesh_cache() {
  return mesh_cache_of_environment().value_or(default_mesh_cache());
}

fs::path entry_file(const fs::path& folder, std::string_view key) {
  const auto bytes = std::as_bytes(std::span(key));
  return folder / (fmt::format("{:016x}{:016x}", render::checksum(bytes, 0),
                               render::checksum(bytes, ~std::uint64_t{0})) +
                   std::string(kEntryEnding));
}

driver::Result<void> make_cache_folder(const fs::path& folder) {
  std::error_code failed;
  if (fs::create_directories(folder, failed)) {
    fs::permissions(folder, fs::perms::owner_all, failed);
  }
  if (failed) {
    return driver::Error{
        fmt::format("{} cannot be created ({})", folder.string(), failed.message())};
  }
  return {};
}

driver::Result<void> check_cache_folder(const fs::path& folder) {
  std::error_code status;
  if (!fs::exists(folder, status) && !status) return {};
  if (!status) fs::directory_iterator(folder, status);
  if (!status) return {};
  return driver::Error{
      fmt::format("{} cannot be read ({}). Set THIMBLE_MESH_CACHE to a folder "
                  "of this user.",
                  folder.string(), status.message())};
}

std::vector<EntryFile> cache_entries(const fs::path& folder) {
  std::vector<EntryFile> entries;
  for_each_entry(folder, [&entries](const EntryFile& entry, bool is_part) {
    if (!is_part) entries.push_back(entry);
  });
  std::sort(entries.begin(), entries.end(), [](const EntryFile& a, const EntryFile& b) {
    return a.used != b.used ? a.used > b.used : a.file < b.file;
  });
  return entries;
}

std::string describe_entry(const fs::path& file) {
  const auto text = CacheEntry::text_of(file);
  return text ? EntryReader(*text).text() : std::string();
}

void limit_cache(const fs::path& folder, std::uint64_t bytes_max) {
  const auto oldest_part = fs::file_time_type::clock::now() - kPartAgeMax;
  for_each_entry(folder, [&](const EntryFile& entry, bool is_part) {
    std::error_code gone;
    if (is_part && (entry.used < oldest_part || bytes_max == 0)) fs::remove(entry.file, gone);
  });
  std::uint64_t bytes = 0;
  for (const EntryFile& entry : cache_entries(folder)) {
    bytes += entry.bytes;
    std::error_code gone;
    if (bytes > bytes_max) fs::remove(entry.file, gone);
  }
}

}  // namespace thimble::scene
