#include "share/bus_guard.h"

#include <signal.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <mutex>

namespace thimble::session {
namespace {

struct Guarded {
  std::atomic<std::uintptr_t> begin{0};
  std::atomic<std::uintptr_t> end{0};  // 0: unused
  std::atomic<bool> broken{false};
};
static_assert(std::atomic<std::uintptr_t>::is_always_lock_free,
              "Atomics in a signal handler must be lock-free.");

std::array<Guarded, BusGuard::kMax> guarded;
std::uintptr_t page_size = 4096;

/// Replaces a missing page by a page of zeros. mmap is a plain system call, so it is safe in a
/// signal handler [libwayland does the same for its buffers].
void on_bus_error(int number, siginfo_t* info, void*) {
  const auto address = reinterpret_cast<std::uintptr_t>(info->si_addr);
  for (Guarded& one : guarded) {
    if (address < one.begin.load() || address >= one.end.load()) continue;
    auto* page = static_cast<std::byte*>(info->si_addr) - address % page_size;
    if (mmap(page, page_size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED, -1,
             0) == MAP_FAILED) {
      break;
    }
    one.broken.store(true);
    return;
  }
  signal(number, SIG_DFL);  // the access fails again and ends the process
}

void install() {
  static std::once_flag once;
  std::call_once(once, [] {
    page_size = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
    struct sigaction action {};
    action.sa_sigaction = on_bus_error;
    action.sa_flags = SA_SIGINFO;
    sigemptyset(&action.sa_mask);
    sigaction(SIGBUS, &action, nullptr);
  });
}

std::mutex places;

}  // namespace

BusGuard::BusGuard(std::span<std::byte> memory) {
  install();
  const std::lock_guard lock(places);
  for (std::size_t i = 0; i < kMax; ++i) {
    if (guarded[i].end.load() != 0) continue;
    slot_ = i;
    const auto begin = reinterpret_cast<std::uintptr_t>(memory.data());
    guarded[i].broken.store(false);
    guarded[i].begin.store(begin);
    guarded[i].end.store((begin + memory.size() + page_size - 1) / page_size * page_size);
    return;
  }
}

BusGuard::~BusGuard() {
  const std::lock_guard lock(places);
  if (slot_ < kMax) guarded[slot_].end.store(0);
}

bool BusGuard::broken() const noexcept {
  return slot_ < kMax && guarded[slot_].broken.load();
}

}  // namespace thimble::session
