#pragma once

#include <termios.h>

#include <atomic>
#include <thread>

namespace thimble::cli {

/// Makes any key stop the program while this object exists, as Ctrl-C does, for motion that a
/// person watches. It listens only if the program is in the foreground of a terminal. Keys are not
/// echoed and need no Enter; Ctrl-C and similar keys are unchanged. The destructor restores the
/// terminal. Real-time: never from the servo thread.
class KeyStop {
 public:
  KeyStop();
  ~KeyStop();
  KeyStop(const KeyStop&) = delete;
  KeyStop& operator=(const KeyStop&) = delete;

  /// Returns whether it listens to a terminal.
  bool listens() const { return listener_.joinable(); }
  /// Returns whether a key was pressed.
  bool pressed() const { return pressed_.load(); }

 private:
  void listen();

  termios before_{};
  std::atomic<bool> over_{false}, pressed_{false};
  std::thread listener_;
};

/// Returns whether standard input is a terminal and this program is in its foreground.
bool has_terminal();

}  // namespace thimble::cli
