#pragma once

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/render/body/spring_scheme.h"
#include "thimble/render/effect/effect_context.h"
#include "thimble/render/effect/settings_reader.h"

namespace thimble::render {

/// Sets how the surface of an object dents under the cursor [BP 4.2]: every vertex hangs on its
/// base point by a spring and a damper, and on its neighbours by others.
struct THIMBLE_EXPORT DentSettings {
  double mass = 1e-3;               ///< Of each vertex, kg, > 0.
  double stiffness = 200;           ///< Of a vertex to its base point, N/m, > 0.
  double damping = 0.2;             ///< Of the same, N s/m, >= 0.
  double neighbour_stiffness = 50;  ///< Between two vertices that an edge joins, N/m, >= 0.
  double neighbour_damping = 0;     ///< Of the same, N s/m, >= 0.
  /// How much stronger the cursor's springs are than those that hold the surface, > 0: 1 makes a
  /// dent with straight sides; less a narrow one (water balloon), more a wide one (trampoline).
  double reach = 1;
  /// Share of the springs' pull that the hand feels as well, 0 to 1.
  double pull = 0;
  bool whole = false;  ///< All vertices move, not only those near the cursor.
  int rings = 3;       ///< How many springs from the touched triangle the moving ones end, 0 to 8.
  SpringScheme integrator = kDefaultScheme;  ///< How its springs are stepped.
  int substeps = 1;  ///< Per tick, at least; more where the integrator needs them.
  int rounds = 25;   ///< Of the implicit integrators per substep, at most.
  /// Remainder of one step at which rounds end early, as a share of what springs and dampers have
  /// to change of the momentum in it. Below what is felt [PHYSICS 6: 7 %], and no remainder harms
  /// stability.
  double remainder = 1e-2;
  double step = 1e-3;  ///< Time of one tick, s, > 0.

  static constexpr int kRingsMax = 8;  ///< Most rings of vertices.

  /// Reads the settings of a scene; `step` is that of the loop. Real-time: never from the servo
  /// thread.
  void read(SettingsReader& reader, const EffectContext& context);

  /// Returns what about the settings is beyond all sense: a mass or stiffness that is not positive,
  /// a number that is negative or not finite. Real-time: never from the servo thread.
  driver::Result<void> check() const;
};

}  // namespace thimble::render
