#pragma once

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/render/body/spring_scheme.h"
#include "thimble/render/effect/effect_context.h"
#include "thimble/render/effect/settings_reader.h"

namespace thimble::render {

/// Settings for a surface that dents under the cursor [BP 4.2]. Springs and dampers connect every
/// vertex to its base point and to its neighbours.
struct THIMBLE_EXPORT DentSettings {
  double mass = 1e-3;               ///< Mass of each vertex, kg, > 0.
  double stiffness = 200;           ///< Stiffness between a vertex and its base point, N/m, > 0.
  double damping = 0.2;             ///< Damping between a vertex and its base point, N s/m, >= 0.
  double neighbour_stiffness = 50;  ///< Stiffness between two vertices of an edge, N/m, >= 0.
  double neighbour_damping = 0;     ///< Damping between two vertices of an edge, N s/m, >= 0.
  /// Ratio of the cursor's spring stiffness to that of the springs that hold the surface, > 0. 1:
  /// dent with straight sides; smaller: narrow dent (water balloon); larger: wide dent
  /// (trampoline).
  double reach = 1;
  /// Fraction of the springs' pull that acts on the hand, 0 to 1.
  double pull = 0;
  /// True if all vertices move, not only those near the cursor.
  bool whole = false;
  /// Number of rings of moving vertices around the touched triangle, 0 to 8.
  int rings = 3;
  SpringScheme integrator = kDefaultScheme;  ///< Integration scheme of the springs.
  /// Minimum number of substeps per tick; the integrator may need more.
  int substeps = 1;
  /// Maximum number of iterations of implicit integrators per substep.
  int rounds = 25;
  /// Residual at which the iterations of a step end early, as a fraction of the momentum change by
  /// springs and dampers in that step. It is below the limit of perception [PHYSICS 6: 7 %]. No
  /// residual affects stability.
  double remainder = 1e-2;
  double step = 1e-3;  ///< Period of a tick, s, > 0.

  static constexpr int kRingsMax = 8;  ///< Largest number of rings.

  /// Reads the settings from a scene; `step` is the period of the loop. Real-time: never from the
  /// servo thread.
  void read(SettingsReader& reader, const EffectContext& context);

  /// Fails if a mass or stiffness is not positive, or a number is negative or not finite.
  /// Real-time: never from the servo thread.
  driver::Result<void> check() const;
};

}  // namespace thimble::render
