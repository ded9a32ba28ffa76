#include "sleep_lock.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>

namespace thimble::scene {
namespace {

constexpr int kPatience_ms = 2000;

/// A pipe whose ends no other child inherits.
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

/// Starts the holder: it says "held" once it has the lock, and ends with its input.
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
  // A group of its own: Ctrl-C at the terminal ends the run first, and the lock with it. No signal
  // that this process holds back is held back there.
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
    note_ = "The computer is not kept awake: no pipe could be made.";
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
        "The computer is not kept awake during the run: systemd-inhibit is not installed. See that "
        "it does not sleep.";
  } else {
    pollfd answer{.fd = output.read, .events = POLLIN, .revents = 0};
    int ready = 0;
    do {
      ready = poll(&answer, 1, kPatience_ms);
    } while (ready < 0 && errno == EINTR);
    char text[8];
    held_ = ready > 0 && read(output.read, text, sizeof text) > 0;
    if (!held_) {
      note_ =
          "The computer is not kept awake during the run: logind gave no lock against sleep. See "
          "that it does not sleep.";
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
  if (!held_) kill(-child_, SIGTERM);
  while (waitpid(child_, nullptr, 0) < 0 && errno == EINTR) {
  }
  child_ = -1;
}

}  // namespace thimble::scene
