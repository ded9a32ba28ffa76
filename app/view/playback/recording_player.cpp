#include "view/playback/recording_player.h"

#include <utility>

namespace thimble::view {

RecordingPlayer::RecordingPlayer(const RecordingView& recording, std::string name)
    : recording_(recording), name_(std::move(name)) {
  head_.set_span(recording.time().begin, recording.time().end);
}

bool RecordingPlayer::step(double dt) {
  if (!first_) head_.step(dt);
  recording_.show(head_.time(), *moment_);
  return std::exchange(first_, false);
}

}  // namespace thimble::view
