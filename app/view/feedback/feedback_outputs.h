#pragma once

#include <span>

namespace thimble::view {

/// Where sound goes: a card, or a double in tests.
class SoundOutput {
 public:
  virtual ~SoundOutput() = default;
  /// Plays samples (TouchSound::kRate a second, -1 to 1) after those before. Never waits: what
  /// there is no room for is dropped.
  virtual void play(std::span<const float> samples) = 0;
};

/// How hard the two motors of a gamepad run, each 0 to 1.
struct RumbleLevel {
  double strong = 0;  ///< The slow, heavy one.
  double weak = 0;    ///< The fast, light one.

  friend bool operator==(const RumbleLevel&, const RumbleLevel&) = default;
};

/// Where rumble goes: a gamepad, or a double in tests.
class RumbleOutput {
 public:
  virtual ~RumbleOutput() = default;
  /// Lets the motors run so hard until it is called again, or kRumbleMost is over.
  virtual void rumble(const RumbleLevel& level) = 0;
};

/// s after which a gamepad stops by itself, and after which a run that tells nothing is taken to
/// stand still. Chosen.
inline constexpr double kRumbleMost = 0.2;

}  // namespace thimble::view
