#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "studies/fuzz_scenes/random_scene.h"

namespace thimble::studies {

/// Result of a scene in virtual time. All numbers are finite in any case.
struct TroubleFound {
  bool refused = false;         ///< The loader rejected it; all other members are unused.
  double not_finite = 0;        ///< Ticks with a position or a force that is not finite.
  double fault = 0;             ///< Fault of the device, as a number; 0: none.
  double force_share = 0;       ///< Largest sent force, relative to the arm's limit.
  double limit_cycle = 0;       ///< Force above 50 Hz in the last quarter of a second, N RMS.
  bool must_oscillate = false;  ///< As RandomScene::oscillates.
  /// Whether its limit cycle is larger than kLimitCycleMax and no law names a cause (rest_causes).
  bool unforetold = false;
  double speed = 0;  ///< Maximum speed of the tip, m/s.
  double given = 0;  ///< Maximum energy from the motors in any window (EnergyGiven), J.
  /// Energy allowed by the gate's energy stage (`energy_let_go`) and by the scene itself, J.
  double given_bound = 0;
  double contact = 0;  ///< Fraction of ticks in contact.

  /// Returns whether the scene broke one of the promises.
  bool bad() const;
  /// Orders scenes by their distance to trouble; larger is worse. A limit cycle counts unless it is
  /// expected.
  double badness() const;
};

/// The force above 50 Hz that counts as a limit cycle at rest, N RMS [PHYSICS 6].
inline constexpr double kLimitCycleMax = 0.02;

/// Runs a scene's file and computes the account.
///
/// The account is of the true work of the simulated motors on the tip, not of the gate's account.
/// Real-time: never from the servo thread.
TroubleFound run_for_trouble(const std::filesystem::path& scene_file, const RandomScene& scene);

/// Converts a result to the numbers of a sweep and back.
std::vector<double> numbers_of(const TroubleFound& found);
TroubleFound trouble_of(const std::vector<double>& numbers);

}  // namespace thimble::studies
