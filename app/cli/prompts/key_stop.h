#pragma once

#include <termios.h>

#include <atomic>
#include <thread>

namespace thimble::cli {

/// Stops the program by any key while it exists, as Ctrl-C does: for motion that a person watches.
/// It listens only to a terminal in whose foreground the program is. Keys are then not shown and
/// need no Enter; Ctrl-C and its like stay what they are. The terminal is as before when it is
/// gone. Real-time: never from the servo thread.
class KeyStop {
 public:
  KeyStop();
  ~KeyStop();
  KeyStop(const KeyStop&) = delete;
  KeyStop& operator=(const KeyStop&) = delete;

  /// Returns whether there is a terminal that it listens to.
  bool listens() const { return listener_.joinable(); }
  /// Returns whether a key was pressed.
  bool pressed() const { return pressed_.load(); }

 private:
  void listen();

  termios before_{};
  std::atomic<bool> over_{false}, pressed_{false};
  std::thread listener_;
};

/// Returns whether standard input is a terminal in whose foreground this program is.
bool has_terminal();

}  // namespace thimble::cli
