#pragma once

#include "loop_latency.h"

namespace thimble::stability {

// The laws of [PHYSICS 1.1 to 1.5 and 2.3] as pure functions, for one direction of motion;
// worst_direction.h defines the worst direction. Letters as there. m, b, c: mass, viscous and dry
// friction of the device (with the hand, if a caller adds it). K, B: stiffness and damping of the
// wall. T: the period. d: the encoder step. SI throughout. Arguments that are not finite give
// results that are not. Real-time: never from the servo thread.

/// As `stiffness_limit`, including the effect of latency on the oscillation's period: (b / L) u /
/// sin u with u tan u = b L / m. From m x'' + b x' + K x(t - L) = 0 at the edge, x = e^{i w t}, u =
/// w L: K cos u = m w^2 and K sin u = b w. For small latencies it exceeds `stiffness_limit` by the
/// share b L / (6 m).
double late_stiffness_limit(double damping, double latency, double mass);

/// Returns the largest stiffness with which a wall is passive for any passive hand, N/m; 0 if there
/// is none. Each angle a requires (K T / 2) sin((d + 1/2) a) / sin(a / 2) - B cos((1 + d) a) <= b,
/// with `wall_damping` B, `viscous` friction b of the device and d the delay in periods [PHYSICS
/// 1.2, Colgate and Schenkel; form with delay derived there].
double passive_stiffness(double viscous, double wall_damping, double period, double delay = 0);

/// Returns the stiffness that is passive with coarse encoders, min(2 b / T, 2 c / d), N/m [PHYSICS
/// 1.3, Abbott and Okamura]. Without encoder steps the second bound does not apply.
double passive_stiffness_quantised(double viscous, double coulomb, double encoder_step,
                                   double period);

/// Returns the speed of an oscillation above which dry friction no longer stops it, m/s: (4 / pi) c
/// / (K L - b) [PHYSICS 1.4]; infinite if K L <= b. `latency` as in `latency_of`.
double oscillation_speed_limit(double stiffness, double viscous, double coulomb, double latency);

/// Returns the mean restitution of an impact of a free mass, exp(-pi (b + B - K L) / (2 sqrt(K m)))
/// [PHYSICS 1.5]; above 1 the wall gives energy. `damping` is b + B.
double restitution(double stiffness, double damping, double mass, double latency);

/// Returns the min. deflection of a friction's bristle before it slides, m: max(1.5 F L / b, F d /
/// (2 c)) [PHYSICS 2.3]; `damping` b of arm and hand, `coulomb` c of the arm only. Infinite if the
/// encoder has steps and the arm no dry friction.
double bristle_length(double friction_force, double latency, double damping, double encoder_step,
                      double coulomb);

/// A wall in a linear loop from encoder to motor: no dry friction, no steps.
struct SampledWall {
  double mass = 0;             ///< Mass of arm and hand, kg.
  double viscous = 0;          ///< Viscous friction of arm and hand, N s/m.
  double hand_stiffness = 0;   ///< N/m
  double stiffness = 0;        ///< Stiffness of the wall, N/m.
  double damping = 0;          ///< Damping of the wall, by backward difference, N s/m.
  double velocity_corner = 0;  ///< Pole of the velocity estimate, Hz; 0: none.
  double period = 0.001;       ///< s
  double delay = 0;            ///< s, any multiple of the period up to 32.
  double amplifier_lag = 0;    ///< s
  /// Stiffness of a cable between the motor, on which the wall acts and whose encoder it reads, and
  /// the tip with the hand, N/m; 0: rigid.
  double cable_stiffness = 0;
  double cable_damping = 0;  ///< N s/m
  double rotor_mass = 0;     ///< Motor mass at the tip, kg; with an elastic cable.
};

/// Returns the growth of the wall's slowest mode per tick: the spectral radius of the exact map of
/// one tick; below 1 it decays. For regimes in which `stiffness_limit` is not yet exact.
double growth_per_tick(const SampledWall& wall);

/// Returns the largest stiffness at which a delayed spring balances the arm, N/m. It is the
/// smallest K with K S e^(-i w L) = -Z(w) at some w > 0 below half the loop's rate. L is half a
/// period, the delay and the amplifier's lag, which counts by its phase at low frequency [PHYSICS
/// 1.1]. S = sin(w T / 2) / (w T / 2) is the attenuation by the hold. Z is the arm's force over
/// displacement at the motor, Z = -w^2 M + C H / (C + H); without a cable Z = H. H = h + i w b -
/// w^2 m is that of tip and hand, C = k + i w d that of the cable. `wall.stiffness`, `damping` and
/// `velocity_corner` are ignored. 0 if there is none.
double limit_by_phase(const SampledWall& wall);

/// Returns the largest stiffness up to which the wall does not grow, N/m, by bisection to 1e-6 of
/// it; 0 if even 1 N/m grows. Behind a cable a stiffer wall may be stable again, so a narrow
/// unstable band of stiffness is searched for where `limit_by_phase` predicts its beginning.
/// `wall.stiffness` is ignored.
double stiffness_edge(SampledWall wall);

}  // namespace thimble::stability
