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

/// Force above 50 Hz from which a hand at rest feels a limit cycle, N RMS [PHYSICS 6].
inline constexpr double kRestFelt = 0.02;

/// The force in the last quarter of a second of a hand's rest.
struct Rest {
  double time = 0;         ///< Start of the rest, in the scene's time, s.
  std::string on;          ///< Object that the tip touched at the end; empty: none.
  double force = 0;        ///< Mean sent force, N.
  double oscillation = 0;  ///< Sent force above 50 Hz, N RMS.
  double frequency = 0;    ///< Frequency of its strongest spectral line, Hz.
};

/// The rests of one hand in one scene, in order of time.
struct RestTrial {
  std::vector<Rest> rests;
  driver::Fault fault = driver::Fault::kNone;  ///< A fault that ended the run and the rests.

  /// Returns the rest with the largest oscillation; null if there is none.
  const Rest* worst() const;
};

/// Runs a scene with its simulated arm and a hand of these constants in virtual time, and observes
/// the hand at rest. It rests wherever its path holds for 0.3 s or more, and at the end, each time
/// for 1.6 s. If no rest touches anything, the hand is stopped at its deepest point in each touched
/// object and observed there. Trials of one scene may share `meshes`. The error says why the scene
/// cannot be run. Real-time: never from the servo thread.
driver::Result<RestTrial> try_rests(const scene::Scene& scene, const device_sim::HandSettings& hand,
                                    const std::shared_ptr<scene::SharedMeshes>& meshes = nullptr);

}  // namespace thimble::stability
