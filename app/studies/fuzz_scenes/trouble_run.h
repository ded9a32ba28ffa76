#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "studies/fuzz_scenes/random_scene.h"

namespace thimble::studies {

/// What a scene showed on the virtual clock. All of it is finite, whatever happened.
struct TroubleFound {
  bool refused = false;         ///< The loader would not have it; nothing else is said.
  double not_finite = 0;        ///< Ticks with a place or a force that is no number.
  double fault = 0;             ///< Of the device, as a number; 0: none.
  double force_share = 0;       ///< Largest force sent, of the arm's limit.
  double limit_cycle = 0;       ///< Force above 50 Hz in the last quarter of a second, N RMS.
  bool must_oscillate = false;  ///< As RandomScene::oscillates.
  /// Whether its limit cycle is larger than kLimitCycleMost and no law names a cause (rest_causes).
  bool unforetold = false;
  double speed = 0;  ///< Largest of the tip, m/s.
  double given = 0;  ///< Most that the motors gave in any window (EnergyGiven), J.
  /// What the gate's energy stage lets go (`energy_let_go`), and the scene may give by itself, J.
  double given_bound = 0;
  double contact = 0;  ///< Share of ticks in contact.

  /// Returns whether the scene broke one of the promises.
  bool bad() const;
  /// Orders scenes by how near they came to trouble; larger is worse. Their limit cycle counts
  /// unless it is known that they must.
  double badness() const;
};

/// The force above 50 Hz that counts as a limit cycle at rest, N RMS [PHYSICS 6].
inline constexpr double kLimitCycleMost = 0.02;

/// Runs a scene's file and keeps the account.
///
/// The account is of the work that the simulated motors did on the tip, not of what the gate
/// booked. Real-time: never from the servo thread.
TroubleFound run_for_trouble(const std::filesystem::path& scene_file, const RandomScene& scene);

/// Turns what was found into the numbers of a sweep and back.
std::vector<double> numbers_of(const TroubleFound& found);
TroubleFound trouble_of(const std::vector<double>& numbers);

}  // namespace thimble::studies
