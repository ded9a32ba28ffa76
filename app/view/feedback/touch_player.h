#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "share/shared_reader.h"
#include "view/feedback/feedback_outputs.h"
#include "view/feedback/touch_sound.h"

namespace thimble::view {

/// Returns how a gamepad shall rumble for ticks in a row: the heavy motor by the largest force of a
/// touch as a share of `force_max` (N, above 0), the light one by how much the force changes from
/// tick to tick. Nothing where nothing touches; never above 1.
RumbleLevel rumble_of(std::span<const driver::TickRecord> ticks, double force_max);

/// Hands what a run feels on to a sound card and a gamepad. Only what happens in real time: a run
/// in virtual time has no sound, and one at another pace than that of real time only rumbles. Used
/// by one thread. Real-time: never from the servo thread.
class TouchPlayer {
 public:
  /// Takes where to; either may be null.
  TouchPlayer(std::unique_ptr<SoundOutput> sound, std::unique_ptr<RumbleOutput> rumble)
      : sound_(std::move(sound)), rumble_(std::move(rumble)) {}

  /// Begins with the newest tick of a run.
  void begin(const session::SharedReader& run);
  /// Plays what is new of the run it began with; call it some 50 times a second. `now_ns`: on a
  /// clock that always goes on. The gamepad stops where the run pauses, ends, or has told nothing
  /// for kRumbleMost.
  void step(const session::SharedReader& run, std::int64_t now_ns);
  /// Stops the gamepad: there is no run.
  void stop();

 private:
  void rumble(const RumbleLevel& level, std::int64_t now_ns);

  std::unique_ptr<SoundOutput> sound_;
  std::unique_ptr<RumbleOutput> rumble_;
  std::optional<TouchSound> touch_sound_;
  std::uint64_t serial_ = 0;
  std::int64_t newest_ns_ = 0;  // when the last tick came
  RumbleLevel level_;           // as it was asked for last ...
  std::int64_t asked_ns_ = 0;   // ... and when
  std::vector<driver::TickRecord> ticks_;
  std::vector<float> samples_;
};

}  // namespace thimble::view
