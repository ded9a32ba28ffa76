#include "view/compare/runs_player.h"

#include <utility>

namespace thimble::view {

RunsPlayer::RunsPlayer(RecordedRuns& runs, std::string name) : runs_(runs), name_(std::move(name)) {
  head_.set_span(runs.axis().span().begin, runs.axis().span().end);
}

bool RunsPlayer::step(double dt) {
  if (!first_) head_.step(dt);
  bool another = std::exchange(first_, false);
  if (const auto wanted = std::exchange(runs_.comparison().wanted, std::nullopt)) {
    another = another || *wanted != runs_.comparison().drawn;
    runs_.draw_scene_of(*wanted);
  }
  runs_.show(head_.time(), *moment_);
  return another;
}

}  // namespace thimble::view
