#pragma once

#include <memory>
#include <string>
#include <vector>

#include "stability/friction_rig.h"
#include "thimble/render/effect/stage_list.h"

namespace thimble::studies {

/// One friction that the study compares, as a scene would name it: 0.5 of a load of 1 N.
struct FrictionCase {
  std::string name;               ///< Of files and figures.
  std::string title;              ///< In words.
  std::string letter;             ///< In the table of [PHYSICS 2.2]; empty if it is not there.
  std::string kind;               ///< In the effect table.
  std::string word_key, word;     ///< A setting that is a word; none if empty.
  double static_coefficient = 0;  ///< 0: not given.
  double stiffness = 0;           ///< N/m, past the check of its settings; 0: as the arm allows.
};

/// Returns the frictions of the study, in the order of its table.
const std::vector<FrictionCase>& friction_cases();

/// Builds a friction for a rig. Precondition: it is one of friction_cases and the arm of the rig
/// can carry its settings (the caller's duty).
/// Real-time: never from the servo thread.
std::unique_ptr<render::AnyStage> build_friction(const FrictionCase& which,
                                                 const stability::FrictionRigSettings& rig);

/// What is measured of one friction at one delay. Forces in N, places in m, RMS above 50 Hz.
struct FrictionMeasures {
  double rest_force = 0;  ///< In the last second after a stop from 50 mm/s.
  double rest_way = 0;    ///< The tip's, then.
  double rest_frequency =
      0;                   ///< How often the force oscillates about its mean then, Hz; 0 if silent.
  double rest_held = 0;    ///< Mean force held, then.
  double creep_force = 0;  ///< The hand creeping at 1 mm/s.
  double creep_mean = 0;   ///< Mean friction, then.
  double slow_mean = 0;    ///< The same at 5 mm/s.
  double tremor_force = 0;  ///< The hand at one place, with a tremor of 300 um.
  stability::RigRun stop;   ///< The run of the stop, for pictures.
};

/// When and where the run of the stop stops.
inline constexpr double kStopTime = 0.8;    // s
inline constexpr double kStopPlace = 0.01;  // m

/// Slides at 50 mm/s, stops at `stop` (m), and waits two seconds.
stability::RigRun stop_run(const FrictionCase& which, const stability::FrictionRigSettings& rig,
                           double stop = kStopPlace);

/// Measures a friction on a rig. Real-time: never from the servo thread.
FrictionMeasures measure(const FrictionCase& which, const stability::FrictionRigSettings& rig);

/// What the naive law does when it slides evenly [PHYSICS 2.1].
struct EvenSliding {
  double mean = 0;    ///< N, against the motion.
  double ripple = 0;  ///< N RMS.
};

/// Slides the naive friction evenly at `speed` (m/s) by a very stiff hand, twenty times over 3 mm
/// around the arm's home. Farther out counts of the other joints reach x, each of them a full pulse
/// of the naive law. Real-time: never from the servo thread.
EvenSliding slide_evenly(stability::FrictionRigSettings rig, double speed);

}  // namespace thimble::studies
