#pragma once

#include <sys/types.h>

#include <string>

#include "thimble/driver/export.h"

namespace thimble::scene {

/// Keeps the computer awake while a real arm is in use: an inhibitor lock of logind against sleep,
/// idle actions and the lid's switch, held by the program systemd-inhibit for as long as this
/// lives, and no longer than this process. Where there is no logind, or it refuses, there is no
/// lock, and the fault kSuspended is what remains. Real-time: never from the servo thread.
class THIMBLE_EXPORT SleepLock {
 public:
  /// Asks for the lock; waits up to 2 s for the answer.
  SleepLock();
  ~SleepLock();
  SleepLock(const SleepLock&) = delete;
  SleepLock& operator=(const SleepLock&) = delete;

  /// Returns whether the lock is held.
  bool held() const noexcept { return held_; }
  /// Returns why there is none, in a sentence; empty if it is held.
  const std::string& note() const noexcept { return note_; }

 private:
  void end() noexcept;

  pid_t child_ = -1;
  int input_ = -1;  // whose end ends the child
  bool held_ = false;
  std::string note_;
};

}  // namespace thimble::scene
