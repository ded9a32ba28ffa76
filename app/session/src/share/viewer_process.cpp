#include "share/viewer_process.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <utility>

namespace thimble::session {

bool has_display() {
  for (const char* name : {"DISPLAY", "WAYLAND_DISPLAY"}) {
    const char* value = std::getenv(name);
    if (value != nullptr && *value != 0) return true;
  }
  return false;
}

driver::Result<std::unique_ptr<ViewerProcess>> ViewerProcess::start(
    const std::string& run, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {"thimble", "view", run});
  std::vector<char*> words;
  for (std::string& argument : arguments) words.push_back(argument.data());
  words.push_back(nullptr);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  // Separate process group: Ctrl-C in the run's terminal ends the run but not the viewer, which
  // reports the end.
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  // The output of the run may go to a pipe, which closes with its last writer. So the viewer must
  // not inherit it.
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t pid = 0;
  const int status =
      posix_spawn(&pid, "/proc/self/exe", &actions, &attributes, words.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  if (status != 0) {
    return driver::Error{"The viewer cannot be started: " + std::string(std::strerror(status)) +
                         "; start it by hand: thimble view " + run};
  }
  return std::unique_ptr<ViewerProcess>(new ViewerProcess(pid));
}

bool ViewerProcess::closed() {
  int status = 0;
  if (alive_ && waitpid(pid_, &status, WNOHANG) == pid_) {
    alive_ = false;
    closed_ = WIFSIGNALED(status) || (WIFEXITED(status) && WEXITSTATUS(status) == 0);
  }
  return closed_;
}

}  // namespace thimble::session
