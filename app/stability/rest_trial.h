#pragma once

#include <memory>
#include <string>
#include <vector>

#include "thimble/device_sim/settings.h"
#include "thimble/driver/fault.h"
#include "thimble/driver/result.h"
#include "thimble/scene/scene_file.h"

namespace thimble::scene {
class SharedMeshes;
}

namespace thimble::stability {

/// The force above 50 Hz from which on a hand that rests feels a limit cycle, N RMS [PHYSICS 6].
inline constexpr double kRestFelt = 0.02;

/// What the force did in the last quarter of a second of a hand's rest.
struct Rest {
  double time = 0;         ///< When the hand came to rest, by the scene's time, s.
  std::string on;          ///< Object that the tip was on at the end; empty: none.
  double force = 0;        ///< Mean of what was sent, N.
  double oscillation = 0;  ///< Of what was sent, above 50 Hz, N RMS.
  double frequency = 0;    ///< Of its strongest line, Hz.
};

/// The rests of one hand in one scene, in order of time.
struct RestTrial {
  std::vector<Rest> rests;
  driver::Fault fault = driver::Fault::kNone;  ///< That ended the run, and the rests with it.

  /// Returns the rest that oscillates the most; null if there is none.
  const Rest* worst() const;
};

/// Runs a scene with its simulated arm and a hand of these constants on the virtual clock, and
/// watches the hand at rest: wherever its path holds for 0.3 s or more, and at its end, each for
/// 1.6 s. If none of these rests touches anything, the hand is stopped where it is deepest in each
/// object that it touches, and watched there. Trials of one scene may share `meshes`. The error
/// says why the scene cannot be run. Real-time: never from the servo thread.
driver::Result<RestTrial> try_rests(const scene::Scene& scene, const device_sim::HandSettings& hand,
                                    const std::shared_ptr<scene::SharedMeshes>& meshes = nullptr);

}  // namespace thimble::stability
