#include "sleep_lock.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <ctime>

namespace thimble::scene {
namespace {

constexpr int kAnswerTimeout_ms = 2000;

/// Pipe whose ends are not inherited by other child processes.
struct Pipe {
  int read = -1, write = -1;
  Pipe() {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) == 0) read = ends[0], write = ends[1];
  }
  void close_all() const {
    if (read >= 0) close(read);
    if (write >= 0) close(write);
  }
};

/// Starts the child process that holds the lock. It prints "held" when it has the lock, and exits
/// when its input is closed.
pid_t start(const Pipe& input, const Pipe& output) {
  const char* const arguments[] = {"systemd-inhibit",
                                   "--what=sleep:idle:handle-lid-switch",
                                   "--mode=block",
                                   "--who=thimble",
                                   "--why=A person holds a haptic arm",
                                   "sh",
                                   "-c",
                                   "echo held; exec cat >/dev/null",
                                   nullptr};
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, input.read, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&files, output.write, STDOUT_FILENO);
  posix_spawn_file_actions_addopen(&files, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  // The child has its own process group: Ctrl-C in the terminal ends the run first, which then
  // releases the lock. Signals that this process blocks are not blocked in the child.
  sigset_t none, all;
  sigemptyset(&none);
  sigfillset(&all);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &all);
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setflags(&attributes,
                           POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  pid_t child = -1;
  const int status = posix_spawnp(&child, arguments[0], &files, &attributes,
                                  const_cast<char* const*>(arguments), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  return status == 0 ? child : -1;
}

}  // namespace

SleepLock::SleepLock() {
  const Pipe input, output;
  if (input.write < 0 || output.write < 0) {
    note_ = "Cannot keep the computer awake: no pipe could be created.";
    input.close_all();
    output.close_all();
    return;
  }
  child_ = start(input, output);
  close(input.read);
  close(output.write);
  input_ = input.write;
  if (child_ < 0) {
    note_ =
        "Cannot keep the computer awake during the run: systemd-inhibit is not installed. Make "
        "sure that it does not sleep.";
  } else {
    pollfd answer{.fd = output.read, .events = POLLIN, .revents = 0};
    int ready = 0;
    do {
      ready = poll(&answer, 1, kAnswerTimeout_ms);
    } while (ready < 0 && errno == EINTR);
    char text[8];
    held_ = ready > 0 && read(output.read, text, sizeof text) > 0;
    if (!held_) {
      note_ =
          "Cannot keep the computer awake during the run: logind gave no lock against sleep. Make "
          "sure that it does not sleep.";
    }
  }
  close(output.read);
  if (!held_) end();
}

SleepLock::~SleepLock() {
  end();
}

void SleepLock::end() noexcept {
  if (input_ >= 0) close(input_);
  input_ = -1;
  if (child_ < 0) return;
  // The child exits when its input is closed. If it does not, it is killed, because it does nothing
  // else.
  constexpr int kChecksMax = 100;
  constexpr timespec kCheckPeriod{.tv_sec = 0, .tv_nsec = 10'000'000};
  if (!held_) kill(-child_, SIGTERM);
  for (int look = 0; waitpid(child_, nullptr, WNOHANG) == 0; ++look) {
    if (look == kChecksMax) kill(-child_, SIGKILL);
    nanosleep(&kCheckPeriod, nullptr);
  }
  child_ = -1;
}

}  // namespace thimble::scene
