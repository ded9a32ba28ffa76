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

/// Returns the rumble for consecutive ticks. The strong motor gets the largest contact force as a
/// fraction of `force_max` (N, above 0). The weak motor gets the change of the force between ticks.
/// Zero without contact; never above 1.
RumbleLevel rumble_of(std::span<const driver::TickRecord> ticks, double force_max);

/// Plays the contact of a run on a sound card and a gamepad. A run in virtual time has neither
/// sound nor rumble, and a run at another pace than real time only rumbles. Used by one thread.
/// Real-time: never from the servo thread.
class TouchPlayer {
 public:
  /// Takes the outputs; either may be null.
  TouchPlayer(std::unique_ptr<SoundOutput> sound, std::unique_ptr<RumbleOutput> rumble)
      : sound_(std::move(sound)), rumble_(std::move(rumble)) {}

  /// Starts at the newest tick of a run.
  void begin(const session::SharedReader& run);
  /// Plays what is new in the run passed to `begin`; call it about 50 times a second. `now_ns`:
  /// time of a monotonic clock. The gamepad stops if the run pauses, ends, or has no new tick for
  /// kRumbleMax.
  void step(const session::SharedReader& run, std::int64_t now_ns);
  /// Stops the gamepad, because there is no run.
  void stop();

 private:
  void rumble(const RumbleLevel& level, std::int64_t now_ns);

  std::unique_ptr<SoundOutput> sound_;
  std::unique_ptr<RumbleOutput> rumble_;
  std::optional<TouchSound> touch_sound_;
  std::uint64_t serial_ = 0;
  std::int64_t newest_ns_ = 0;  // time of the newest tick
  RumbleLevel level_;           // the last level sent
  std::int64_t asked_ns_ = 0;   // time at which it was sent
  std::vector<driver::TickRecord> ticks_;
  std::vector<float> samples_;
};

}  // namespace thimble::view
