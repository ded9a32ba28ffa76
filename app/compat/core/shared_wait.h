#pragma once

#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <climits>
#include <cstdint>
#include <ctime>

namespace thimble::compat {

// Waiting on a word of memory shared by processes: std::atomic::wait works only within one process.

/// Waits until `word` differs from `old`, its waiters are woken, or the timeout has expired.
/// Real-time: never from the servo thread.
template <class Word>
void wait_while(const std::atomic<Word>& word, Word old, std::int64_t timeout_ns) noexcept {
  static_assert(sizeof(Word) == 4 && std::atomic<Word>::is_always_lock_free);
  const timespec timeout{timeout_ns / 1'000'000'000, timeout_ns % 1'000'000'000};
  syscall(SYS_futex, &word, FUTEX_WAIT, static_cast<std::uint32_t>(old), &timeout, nullptr, 0);
}

/// Wakes all waiters of `word`. Real-time: safe; one system call that does not wait.
template <class Word>
void wake_all(const std::atomic<Word>& word) noexcept {
  static_assert(sizeof(Word) == 4);
  syscall(SYS_futex, &word, FUTEX_WAKE, INT_MAX, nullptr, nullptr, 0);
}

}  // namespace thimble::compat
