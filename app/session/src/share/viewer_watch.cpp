#include "share/viewer_watch.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>

namespace thimble::session {

ViewerWatch::ViewerWatch(const SharedRun& shared, std::shared_ptr<spdlog::logger> log)
    : shared_(shared), log_(std::move(log)) {
  for (std::size_t i = 0; i < shared.knob_count(); ++i) {
    const double initial = shared.knob(i).initial;
    knobs_.push_back({.logged = initial, .newest = initial});
  }
}

void ViewerWatch::step(const std::string& now) {
  watch_viewers(now);
  watch_knobs(now);
  if (shared_.pause_asked() == paused_) return;
  paused_ = !paused_;
  log_->info("{}{}", now, paused_ ? "A viewer paused the run." : "A viewer resumed the run.");
}

void ViewerWatch::watch_viewers(const std::string& now) {
  std::vector<std::uint64_t> viewers = shared_.viewers();
  std::sort(viewers.begin(), viewers.end());
  const auto log_new = [&](const std::vector<std::uint64_t>& those,
                           const std::vector<std::uint64_t>& before, const char* what) {
    std::vector<std::uint64_t> fresh;
    std::set_difference(those.begin(), those.end(), before.begin(), before.end(),
                        std::back_inserter(fresh));
    for (const std::uint64_t pid : fresh) log_->info("{}Viewer {} {}.", now, pid, what);
  };
  log_new(viewers, viewers_, "has attached");
  log_new(viewers_, viewers, "has detached");
  viewers_ = std::move(viewers);
}

void ViewerWatch::watch_knobs(const std::string& now) {
  for (std::size_t i = 0; i < knobs_.size(); ++i) {
    Knob& knob = knobs_[i];
    // The run ignores invalid values as well.
    const double wanted = shared_.knob_wanted(i).value_or(knob.newest);
    knob.still = wanted == knob.newest ? knob.still + 1 : 0;
    knob.newest = wanted;
    if (knob.still != kSettled || knob.newest == knob.logged) continue;
    const SharedScene::Knob& what = shared_.knob(i);
    log_->info("{}A viewer set {} from {:g} to {:g} {}.", now, what.name, knob.logged, knob.newest,
               what.unit);
    knob.logged = knob.newest;
  }
}

}  // namespace thimble::session
