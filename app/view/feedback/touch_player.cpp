#include "view/feedback/touch_player.h"

#include <algorithm>
#include <cmath>

namespace thimble::view {
namespace {

constexpr double kRumbleFull = 0.5;  // N, change between ticks for full intensity; chosen
// Time after which a level is sent again, ns: twice before the gamepad would stop. A new level is
// sent no more often either, because the gamepad's cable transfers 8 ms of commands at a time.
constexpr auto kBetween = static_cast<std::int64_t>(1e9 * kRumbleMax / 4);

Eigen::Vector3d force(const driver::TickRecord& tick) {
  return {tick.f_sent_W[0], tick.f_sent_W[1], tick.f_sent_W[2]};
}

}  // namespace

RumbleLevel rumble_of(std::span<const driver::TickRecord> ticks, double force_max) {
  RumbleLevel level;
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    if (!ticks[i].in_contact) continue;
    level.strong = std::max(level.strong, force(ticks[i]).norm() / force_max);
    if (i == 0) continue;
    const double change = (force(ticks[i]) - force(ticks[i - 1])).norm();
    level.weak = std::max(level.weak, change / kRumbleFull);
  }
  // Maps NaN to zero.
  level.strong = level.strong > 0 ? std::min(level.strong, 1.0) : 0;
  level.weak = level.weak > 0 ? std::min(level.weak, 1.0) : 0;
  return level;
}

void TouchPlayer::begin(const session::SharedReader& run) {
  stop();
  touch_sound_.emplace(run.scene().period_ns);
  serial_ = 0;
  ticks_.clear();
  run.ticks_since(serial_, ticks_);  // older ticks are not played
  newest_ns_ = 0;
}

void TouchPlayer::stop() {
  if (rumble_ && level_ != RumbleLevel{}) rumble_->rumble({});
  level_ = {};
}

void TouchPlayer::rumble(const RumbleLevel& level, std::int64_t now_ns) {
  const bool stops = level == RumbleLevel{};
  if (stops) return stop();
  if (level_ != RumbleLevel{} && now_ns - asked_ns_ < kBetween) return;
  level_ = level;
  asked_ns_ = now_ns;
  rumble_->rumble(level);
}

void TouchPlayer::step(const session::SharedReader& run, std::int64_t now_ns) {
  ticks_.clear();
  run.ticks_since(serial_, ticks_);
  // At another pace the card would get too few or too many samples.
  const bool real_time = run.scene().wall_clock || (run.scene().paced && run.speed_asked() == 1);
  if (!run.scene().wall_clock && !run.scene().paced) return;  // no sound in virtual time
  if (!ticks_.empty()) newest_ns_ = now_ns;
  if (sound_ && touch_sound_ && real_time) {
    samples_.clear();
    for (const driver::TickRecord& tick : ticks_) touch_sound_->take(tick, samples_);
    if (!samples_.empty()) sound_->play(samples_);
  }
  if (!rumble_) return;
  const bool stalled = static_cast<double>(now_ns - newest_ns_) > 1e9 * kRumbleMax;
  if (stalled || run.state() != session::RunState::kRunning) return stop();
  const double force_max = run.scene().force_max;
  if (!ticks_.empty() && force_max > 0) rumble(rumble_of(ticks_, force_max), now_ns);
}

}  // namespace thimble::view
