#pragma once

#include <termios.h>

#include <atomic>
#include <cstdint>
#include <string>
#include <thread>

#include "terminal.h"
#include "thimble/driver/hold_to_run.h"
#include "thimble/driver/result.h"

namespace thimble::session {

class Session;

/// Returns the enabling input that a person names: "button" or "button1" to "button16", of the arm,
/// or "key", the space bar of the terminal; empty: none. The error names what there is.
driver::Result<driver::HoldToRun> hold_named(const std::string& name);

/// Whether the space bar is held down at a terminal, which tells of presses alone: a key that is
/// held repeats. Held is a key that has come several times, evenly; one press is none. Times are
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

/// The space bar of the terminal as the enabling input of all arms of a session (HoldToRun), for as
/// long as this lives. Keys do not wait for Enter then and are not shown. Real-time: never from the
/// servo thread.
class HoldKey {
 public:
  /// Fails if standard input is no terminal.
  static driver::Result<void> check();
  /// Takes over the terminal; the session's arms must be open and outlive it.
  explicit HoldKey(Session& session);
  ~HoldKey();
  HoldKey(const HoldKey&) = delete;
  HoldKey& operator=(const HoldKey&) = delete;

  /// Returns the terminal for whoever else asks for keys: of it Enter alone is left.
  Terminal terminal();

 private:
  void watch();

  Session& session_;
  termios before_{};
  std::atomic<bool> stop_{false}, enter_{false}, closed_{false};
  std::thread thread_;
};

}  // namespace thimble::session
