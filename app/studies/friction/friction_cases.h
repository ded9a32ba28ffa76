#pragma once

#include <memory>
#include <string>
#include <vector>

#include "stability/friction_rig.h"
#include "thimble/render/effect/stage_list.h"

namespace thimble::studies {

/// One friction of the study, as in a scene: 0.5 of a load of 1 N.
struct FrictionCase {
  std::string name;               ///< For files and figures.
  std::string title;              ///< In words.
  std::string letter;             ///< Letter in the table of [PHYSICS 2.2]; empty: not in it.
  std::string kind;               ///< Name in the effect table.
  std::string word_key, word;     ///< A setting with a word as its value; none if empty.
  double static_coefficient = 0;  ///< 0: not set.
  double stiffness = 0;           ///< N/m, without the check of settings; 0: the limit of the arm.
};

/// Returns the frictions of the study, in the order of its table.
const std::vector<FrictionCase>& friction_cases();

/// Builds a friction for a rig. Precondition: it is one of friction_cases and its settings are
/// within the limits of the rig's arm.
/// Real-time: never from the servo thread.
std::unique_ptr<render::AnyStage> build_friction(const FrictionCase& which,
                                                 const stability::FrictionRigSettings& rig);

/// Measurements of one friction at one delay. Forces in N, positions in m, RMS above 50 Hz.
struct FrictionMeasures {
  double rest_force = 0;  ///< In the last second after a stop from 50 mm/s.
  double rest_way = 0;    ///< Of the tip, in that time.
  double rest_frequency =
      0;                   ///< Frequency of the force about its mean in that time, Hz; 0 if silent.
  double rest_held = 0;    ///< Mean held force in that time.
  double creep_force = 0;  ///< While the hand creeps at 1 mm/s.
  double creep_mean = 0;   ///< Mean friction in that time.
  double slow_mean = 0;    ///< Mean friction at 5 mm/s.
  double tremor_force = 0;  ///< The hand at rest, with a tremor of 300 um.
  stability::RigRun stop;   ///< The run of the stop, for pictures.
};

/// Time and position of the stop.
inline constexpr double kStopTime = 0.8;    // s
inline constexpr double kStopPlace = 0.01;  // m

/// Slides at 50 mm/s, stops at `stop` (m), and waits two seconds.
stability::RigRun stop_run(const FrictionCase& which, const stability::FrictionRigSettings& rig,
                           double stop = kStopPlace);

/// Measures a friction on a rig. Real-time: never from the servo thread.
FrictionMeasures measure(const FrictionCase& which, const stability::FrictionRigSettings& rig);

/// Force of the naive law at constant speed [PHYSICS 2.1].
struct EvenSliding {
  double mean = 0;    ///< N, against the motion.
  double ripple = 0;  ///< N RMS.
};

/// Slides the naive friction at constant `speed` (m/s) by a very stiff hand, twenty times over 3 mm
/// around the arm's home. Further away, counts of the other joints affect x, and each is a full
/// pulse of the naive law. Real-time: never from the servo thread.
EvenSliding slide_evenly(stability::FrictionRigSettings rig, double speed);

}  // namespace thimble::studies
