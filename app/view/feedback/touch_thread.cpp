#include "view/feedback/touch_thread.h"

#include <chrono>
#include <utility>

#include "share/run_attachment.h"
#include "view/feedback/rumble.h"
#include "view/feedback/sound_card.h"

namespace thimble::view {
namespace {

constexpr std::chrono::milliseconds kBetweenSteps{10};

void play(const std::stop_token& stop, const std::string& name, TouchPlayer& player) {
  session::RunAttachment runs(name);
  while (!stop.stop_requested()) {
    if (runs.step()) player.begin(*runs.reader());
    const std::int64_t now_ns = std::chrono::duration_cast<std::chrono::nanoseconds>(
                                    std::chrono::steady_clock::now().time_since_epoch())
                                    .count();
    if (runs.reader() != nullptr) player.step(*runs.reader(), now_ns);
    std::this_thread::sleep_for(kBetweenSteps);
  }
  player.stop();
}

/// Opens one output; if that fails, appends the reason to `trouble`.
template <class Output>
std::unique_ptr<Output> opened(driver::Result<std::unique_ptr<Output>> output,
                               std::string& trouble) {
  if (output) return std::move(output).value();
  trouble += (trouble.empty() ? "" : " ") + output.error().message;
  return nullptr;
}

}  // namespace

TouchThread::TouchThread(const FeedbackChoice& choice) {
  std::unique_ptr<SoundOutput> sound;
  std::unique_ptr<RumbleOutput> rumble;
  if (choice.sound) sound = opened(open_sound_card(), trouble_);
  if (choice.rumble) rumble = opened(open_rumble(), trouble_);
  if (!sound && !rumble) return;
  player_ = std::make_unique<TouchPlayer>(std::move(sound), std::move(rumble));
}

void TouchThread::follow(const std::string& run) {
  if (!player_) return;
  thread_ = std::jthread([run, player = std::move(player_)](const std::stop_token& stop) {
    play(stop, run, *player);
  });
}

}  // namespace thimble::view
