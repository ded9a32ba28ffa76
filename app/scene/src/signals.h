#pragma once

#include <atomic>
#include <cstdint>

#include "thimble/driver/export.h"

namespace thimble::scene {

// Exit of the program on a signal. Every catchable signal that ends a program is a request to exit
// with zero force and to finish the recording: SIGINT, SIGTERM, SIGHUP (not under nohup), SIGQUIT,
// SIGUSR1, SIGUSR2, SIGALRM, SIGVTALRM, SIGPROF, SIGXCPU, SIGIO, SIGPWR, SIGSTKFLT and the
// real-time signals. Signals of a crash (SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTRAP, SIGSYS)
// and SIGKILL end the program as usual. No code can be trusted to send zero force then, so only the
// arm's own watchdog remains.

/// Signals within this time are one request: a closing terminal sends several, and a held Ctrl-C
/// repeats. [chosen: longer than a double press, shorter than a user waits]
inline constexpr std::int64_t kOneRequest_ns = 500'000'000;
/// Largest time of the exit while an arm or a recording is at stake. After it the program counts as
/// blocked, and a further signal ends it. [chosen: 2000 ticks to send one zero force, and a disk
/// that pauses for a second]
inline constexpr std::int64_t kExitTimeMax_ns = 2'000'000'000;

/// Time within which SIGTERM ends a program that neither drives an arm nor writes a recording or a
/// report, even if it is blocked. [chosen: half of the time before a container's host sends
/// SIGKILL]
inline constexpr std::int64_t kBlockedTimeMax_ns = 5'000'000'000;

/// Returns whether a further signal ends the program at once, `since_first_ns` after the first one.
/// `at_stake`: an arm may hold a force, or a recording is not closed. Real-time: safe.
constexpr bool ends_at_once(std::int64_t since_first_ns, bool at_stake) noexcept {
  return since_first_ns >= (at_stake ? kExitTimeMax_ns : kOneRequest_ns);
}

/// Makes each of the signals above set a flag that every loop checks in each tick. Handlers other
/// than the default are kept. A program that still runs kBlockedTimeMax_ns after SIGTERM, without a
/// ForceExitGuard or WritingGuard, counts as blocked and is ended. Returns the flag. Real-time:
/// never from the servo thread.
THIMBLE_EXPORT const std::atomic<bool>& catch_interrupts();

/// Returns whether such a signal arrived or `ask_to_stop` was called; for lengthy operations while
/// an arm is opened. Real-time: safe.
THIMBLE_EXPORT bool stop_asked() noexcept;

/// Treats Ctrl-Z (SIGTSTP) as such a signal too. A background job that reads or writes its terminal
/// gets an error instead of being stopped, because a stopped program cannot send zero force. For
/// callers that open a real arm. Real-time: never from the servo thread.
THIMBLE_EXPORT void treat_sigtstp_as_exit();

/// Marks the time in which an arm may hold a force, or a recording is not closed. During its
/// lifetime further signals do not end the program at once (`ends_at_once`). Construct it before
/// the arm is opened; destroy it after zero force was sent. Real-time: safe.
class THIMBLE_EXPORT ForceExitGuard {
 public:
  ForceExitGuard() noexcept;
  ~ForceExitGuard();
  ForceExitGuard(const ForceExitGuard&) = delete;
  ForceExitGuard& operator=(const ForceExitGuard&) = delete;
};

/// Marks the time in which results are written after a run: a single SIGTERM does not interrupt it;
/// a second one ends the program. Real-time: safe.
class THIMBLE_EXPORT WritingGuard {
 public:
  WritingGuard() noexcept;
  ~WritingGuard();
  WritingGuard(const WritingGuard&) = delete;
  WritingGuard& operator=(const WritingGuard&) = delete;
};

/// Ignores SIGPIPE and SIGXFSZ so that failed writes return an error instead of ending the process,
/// which would leave the arm to its own watchdog. Real-time: never from the servo thread.
THIMBLE_EXPORT void ignore_sigpipe_and_sigxfsz();

/// Sets the flag, as a first Ctrl-C does. Real-time: safe.
THIMBLE_EXPORT void ask_to_stop() noexcept;

}  // namespace thimble::scene
