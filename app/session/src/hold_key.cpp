#include "hold_key.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <string_view>

#include "setup.h"
#include "share/shared_run.h"
#include "thimble/session/session.h"

namespace thimble::session {

driver::Result<driver::HoldToRun> hold_named(const std::string& name) {
  driver::HoldToRun hold;
  if (name.empty()) return hold;
  if (name == "key") {
    hold.by_caller = true;
    return hold;
  }
  constexpr int kButtons = 16;
  for (int button = 1; button <= kButtons; ++button) {
    if (name != "button" + std::to_string(button) && !(button == 1 && name == "button")) continue;
    hold.buttons = static_cast<std::uint16_t>(1U << (button - 1));
    return hold;
  }
  return driver::Error{"The enabling input must be button, button2 to button16, or key; found \"" +
                       name + "\"."};
}

driver::Result<void> HoldKey::check() {
  termios now{};
  if (isatty(STDIN_FILENO) != 0 && tcgetattr(STDIN_FILENO, &now) == 0) return {};
  return driver::Error{
      "--hold-to-run key requires a terminal to read the space bar. Use a button of the arm "
      "instead: --hold-to-run button."};
}

HoldKey::HoldKey(Session& session) : session_(session) {
  tcgetattr(STDIN_FILENO, &before_);
  termios keys = before_;
  // Ctrl-C and Ctrl-Z keep their effect.
  keys.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  keys.c_cc[VMIN] = 1;
  keys.c_cc[VTIME] = 0;
  tcsetattr(STDIN_FILENO, TCSANOW, &keys);
  thread_ = std::thread([this] { watch(); });
}

HoldKey::~HoldKey() {
  stop_.store(true);
  thread_.join();
  tcsetattr(STDIN_FILENO, TCSAFLUSH, &before_);
}

Terminal HoldKey::terminal() {
  Terminal terminal = user_terminal();
  terminal.key = [this] {
    if (enter_.exchange(false)) return EnterKey::kPressed;
    return closed_.load() ? EnterKey::kClosed : EnterKey::kNothing;
  };
  return terminal;
}

void HoldKey::read_terminal(HeldKey& key) {
  char text[64];
  const ssize_t count = read(STDIN_FILENO, text, sizeof text);
  if (count <= 0) {
    closed_.store(true);
    return;
  }
  const std::string_view keys(text, static_cast<std::size_t>(count));
  if (keys.find('\n') != std::string_view::npos) enter_.store(true);
  // All bytes of one read count as one press, so that pasted text does not count as a held key.
  if (keys.find(' ') != std::string_view::npos) key.press(session_.setup().clock().now_ns());
}

void HoldKey::watch() {
  constexpr int kPoll_ms = 5;
  const driver::Clock& clock = session_.setup().clock();
  const SharedRun* const shared = session_.shared();
  HeldKey key;
  ViewerKey viewer(shared != nullptr ? shared->key_held() : 0);
  std::int64_t until_ns = clock.now_ns();
  while (!stop_.load()) {
    pollfd terminal{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
    if (closed_.load()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(kPoll_ms));
    } else if (poll(&terminal, 1, kPoll_ms) > 0) {
      read_terminal(key);
    }
    if (shared != nullptr) viewer.update(shared->key_held(), clock.now_ns());
    const std::int64_t until = std::max(key.until_ns(), viewer.until_ns());
    if (until <= until_ns || until <= clock.now_ns()) continue;
    until_ns = until;
    for (std::size_t arm = 0; arm < session_.arms(); ++arm) {
      session_.device(arm).hold_until(until_ns);
    }
  }
}

}  // namespace thimble::session
