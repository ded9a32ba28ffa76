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

/// Part of a tick on which the speed of a knob depends.
struct KnobTick {
  KnobTick() = default;
  /// Copies the part from a record; implicit, so that a record can be passed. Real-time: safe.
  KnobTick(const driver::TickRecord& record) noexcept
      : depth(record.depth),
        v_WT(record.v_WT),
        f_wanted_W(record.f_wanted_W),
        in_contact(record.in_contact) {}

  double depth = 0;                    ///< Penetration depth, m.
  std::array<double, 3> v_WT{};        ///< Velocity of the tip, m/s.
  std::array<double, 3> f_wanted_W{};  ///< Requested force, N.
  bool in_contact = false;             ///< True if an object was touched.
};

/// Changes the settings of a scene that viewers or programs request, on the servo's thread between
/// two ticks, without a step in force.
///
/// A change over the whole range of a setting takes at least kTurnTime. During contact a setting
/// changes the force at a rate of at most kForceRate, computed from its ForceSensitivity and the
/// contact of the last tick. Half of that rate is reserved for friction that follows the force of
/// the surface.
class LiveKnobs {
 public:
  /// Shortest time of a change over the whole range, s. [chosen: a hand takes longer]
  static constexpr double kTurnTime = 0.05;
  /// Largest rate at which a knob changes the force, N/s: 0.04 N in a tick of 1 kHz, below the just
  /// noticeable difference at 1 N [PHYSICS 6: 7 %].
  static constexpr double kForceRate = 40;

  /// Collects the settings of a scene's objects, at most kKnobsMax. Both arguments must outlive
  /// it. Real-time: never from the servo thread.
  LiveKnobs(const scene::Scene& scene, render::SceneTouch& touch);

  /// Returns the description of the knobs. Real-time: never from the servo thread.
  std::vector<SharedScene::Knob> described() const;

  /// Advances the knobs by a tick of `dt` (s) towards the requested values; `last` is the previous
  /// tick. Returns whether a knob is still changing. Real-time: safe; costs almost nothing while no
  /// knob changes.
  bool step(KnobRequests& requests, const KnobTick& last, double dt) noexcept;

  /// Returns the knob whose change `step` started in the last tick, with its target. There is at
  /// most one per tick, so that a tick of a recording can hold it. Real-time: safe.
  const LawChange& change() const noexcept { return change_; }

  /// Returns the current value of a knob. Real-time: safe.
  double value(std::size_t knob) const noexcept { return knobs_[knob].now; }

 private:
  struct Knob {
    std::string name;
    render::LiveSetting setting;
    double now = 0;
    double target = 0;  // Target of the change.
    // Knob of the stiffness of the same surface, -1 if there is none.
    std::ptrdiff_t stiffness = -1;
  };

  std::vector<Knob> knobs_;
  LawChange change_;
};

}  // namespace thimble::session
