#include "cli/prompts/key_stop.h"

#include <poll.h>
#include <unistd.h>

#include "signals.h"

namespace thimble::cli {
namespace {

constexpr int kPollTime_ms = 20;  // [chosen: too short to be noticed]

}  // namespace

bool has_terminal() {
  // A background process that accesses the terminal would be stopped.
  return isatty(STDIN_FILENO) == 1 && tcgetpgrp(STDIN_FILENO) == getpgrp();
}

KeyStop::KeyStop() {
  if (!has_terminal() || tcgetattr(STDIN_FILENO, &before_) != 0) return;
  termios keys = before_;
  keys.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  keys.c_cc[VMIN] = 1;
  keys.c_cc[VTIME] = 0;
  // Discards keys typed before.
  if (tcsetattr(STDIN_FILENO, TCSAFLUSH, &keys) != 0) return;
  listener_ = std::thread([this] { listen(); });
}

KeyStop::~KeyStop() {
  if (!listens()) return;
  over_.store(true);
  listener_.join();
  if (has_terminal()) tcsetattr(STDIN_FILENO, TCSANOW, &before_);
}

void KeyStop::listen() {
  while (!over_.load()) {
    pollfd terminal{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
    if (poll(&terminal, 1, kPollTime_ms) <= 0 || !has_terminal()) continue;
    char key = 0;
    // A closed terminal stops the program too, because no key can stop it any more.
    pressed_.store(read(STDIN_FILENO, &key, 1) == 1);
    scene::ask_to_stop();
    return;
  }
}

}  // namespace thimble::cli
