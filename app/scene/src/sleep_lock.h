#pragma once

#include <sys/types.h>

#include <string>

#include "thimble/driver/export.h"

namespace thimble::scene {

/// Prevents a suspend of the computer while a real arm is in use: an inhibitor lock of logind
/// against sleep, idle actions and the lid's switch. The program systemd-inhibit holds it during
/// the lifetime of this object, and no longer than this process. If logind is missing or refuses,
/// there is no lock, and a suspend is detected by the fault kSuspended. Real-time: never from the
/// servo thread.
class THIMBLE_EXPORT SleepLock {
 public:
  /// Requests the lock; waits up to 2 s for the answer.
  SleepLock();
  ~SleepLock();
  SleepLock(const SleepLock&) = delete;
  SleepLock& operator=(const SleepLock&) = delete;

  /// Returns whether the lock is held.
  bool held() const noexcept { return held_; }
  /// Returns the reason why there is no lock, in one sentence; empty if it is held.
  const std::string& note() const noexcept { return note_; }

 private:
  void end() noexcept;

  pid_t child_ = -1;
  int input_ = -1;  // Input of the child, which exits when it is closed.
  bool held_ = false;
  std::string note_;
};

}  // namespace thimble::scene
