#include "signals.h"

#include <cerrno>
#include <csignal>
#include <ctime>

namespace thimble::scene {
namespace {

std::atomic<bool> interrupted{false};
std::atomic<std::int64_t> first_signal_ns{0};  // 0: no signal yet
std::atomic<int> at_stake{0};
std::atomic<int> writing{0};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free &&
                  std::atomic<std::int64_t>::is_always_lock_free,
              "A signal handler must not use locks.");

constexpr int kSignals[] = {SIGINT,  SIGTERM,   SIGHUP,  SIGQUIT, SIGUSR1, SIGUSR2,  SIGALRM,
                            SIGPROF, SIGVTALRM, SIGXCPU, SIGIO,   SIGPWR,  SIGSTKFLT};

std::int64_t monotonic_ns() noexcept {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);  // async-signal-safe (POSIX)
  return static_cast<std::int64_t>(now.tv_sec) * 1'000'000'000 + now.tv_nsec;
}

timer_t hang_timer{};
std::atomic<bool> has_hang_timer{false};

/// Starts the timer, which sends SIGTERM to this process once after the given time.
void repeat_sigterm_after(std::int64_t time_ns) noexcept {
  if (!has_hang_timer.load()) return;
  const itimerspec once{
      .it_interval = {},
      .it_value = {.tv_sec = time_ns / 1'000'000'000, .tv_nsec = time_ns % 1'000'000'000}};
  timer_settime(hang_timer, 0, &once, nullptr);
}

void end_by(int number) noexcept {
  struct sigaction usual {};
  usual.sa_handler = SIG_DFL;
  sigaction(number, &usual, nullptr);
  raise(number);  // delivered when the handler returns
}

// Calls only functions that are async-signal-safe (POSIX): clock_gettime, sigaction, raise,
// timer_settime.
void on_signal(int number, siginfo_t* info, void*) {
  const int error = errno;
  const bool reminder = info != nullptr && info->si_code == SI_TIMER &&
                        info->si_value.sival_ptr == static_cast<void*>(&hang_timer);
  std::int64_t first_ns = 0;
  const std::int64_t now_ns = monotonic_ns();
  if (reminder) {
    // A process that holds an arm or writes results is never ended by the timer, only by a person.
    if (at_stake.load() > 0 || writing.load() > 0) {
      repeat_sigterm_after(kOneRequest_ns);
    } else {
      end_by(number);
    }
  } else {
    interrupted.store(true);
    if (!first_signal_ns.compare_exchange_strong(first_ns, now_ns) &&
        ends_at_once(now_ns - first_ns, at_stake.load() > 0)) {
      end_by(number);
    } else if (number == SIGTERM) {
      repeat_sigterm_after(kBlockedTimeMax_ns);
    }
  }
  errno = error;
}

/// Creates the timer of this process, if it does not exist. A child process does not inherit it.
void make_hang_timer() {
  if (has_hang_timer.load()) return;
  sigevent event{};
  event.sigev_notify = SIGEV_SIGNAL;
  event.sigev_signo = SIGTERM;
  event.sigev_value.sival_ptr = &hang_timer;
  has_hang_timer.store(timer_create(CLOCK_MONOTONIC, &event, &hang_timer) == 0);
}

void install(int number, bool even_if_ignored) {
  struct sigaction before {};
  if (sigaction(number, nullptr, &before) != 0) return;
  const bool ignored = before.sa_handler == SIG_IGN;
  if (ignored ? !even_if_ignored : before.sa_handler != SIG_DFL) return;
  struct sigaction action {};
  action.sa_sigaction = on_signal;
  // With SA_RESTART, a signal does not interrupt system calls that wait for a disk.
  action.sa_flags = SA_RESTART | SA_SIGINFO;
  sigfillset(&action.sa_mask);
  sigaction(number, &action, nullptr);
}

}  // namespace

const std::atomic<bool>& catch_interrupts() {
  make_hang_timer();
  // A background process of a shell script ignores SIGINT and SIGQUIT, but must end on them too.
  // SIGHUP stays ignored under nohup, because the process should then survive the terminal.
  for (const int number : kSignals) install(number, number != SIGHUP);
  for (int number = SIGRTMIN; number <= SIGRTMAX; ++number) install(number, false);
  return interrupted;
}

bool stop_asked() noexcept {
  return interrupted.load();
}

void treat_sigtstp_as_exit() {
  install(SIGTSTP, true);
  std::signal(SIGTTIN, SIG_IGN);
  std::signal(SIGTTOU, SIG_IGN);
}

ForceExitGuard::ForceExitGuard() noexcept {
  at_stake.fetch_add(1);
}

ForceExitGuard::~ForceExitGuard() {
  at_stake.fetch_sub(1);
}

WritingGuard::WritingGuard() noexcept {
  writing.fetch_add(1);
}

WritingGuard::~WritingGuard() {
  writing.fetch_sub(1);
}

void ignore_sigpipe_and_sigxfsz() {
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

void ask_to_stop() noexcept {
  interrupted.store(true);
}

}  // namespace thimble::scene
