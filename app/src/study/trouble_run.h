#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "study/random_scene.h"

namespace thimble::app {

/// Is what a scene showed on the virtual clock. All of it is finite, whatever happened.
struct TroubleFound {
  bool refused = false;    ///< The loader would not have it; nothing else is said.
  double not_finite = 0;   ///< Ticks with a place or a force that is no number.
  double fault = 0;        ///< Of the device, as a number; 0: none.
  double force_share = 0;  ///< Largest force sent, of the arm's limit.
  double excess = 0;       ///< See energy_excess below, J.
  double tremble = 0;      ///< Force above 50 Hz in the last quarter of a second, N RMS.
  double speed = 0;        ///< Largest of the tip, m/s.
  double work = 0;         ///< What the motors did on the tip in all, J.
  double contact = 0;      ///< Share of ticks in contact.

  /// Tells whether the scene broke one of the promises.
  bool bad() const;
  /// Orders scenes by how near they came to trouble; larger is worse.
  double badness() const;
};

/// Is how much energy (J) a run may show beyond what the hand put in. It is the account's own error
/// in the worst case, a press of 5 N at 1 m/s seen in steps of 1 ms [chosen; the study prints what
/// was found].
inline constexpr double kEnergyAllowed = 1e-3;

/// Runs a scene file and keeps the account. `own_energy` (J) is what the scene may give by itself.
///
/// The account: the energy of arm and hand, (m v^2 + k (x - x_hand)^2) / 2, may grow by the work of
/// whoever moves the hand, and by `own_energy`, and by nothing else; friction only takes away. Its
/// largest excess over that is told.
/// Real-time: never from the servo thread.
TroubleFound run_for_trouble(const std::filesystem::path& scene_file, double own_energy);

/// Turns what was found into the numbers of a sweep and back.
std::vector<double> numbers_of(const TroubleFound& found);
TroubleFound trouble_of(const std::vector<double>& numbers);

}  // namespace thimble::app
