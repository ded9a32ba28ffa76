#include "signals.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <ctime>
#include <functional>

namespace thimble::session {
namespace {

constexpr std::int64_t kMs = 1'000'000;
// The thread sanitizer delivers a signal only when a call that it intercepts returns.
#if defined(__SANITIZE_THREAD__)
constexpr bool kSignalsAreDelayed = true;
#else
constexpr bool kSignalsAreDelayed = false;
#endif

TEST(Interrupt, SignalsWithinHalfASecondAreOneRequest) {
  for (const std::int64_t since_ms : {0, 1, 10, 100, 499}) {
    EXPECT_FALSE(scene::ends_at_once(since_ms * kMs, false)) << since_ms;
    EXPECT_FALSE(scene::ends_at_once(since_ms * kMs, true)) << since_ms;
  }
}

TEST(Interrupt, SecondSignalEndsAHungProgram) {
  EXPECT_TRUE(scene::ends_at_once(500 * kMs, false));
  EXPECT_FALSE(scene::ends_at_once(500 * kMs, true));
  EXPECT_FALSE(scene::ends_at_once(1999 * kMs, true));
  EXPECT_TRUE(scene::ends_at_once(2000 * kMs, true));
}

/// Runs `body` in a separate process. Returns its exit code, 0 to 99, or 100 + n if signal n ended
/// it.
int outcome_of(const std::function<void()>& body) {
  const pid_t child = fork();
  if (child == 0) {
    body();
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFSIGNALED(status) ? 100 + WTERMSIG(status) : WEXITSTATUS(status);
}

void rest(std::int64_t time_ns) {
  timespec left{.tv_sec = time_ns / 1'000'000'000, .tv_nsec = time_ns % 1'000'000'000};
  while (nanosleep(&left, &left) != 0) {
  }
}

TEST(Interrupt, EveryCatchableSignalSetsTheFlag) {
  for (int number = 1; number <= SIGRTMAX; ++number) {
    switch (number) {
      case SIGKILL:
      case SIGSTOP:  // cannot be caught
      case SIGSEGV:
      case SIGBUS:
      case SIGFPE:
      case SIGILL:
      case SIGABRT:
      case SIGTRAP:
      case SIGSYS:  // signals of a crash
      case SIGPIPE:
      case SIGXFSZ:  // reported as write errors
      case SIGCHLD:
      case SIGCONT:
      case SIGURG:
      case SIGWINCH:  // do not end the process
      case SIGTSTP:
      case SIGTTIN:
      case SIGTTOU:  // stop
        continue;
      default:
        break;
    }
    if (number >= 32 && number < SIGRTMIN) continue;  // used by the C library
    EXPECT_EQ(outcome_of([number] {
                std::signal(number, SIG_DFL);
                const auto& flag = scene::catch_interrupts();
                raise(number);
                _exit(flag.load() && scene::stop_asked() ? 7 : 8);
              }),
              7)
        << "signal " << number;
  }
}

TEST(Interrupt, SurvivesHangupUnderNohup) {
  EXPECT_EQ(outcome_of([] {
              std::signal(SIGHUP, SIG_IGN);
              const auto& flag = scene::catch_interrupts();
              raise(SIGHUP);
              _exit(flag.load() ? 8 : 7);
            }),
            7);
  EXPECT_EQ(outcome_of([] {
              std::signal(SIGUSR1, [](int) { _exit(7); });
              scene::catch_interrupts();
              raise(SIGUSR1);
            }),
            7);
  // A background job of a script starts with these signals ignored, but must still end by them.
  EXPECT_EQ(outcome_of([] {
              std::signal(SIGINT, SIG_IGN);
              const auto& flag = scene::catch_interrupts();
              raise(SIGINT);
              _exit(flag.load() ? 7 : 8);
            }),
            7);
}

TEST(Interrupt, SignalBurstDoesNotAbandonTheArm) {
  EXPECT_EQ(outcome_of([] {
              scene::catch_interrupts();
              const scene::ForceExitGuard guard;
              for (int i = 0; i < 1000; ++i) raise(i % 2 == 0 ? SIGINT : SIGTERM);
            }),
            0);
  EXPECT_EQ(outcome_of([] {
              scene::catch_interrupts();
              const scene::ForceExitGuard guard;
              raise(SIGINT);
              rest(scene::kExitTimeMax_ns + kMs);
              raise(SIGTERM);
            }),
            100 + SIGTERM);
  EXPECT_EQ(outcome_of([] {
              scene::catch_interrupts();
              { const scene::ForceExitGuard guard; }
              raise(SIGINT);
              rest(scene::kOneRequest_ns + kMs);
              raise(SIGINT);
            }),
            100 + SIGINT);
}

TEST(Interrupt, SigtermEndsProgramThatHangs) {
  EXPECT_EQ(outcome_of([] {
              alarm(60);
              scene::catch_interrupts();
              std::signal(SIGALRM, SIG_DFL);
              int ends[2];
              char byte = 0;
              if (pipe(ends) != 0) _exit(9);
              raise(SIGTERM);
              while (kSignalsAreDelayed) rest(10 * kMs);
              while (read(ends[0], &byte, 1) != 1) {  // there is no writer
              }
            }),
            100 + SIGTERM);
}

TEST(Interrupt, SigtermIsNotRepeatedWhileAnArmIsOpen) {
  EXPECT_EQ(outcome_of([] {
              scene::catch_interrupts();
              const scene::ForceExitGuard guard;
              raise(SIGTERM);
              rest(scene::kBlockedTimeMax_ns + scene::kOneRequest_ns);
              _exit(7);
            }),
            7);
}

TEST(Interrupt, CtrlZEndsTheProgramWhileAnArmIsOpen) {
  EXPECT_EQ(outcome_of([] {
              const auto& flag = scene::catch_interrupts();
              scene::treat_sigtstp_as_exit();
              raise(SIGTSTP);
              raise(SIGTTIN);
              raise(SIGTTOU);
              _exit(flag.load() ? 7 : 8);
            }),
            7);
}

}  // namespace
}  // namespace thimble::session
