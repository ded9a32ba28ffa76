#pragma once

#include <span>

namespace thimble::view {

/// Sound output: a sound card, or a test double.
class SoundOutput {
 public:
  virtual ~SoundOutput() = default;
  /// Plays samples (TouchSound::kRate a second, -1 to 1) after the previous ones. Never waits:
  /// samples without room in the buffer are dropped.
  virtual void play(std::span<const float> samples) = 0;
};

/// The intensity of the two motors of a gamepad, each 0 to 1.
struct RumbleLevel {
  double strong = 0;  ///< The slow, heavy one.
  double weak = 0;    ///< The fast, light one.

  friend bool operator==(const RumbleLevel&, const RumbleLevel&) = default;
};

/// Rumble output: a gamepad, or a test double.
class RumbleOutput {
 public:
  virtual ~RumbleOutput() = default;
  /// Sets the motors' intensity until the next call, or for kRumbleMax.
  virtual void rumble(const RumbleLevel& level) = 0;
};

/// Time (s) after which a gamepad stops by itself, and after which a run without new ticks counts
/// as stopped. Chosen.
inline constexpr double kRumbleMax = 0.2;

}  // namespace thimble::view
