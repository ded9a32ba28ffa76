#include "compat/core/arm_listing.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace thimble::compat {
namespace {

/// Mixes a value into a hash [FNV-1a, 64 bits].
std::uint64_t mix(std::uint64_t hash, std::uint64_t value) noexcept {
  constexpr std::uint64_t kPrime = 0x100000001b3;
  for (int byte = 0; byte < 8; ++byte) hash = (hash ^ ((value >> (8 * byte)) & 0xff)) * kPrime;
  return hash;
}

/// Returns the start of this process since the start of the computer; 0 if it is unknown. Process
/// ids are used again; an id and its start are not.
std::uint64_t start_of_process() noexcept {
  std::array<char, 1024> text{};
  const int file = open("/proc/self/stat", O_RDONLY | O_CLOEXEC);
  if (file < 0) return 0;
  const ssize_t size = read(file, text.data(), text.size() - 1);
  close(file);
  // The name in parentheses may contain anything. 19 fields are between it and the start
  // [proc_pid_stat(5)].
  const char* field = size > 0 ? std::strrchr(text.data(), ')') : nullptr;
  for (int skipped = 0; field != nullptr && skipped < 20; ++skipped) {
    field = std::strchr(field + 1, ' ');
  }
  return field == nullptr ? 0 : std::strtoull(field, nullptr, 10);
}

/// Returns the value by which a library of this process claims the list: the process, and in the
/// lowest byte the library. Never 0.
std::uint64_t claim_of(const char* api) noexcept {
  constexpr std::uint64_t kBasis = 0xcbf29ce484222325;
  const std::uint64_t process =
      mix(mix(kBasis, static_cast<std::uint64_t>(getpid())), start_of_process());
  // One library has two interfaces.
  constexpr std::array<std::pair<const char*, std::uint64_t>, 4> kLibraries{
      {{"HDAPI", 2}, {"hdPhantom", 3}, {"DHD", 4}, {"DRD", 4}}};
  std::uint64_t library = 1;
  for (const auto& [name, number] : kLibraries) {
    if (std::strcmp(api, name) == 0) library = number;
  }
  return (process & ~std::uint64_t{0xff}) | library;
}

}  // namespace

bool may_list_arms(Channel& channel, const char* api) noexcept {
  const std::uint64_t own = claim_of(api);
  const auto of_process = [&](std::uint64_t claim) { return ((claim ^ own) >> 8) == 0; };
  for (std::atomic<std::uint64_t>& entry : channel.listings) {
    std::uint64_t claim = entry.load();
    // An entry is never changed again, so the first one of a process is the same for all.
    if (claim == 0 && entry.compare_exchange_strong(claim, own)) return true;
    if (of_process(claim)) return claim == own;
  }
  return true;  // more processes than entries: an arm may be listed twice
}

}  // namespace thimble::compat
