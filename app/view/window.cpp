#include "view/window.h"

#include <filesystem>

#include "view/compare/runs_player.h"
#include "view/content/content.h"
#include "view/content/window_loop.h"
#include "view/playback/recording_player.h"

namespace thimble::view {
namespace {

driver::Result<void> show(TouchSource& source, const WindowChoice& choice) {
  auto screen = Screen::open();
  if (!screen) return screen.error();
  Content content(**screen, source, choice);
  return draw_until_closed(**screen, choice, [&](double dt) -> driver::Result<AfterPicture> {
    if (auto drawn = content.draw(dt); !drawn) return drawn.error();
    if (content.wants_to_close()) return AfterPicture::kClose;
    return content.still() ? AfterPicture::kStill : AfterPicture::kMoves;
  });
}

}  // namespace

driver::Result<void> show_recording(const RecordingView& recording, const std::string& file,
                                    const WindowChoice& choice) {
  RecordingPlayer player(recording, std::filesystem::path(file).stem());
  if (choice.at >= 0) player.head().stop_at(player.head().begin() + choice.at);
  return show(player, choice);
}

driver::Result<void> show_recordings(RecordedRuns& runs, const std::string& name,
                                     const WindowChoice& choice) {
  RunsPlayer player(runs, name);
  if (choice.at >= 0) player.head().stop_at(choice.at);
  return show(player, choice);
}

}  // namespace thimble::view
