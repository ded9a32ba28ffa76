#pragma once

#include <string>
#include <thread>

#include "view/feedback/touch_player.h"

namespace thimble::view {

/// What a person hears and feels of a run beside its pictures.
struct FeltChoice {
  bool sound = false;
  bool rumble = false;
};

/// Plays the runs of a name on a thread of its own, so that slow pictures do not make it stutter.
/// The run does not notice. Real-time: never from the servo thread.
class TouchThread {
 public:
  /// Opens what is chosen. What cannot be opened is left out, and `trouble` says why.
  explicit TouchThread(const FeltChoice& choice);

  /// Plays the runs of this name from now on. Once.
  void follow(const std::string& run);

  /// Returns what was left out and what to do; empty if nothing was.
  const std::string& trouble() const { return trouble_; }

 private:
  std::string trouble_;
  std::unique_ptr<TouchPlayer> player_;  // until the thread has it; null too if nothing plays
  std::jthread thread_;
};

}  // namespace thimble::view
