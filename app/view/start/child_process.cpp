#include "view/start/child_process.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>

#include "log/printed_text.h"

namespace thimble::view {
namespace {

constexpr std::size_t kMaxText = 65536;         // bytes
constexpr std::chrono::seconds kEndTimeout{5};  // [chosen: a recording is closed within it]

/// Between fork and exec: calls only functions that are safe after a fork. `write_end` is the pipe
/// of the kept output, or -1.
[[noreturn]] void become(const char* program, char* const* words, const ChildChoice& choice,
                         int write_end, pid_t parent) {
  // The process ends with the window, even if the window is killed.
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent) _exit(127);
  // Ctrl-C in the terminal reaches the window, which ends this process.
  setpgid(0, 0);
  const int none = open("/dev/null", O_RDWR | O_CLOEXEC);
  dup2(none, STDIN_FILENO);
  if (choice.quiet) {
    dup2(none, STDOUT_FILENO);
    dup2(none, STDERR_FILENO);
  }
  if (choice.keep_output) dup2(write_end, STDOUT_FILENO);
  if (choice.keep_errors) dup2(write_end, STDERR_FILENO);
  if (choice.nice != 0 && nice(choice.nice) == -1) {
    // Continues at the niceness of the window.
  }
  execv(program, words);
  _exit(127);
}

}  // namespace

driver::Result<std::unique_ptr<ChildProcess>> ChildProcess::start(
    const std::filesystem::path& program, const std::vector<std::string>& arguments,
    const ChildChoice& choice) {
  if (access(program.c_str(), X_OK) != 0) {
    return driver::Error{program.string() + " cannot be started: " + std::strerror(errno) +
                         ". Install the package of this program again."};
  }
  std::vector<std::string> all = arguments;
  all.insert(all.begin(), program.filename().string());
  std::vector<char*> words;
  for (std::string& word : all) words.push_back(word.data());
  words.push_back(nullptr);
  const std::string path = program.string();
  int ends[2] = {-1, -1};
  const bool keeps = choice.keep_output || choice.keep_errors;
  if (keeps && pipe2(ends, O_CLOEXEC | O_NONBLOCK) != 0) {
    return driver::Error{path + " cannot be started: " + std::strerror(errno) + "."};
  }
  // The child writes to a blocking pipe.
  if (keeps) fcntl(ends[1], F_SETFL, fcntl(ends[1], F_GETFL) & ~O_NONBLOCK);
  const pid_t parent = getpid();
  const pid_t pid = fork();
  if (pid == 0) become(path.c_str(), words.data(), choice, ends[1], parent);
  if (ends[1] >= 0) close(ends[1]);
  if (pid < 0) {
    if (ends[0] >= 0) close(ends[0]);
    return driver::Error{path + " cannot be started: " + std::strerror(errno) + "."};
  }
  std::unique_ptr<ChildProcess> child(new ChildProcess);
  child->pid_ = pid;
  child->pipe_ = ends[0];
  child->pass_on_ = choice.keep_errors;
  return child;
}

ChildProcess::~ChildProcess() {
  const auto latest = std::chrono::steady_clock::now() + kEndTimeout;
  if (!ended()) kill(pid_, SIGTERM);
  bool killed = false;
  while (!ended()) {
    if (!killed && std::chrono::steady_clock::now() > latest) {
      kill(pid_, SIGKILL);
      killed = true;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  if (pipe_ >= 0) close(pipe_);
}

void ChildProcess::read_text() {
  if (pipe_ < 0) return;
  char bytes[4096];
  for (;;) {
    const ssize_t count = read(pipe_, bytes, sizeof bytes);
    if (count <= 0) return;
    const std::string part(bytes, static_cast<std::size_t>(count));
    text_ += part;
    if (text_.size() > kMaxText) text_.erase(0, text_.size() - kMaxText);
    if (pass_on_) scene::write_text(stderr, part);
  }
}

std::optional<int> ChildProcess::ended() {
  read_text();
  int status = 0;
  if (!code_ && waitpid(pid_, &status, WNOHANG) == pid_) {
    code_ = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
    read_text();
  }
  return code_;
}

}  // namespace thimble::view
