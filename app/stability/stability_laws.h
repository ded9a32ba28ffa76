#pragma once

#include "loop_latency.h"

namespace thimble::stability {

// The laws of [PHYSICS 1.1 to 1.5 and 2.3] as pure functions, for one direction of motion;
// worst_direction.h finds the worst direction. Symbols as there: m, b, c are mass, viscous and dry
// friction of the device (with the hand, if a caller adds it). K, B are stiffness and damping of
// the wall, T is the period, d the encoder step. SI units. Arguments that are not finite give
// results that are not finite. Real-time: never from the servo thread.

/// Returns the same limit with the effect of latency on the oscillation's period: (b / L) u / sin u
/// with u tan u = b L / m. From m x'' + b x' + K x(t - L) = 0 at the edge, x = e^{i w t}, u = w L:
/// K cos u = m w^2 and K sin u = b w. For small values it exceeds `stiffness_limit` by b L / (6 m)
/// of it.
double late_stiffness_limit(double damping, double latency, double mass);

/// Returns the largest stiffness of a wall that is passive for any passive hand, N/m; 0 if there is
/// none. The condition at each angle a is (K T / 2) sin((d + 1/2) a) / sin(a / 2) - B cos((1 + d)
/// a) <= b. B is `wall_damping`, b the `viscous` friction of the device, and d the delay in periods
/// [PHYSICS 1.2, Colgate and Schenkel; form with delay derived there].
double passive_stiffness(double viscous, double wall_damping, double period, double delay = 0);

/// Returns the passive stiffness with coarse encoders, min(2 b / T, 2 c / d), N/m
/// [PHYSICS 1.3, Abbott and Okamura]. Without encoder steps only the first bound applies.
double passive_stiffness_quantised(double viscous, double coulomb, double encoder_step,
                                   double period);

/// Returns the speed of an oscillation above which dry friction no longer suppresses it, m/s:
/// (4 / pi) c / (K L - b) [PHYSICS 1.4]; infinite if K L <= b. `latency` as `latency_of`.
double oscillation_speed_limit(double stiffness, double viscous, double coulomb, double latency);

/// Returns the mean restitution of an impact of a free mass, exp(-pi (b + B - K L) / (2 sqrt(K m)))
/// [PHYSICS 1.5]; above 1 the wall adds energy. `damping` is b + B.
double restitution(double stiffness, double damping, double mass, double latency);

/// Returns the required deflection of a friction's bristle before it slides, m:
/// max(1.5 F L / b, F d / (2 c)) [PHYSICS 2.3]; `damping` b of arm and hand, `coulomb` c of the arm
/// only. Infinite if the encoder has steps and the arm no dry friction.
double bristle_length(double friction_force, double latency, double damping, double encoder_step,
                      double coulomb);

/// A wall with a linear loop between encoder and motor: no dry friction, no encoder steps.
struct SampledWall {
  double mass = 0;             ///< Of arm and hand, kg.
  double viscous = 0;          ///< Of arm and hand, N s/m.
  double hand_stiffness = 0;   ///< N/m
  double stiffness = 0;        ///< Of the wall, N/m.
  double damping = 0;          ///< Of the wall, by backward difference, N s/m.
  double velocity_corner = 0;  ///< Pole of the velocity estimate, Hz; 0: none.
  double period = 0.001;       ///< s
  double delay = 0;            ///< s, any multiple of the period up to 32.
  double amplifier_lag = 0;    ///< s
  /// Stiffness of the cable between the motor and the tip with the hand, N/m; 0: rigid. The wall
  /// acts on the motor and reads its encoder.
  double cable_stiffness = 0;
  double cable_damping = 0;  ///< N s/m
  double rotor_mass = 0;     ///< Effective rotor mass at the tip, kg; only with an elastic cable.
};

/// Returns the growth of the wall's slowest mode per tick: the spectral radius of the exact map of
/// one tick; below 1 the wall is stable. For regimes in which `stiffness_limit` is not exact.
double growth_per_tick(const SampledWall& wall);

/// Returns the largest stiffness at which a delayed spring balances the arm, N/m: the smallest K
/// with
/// K S e^(-i w L) = -Z(w) at some w > 0 below half the loop's rate. L is half a period, the delay
/// and the amplifier's lag, which counts by its phase at low frequency [PHYSICS 1.1]. S = sin(w T /
/// 2) / (w T / 2) is the gain of the hold. Z is the arm's force over displacement at the motor, Z =
/// -w^2 M + C H / (C + H). In it, H = h + i w b - w^2 m is tip and hand, and C = k + i w d the
/// cable; without a cable Z = H. `wall.stiffness`, `damping` and `velocity_corner` are ignored. 0
/// if there is none.
double limit_by_phase(const SampledWall& wall);

/// Returns the largest stiffness up to which the wall does not grow, N/m, by bisection to 1e-6 of
/// it; 0 if even 1 N/m grows. With a cable, a stiffer wall may be stable again: a narrow unstable
/// band of stiffness is searched for where `limit_by_phase` predicts its begin. `wall.stiffness` is
/// ignored.
double stiffness_edge(SampledWall wall);

}  // namespace thimble::stability
