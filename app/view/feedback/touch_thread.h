#pragma once

#include <string>
#include <thread>

#include "view/feedback/touch_player.h"

namespace thimble::view {

/// The chosen outputs: sound and rumble.
struct FeedbackChoice {
  bool sound = false;
  bool rumble = false;
};

/// Plays the runs of a name in a separate thread, so that slow drawing does not interrupt the
/// sound. The run is not affected. Real-time: never from the servo thread.
class TouchThread {
 public:
  /// Opens the chosen outputs. Outputs that cannot be opened are omitted, and `trouble` says why.
  explicit TouchThread(const FeedbackChoice& choice);

  /// Plays the runs of this name from now on. Call it once.
  void follow(const std::string& run);

  /// Returns which outputs were omitted and what to do; empty if none was.
  const std::string& trouble() const { return trouble_; }

 private:
  std::string trouble_;
  std::unique_ptr<TouchPlayer> player_;  // until the thread takes it; null: no output
  std::jthread thread_;
};

}  // namespace thimble::view
