#include "interrupt.h"

#include <cerrno>
#include <csignal>
#include <ctime>

namespace thimble::scene {
namespace {

std::atomic<bool> interrupted{false};
std::atomic<std::int64_t> first_signal_ns{0};  // 0: none yet
std::atomic<int> at_stake{0};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free &&
                  std::atomic<std::int64_t>::is_always_lock_free,
              "A signal handler may not lock.");

constexpr int kSignals[] = {SIGINT,  SIGTERM,   SIGHUP,  SIGQUIT, SIGUSR1, SIGUSR2,  SIGALRM,
                            SIGPROF, SIGVTALRM, SIGXCPU, SIGIO,   SIGPWR,  SIGSTKFLT};

std::int64_t monotonic_ns() noexcept {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);  // POSIX names it as safe in a handler
  return static_cast<std::int64_t>(now.tv_sec) * 1'000'000'000 + now.tv_nsec;
}

// Calls nothing but what POSIX names as safe in a handler: clock_gettime, sigaction, raise.
void on_signal(int number) {
  const int error = errno;
  std::int64_t first_ns = 0;
  const std::int64_t now_ns = monotonic_ns();
  interrupted.store(true);
  if (!first_signal_ns.compare_exchange_strong(first_ns, now_ns) &&
      ends_at_once(now_ns - first_ns, at_stake.load() > 0)) {
    struct sigaction usual {};
    usual.sa_handler = SIG_DFL;
    sigaction(number, &usual, nullptr);
    raise(number);  // takes effect when this handler returns
  }
  errno = error;
}

void install(int number, bool even_if_ignored) {
  struct sigaction before {};
  if (sigaction(number, nullptr, &before) != 0) return;
  const bool ignored = before.sa_handler == SIG_IGN;
  if (ignored ? !even_if_ignored : before.sa_handler != SIG_DFL) return;
  struct sigaction action {};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART;  // nothing that waits for a disk is to fail for a signal
  sigfillset(&action.sa_mask);
  sigaction(number, &action, nullptr);
}

}  // namespace

const std::atomic<bool>& catch_interrupts() {
  // What a script runs beside itself ignores SIGINT and SIGQUIT, and is to leave by them all the
  // same. Whoever started us by nohup wants us to outlive the terminal.
  for (const int number : kSignals) install(number, number != SIGHUP);
  for (int number = SIGRTMIN; number <= SIGRTMAX; ++number) install(number, false);
  return interrupted;
}

bool stop_asked() noexcept {
  return interrupted.load();
}

void leave_rather_than_stop() {
  install(SIGTSTP, true);
  std::signal(SIGTTIN, SIG_IGN);
  std::signal(SIGTTOU, SIG_IGN);
}

LeavingGuard::LeavingGuard() noexcept {
  at_stake.fetch_add(1);
}

LeavingGuard::~LeavingGuard() {
  at_stake.fetch_sub(1);
}

void outlive_trouble_with_files() {
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

void ask_to_stop() noexcept {
  interrupted.store(true);
}

}  // namespace thimble::scene
