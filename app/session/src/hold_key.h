#pragma once

#include <termios.h>

#include <atomic>
#include <cstdint>
#include <string>
#include <thread>

#include "terminal.h"
#include "thimble/driver/device.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::session {

class Session;

/// Returns the enabling input with the given name. Names are "button" or "button1" to "button16"
/// for a button of the arm, and "key" for the space bar of the terminal or a viewer. An empty name
/// means none. The error lists the names.
THIMBLE_EXPORT driver::Result<driver::HoldToRun> hold_named(const std::string& name);

/// Detects whether the space bar is held at a terminal, which reports only presses: a held key
/// repeats. A key is held if it has been pressed several times at short intervals; a single press
/// does not count. Times are ns of any clock.
class HeldKey {
 public:
  // [chosen: terminals repeat 11 to 30 times a second, after a quarter to two thirds of a second]
  static constexpr std::int64_t kRepeatIntervalMax_ns = 120'000'000;
  static constexpr std::int64_t kLasts_ns = 150'000'000;  ///< Time for which one press counts, ns.
  static constexpr int kPressesMin = 3;

  /// Records a press.
  void press(std::int64_t now_ns) noexcept {
    presses_ = now_ns - last_ns_ <= kRepeatIntervalMax_ns ? presses_ + 1 : 1;
    last_ns_ = now_ns;
  }
  /// Returns the time until which the key counts as held; before `now_ns` if it is not held.
  std::int64_t until_ns() const noexcept {
    return presses_ >= kPressesMin ? last_ns_ + kLasts_ns : last_ns_;
  }

 private:
  int presses_ = 0;  // Consecutive presses.
  std::int64_t last_ns_ = -1'000'000'000'000;
};

/// Detects whether a key is held in a viewer's window, by a number that grows with each picture
/// drawn while it is held. A window that is closed, hidden or blocked draws no pictures, so its key
/// counts as released. Times are ns of any clock.
class ViewerKey {
 public:
  /// Starts with the current number; earlier growth does not count.
  explicit ViewerKey(std::uint64_t number) noexcept : number_(number) {}

  /// Updates the number.
  void update(std::uint64_t number, std::int64_t now_ns) noexcept {
    if (number == number_) return;
    number_ = number;
    until_ns_ = now_ns + HeldKey::kLasts_ns;
  }
  /// Returns the time until which the key counts as held; before `now_ns` if it is not held.
  std::int64_t until_ns() const noexcept { return until_ns_; }

 private:
  std::uint64_t number_;
  std::int64_t until_ns_ = -1'000'000'000'000;
};

/// Uses the space bar of the terminal and of viewers' windows as the enabling input of all arms of
/// a session (HoldToRun) during its lifetime. Meanwhile the terminal does not wait for Enter and
/// does not show keys. Real-time: never from the servo thread.
class THIMBLE_EXPORT HoldKey {
 public:
  /// Fails if standard input is not a terminal.
  static driver::Result<void> check();
  /// Takes over the terminal. The session's arms must be open, and the session must outlive it.
  explicit HoldKey(Session& session);
  ~HoldKey();
  HoldKey(const HoldKey&) = delete;
  HoldKey& operator=(const HoldKey&) = delete;

  /// Returns the terminal for other readers of keys; they only receive Enter.
  Terminal terminal();

 private:
  void watch();
  void read_terminal(HeldKey& key);

  Session& session_;
  termios before_{};
  std::atomic<bool> stop_{false}, enter_{false}, closed_{false};
  std::thread thread_;
};

}  // namespace thimble::session
