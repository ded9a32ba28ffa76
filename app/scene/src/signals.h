#pragma once

#include <atomic>
#include <cstdint>

#include "thimble/driver/export.h"

namespace thimble::scene {

// How the program leaves when it is told to by a signal. Every signal that ends a program and can
// be caught is a request to leave by zero force and to finish the recording: SIGINT, SIGTERM,
// SIGHUP (not under nohup), SIGQUIT, SIGUSR1, SIGUSR2, SIGALRM, SIGVTALRM, SIGPROF, SIGXCPU, SIGIO,
// SIGPWR, SIGSTKFLT and the real-time signals. Signals of a crash (SIGSEGV, SIGBUS, SIGFPE, SIGILL,
// SIGABRT, SIGTRAP, SIGSYS) and SIGKILL end it as they always do: nothing can be trusted to send a
// zero then, so what is left is the arm's own watchdog.

/// Several signals within this time are one request: a closing terminal sends several, and a
/// finger on Ctrl-C repeats. [chosen: longer than a double press, shorter than patience]
inline constexpr std::int64_t kOneRequest_ns = 500'000'000;
/// The time that leaving may take while an arm or a recording is at stake. After it a further
/// signal ends the program, which then hangs. [chosen: 2000 ticks to send one zero, and a disk that
/// pauses for a second]
inline constexpr std::int64_t kLeavingMost_ns = 2'000'000'000;

/// The time within which SIGTERM ends a program that neither drives an arm nor writes a recording
/// or a report, whatever it waits for. [chosen: half of what a container's host waits before
/// SIGKILL]
inline constexpr std::int64_t kHangingMost_ns = 5'000'000'000;

/// Returns whether a further signal ends the program at once, `since_first_ns` after the first one.
/// `at_stake`: an arm may hold a force, or a recording is not closed. Real-time: safe.
constexpr bool ends_at_once(std::int64_t since_first_ns, bool at_stake) noexcept {
  return since_first_ns >= (at_stake ? kLeavingMost_ns : kOneRequest_ns);
}

/// Makes each of the signals above set a flag that every loop looks at in each tick. A handler that
/// is not the default stays. A program that still runs kHangingMost_ns after SIGTERM, with no
/// LeavingGuard or WritingGuard alive, is ended by it: it hangs. Returns the flag. Real-time: never
/// from the servo thread.
THIMBLE_EXPORT const std::atomic<bool>& catch_interrupts();

/// Returns whether such a signal came, or `ask_to_stop` was called: for what takes its time while
/// an arm is opened. Real-time: safe.
THIMBLE_EXPORT bool stop_asked() noexcept;

/// Makes Ctrl-Z (SIGTSTP) such a signal too, and lets a background job that reads or writes its
/// terminal get an error instead of being stopped: a program that is stopped sends no zero.
/// For whoever opens a real arm. Real-time: never from the servo thread.
THIMBLE_EXPORT void leave_rather_than_stop();

/// The time in which an arm may hold a force, or a recording is not closed: from its construction
/// to its destruction further signals are not obeyed at once (`ends_at_once`). Construct it before
/// the arm is opened; destroy it after zero force was sent. Real-time: safe.
class THIMBLE_EXPORT LeavingGuard {
 public:
  LeavingGuard() noexcept;
  ~LeavingGuard();
  LeavingGuard(const LeavingGuard&) = delete;
  LeavingGuard& operator=(const LeavingGuard&) = delete;
};

/// The time in which results are written after a run: a single SIGTERM does not cut it off, a
/// second one ends the program. Real-time: safe.
class THIMBLE_EXPORT WritingGuard {
 public:
  WritingGuard() noexcept;
  ~WritingGuard();
  WritingGuard(const WritingGuard&) = delete;
  WritingGuard& operator=(const WritingGuard&) = delete;
};

/// Lets a reader of our output that is gone, and a file that may not grow, be errors of the write
/// that meets them: a process that dies of them leaves the arm to its own watchdog. Real-time:
/// never from the servo thread.
THIMBLE_EXPORT void outlive_trouble_with_files();

/// Sets that flag as a first Ctrl-C would. Real-time: safe.
THIMBLE_EXPORT void ask_to_stop() noexcept;

}  // namespace thimble::scene
