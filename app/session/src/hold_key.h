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

/// Returns the enabling input of this name: "button" or "button1" to "button16", of the arm,
/// or "key", the space bar of the terminal or a viewer; empty: none. The error lists the names.
THIMBLE_EXPORT driver::Result<driver::HoldToRun> hold_named(const std::string& name);

/// Whether the space bar is held down at a terminal, which reports presses only: a key that is held
/// repeats. Held is a key that has come several times, evenly; one press is none. Times are
/// ns of any clock.
class HeldKey {
 public:
  // [chosen: terminals repeat 11 to 30 times a second, after a quarter to two thirds of a second]
  static constexpr std::int64_t kGapMost_ns = 120'000'000;
  static constexpr std::int64_t kLasts_ns = 150'000'000;  ///< How long one press counts.
  static constexpr int kPressesLeast = 3;

  /// Takes a press.
  void press(std::int64_t now_ns) noexcept {
    presses_ = now_ns - last_ns_ <= kGapMost_ns ? presses_ + 1 : 1;
    last_ns_ = now_ns;
  }
  /// Returns until when it counts as held; before `now_ns` if it does not.
  std::int64_t until_ns() const noexcept {
    return presses_ >= kPressesLeast ? last_ns_ + kLasts_ns : last_ns_;
  }

 private:
  int presses_ = 0;  // in a row
  std::int64_t last_ns_ = -1'000'000'000'000;
};

/// Whether a viewer's window has its key held, by a number that grows with each of its pictures in
/// which that is so. A window that is closed, hidden or hangs draws no pictures, so that its key is
/// released. Times are ns of any clock.
class ViewerKey {
 public:
  /// Begins with the number as it is: what grew before does not count.
  explicit ViewerKey(std::uint64_t number) noexcept : number_(number) {}

  /// Takes the number as it is now.
  void look(std::uint64_t number, std::int64_t now_ns) noexcept {
    if (number == number_) return;
    number_ = number;
    until_ns_ = now_ns + HeldKey::kLasts_ns;
  }
  /// Returns until when it counts as held; before `now_ns` if it does not.
  std::int64_t until_ns() const noexcept { return until_ns_; }

 private:
  std::uint64_t number_;
  std::int64_t until_ns_ = -1'000'000'000'000;
};

/// The space bar of the terminal, and of the windows of viewers, as the enabling input of all arms
/// of a session (HoldToRun), for as long as this lives. Keys of the terminal do not wait for Enter
/// then and are not shown. Real-time: never from the servo thread.
class THIMBLE_EXPORT HoldKey {
 public:
  /// Fails if standard input is no terminal.
  static driver::Result<void> check();
  /// Takes over the terminal; the session's arms must be open and outlive it.
  explicit HoldKey(Session& session);
  ~HoldKey();
  HoldKey(const HoldKey&) = delete;
  HoldKey& operator=(const HoldKey&) = delete;

  /// Returns the terminal for other readers of keys: only Enter is left of it.
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
