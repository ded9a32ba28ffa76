#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "law_change.h"
#include "share/knob_requests.h"
#include "share/shared_scene.h"
#include "thimble/driver/tick_record.h"
#include "thimble/render/effect/live_settings.h"
#include "thimble/render/scene_touch.h"
#include "thimble/scene/scene_file.h"

namespace thimble::session {

/// The part of a tick on which the speed of a knob depends.
struct FeltTick {
  FeltTick() = default;
  /// Takes the part of a record; implicit, so that a record can be passed. Real-time: safe.
  FeltTick(const driver::TickRecord& record) noexcept
      : depth(record.depth),
        v_WT(record.v_WT),
        f_wanted_W(record.f_wanted_W),
        in_contact(record.in_contact) {}

  double depth = 0;                    ///< m
  std::array<double, 3> v_WT{};        ///< m/s
  std::array<double, 3> f_wanted_W{};  ///< N
  bool in_contact = false;             ///< Whether an object was touched.
};

/// Turns the settings of a scene that viewers or programs want otherwise, on the servo's thread
/// between two ticks, without a step of force.
///
/// A setting goes from end to end of its bounds in kTurnTime at the quickest. While it is felt it
/// goes no faster than changes the force by kForceRate: its ForceSensitivity, with the touch of the
/// last tick, tells how fast that is. Half of that is kept for the friction that follows the force
/// of the surface.
class LiveKnobs {
 public:
  static constexpr double kTurnTime = 0.05;  ///< s. [chosen: a hand takes longer]
  /// The most that a knob changes the force per time, N/s: 0.04 N in a tick of 1 kHz, less than
  /// a hand tells apart at 1 N [PHYSICS 6: 7 %].
  static constexpr double kForceRate = 40;

  /// Finds the settings of a scene's objects, at most kKnobsMost. Both must outlive it.
  /// Real-time: never from the servo thread.
  LiveKnobs(const scene::Scene& scene, render::SceneTouch& touch);

  /// Returns the knobs. Real-time: never from the servo thread.
  std::vector<SharedScene::Knob> described() const;

  /// Moves on by a tick of `dt` (s), towards what is wanted; `last` is the tick before. Returns
  /// whether a knob is still on its way. Real-time: safe; does next to nothing while no knob turns.
  bool step(KnobRequests& requests, const FeltTick& last, double dt) noexcept;

  /// Returns the knob that `step` began to turn in the last tick, and to what: at most one a tick,
  /// so that a tick of a recording holds it. Real-time: safe.
  const LawChange& change() const noexcept { return change_; }

  /// Returns a value as it is felt now. Real-time: safe.
  double value(std::size_t knob) const noexcept { return knobs_[knob].now; }

 private:
  struct Knob {
    std::string name;
    render::LiveSetting setting;
    double now = 0;
    double target = 0;              // that it is on its way to
    std::ptrdiff_t stiffness = -1;  // the knob of the same surface's stiffness, if it has one
  };

  std::vector<Knob> knobs_;
  LawChange change_;
};

}  // namespace thimble::session
