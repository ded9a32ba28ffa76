#pragma once

#include "thimble/driver/export.h"

namespace thimble::render {

/// The exact motion of a damped oscillator m x'' + b x' + k x = f over one step, with f held:
///
///     x+ = xx x + xv v + xf f        v+ = vx x + vv v + vf f
///
/// Exact at any stiffness, mass, damping and step, so it cannot diverge: the matrix is the flow of
/// a system that loses energy [PHYSICS 4]. For one node on its base point, or one mode of a mesh.
struct THIMBLE_EXPORT OscillatorStep {
  double xx = 1, xv = 0, xf = 0;  ///< 1, s, m/N
  double vx = 0, vv = 0, vf = 0;  ///< 1/s, 1, s/kg

  /// Computes the coefficients for `mass` (kg, > 0), `stiffness` (N/m, >= 0), `damping` (N s/m, >=
  /// 0) and `step` (s, >= 0); under-, critically and over-damped, and with neither spring nor
  /// damper, to 1e-12. For any other values, also NaN: a node that stays in place and stops.
  /// Real-time: safe; some 0.5 us, so call it once if nothing changes.
  static OscillatorStep of(double mass, double stiffness, double damping, double step) noexcept;

  /// Advances position `x` (m, from the rest of the spring) and velocity `v` (m/s) under the force
  /// `f` (N): numbers or vectors. Real-time: safe.
  template <class Value>
  void apply(Value& x, Value& v, const Value& f) const noexcept {
    const Value x_new = xx * x + xv * v + xf * f;
    v = vx * x + vv * v + vf * f;
    x = x_new;
  }
};

}  // namespace thimble::render
