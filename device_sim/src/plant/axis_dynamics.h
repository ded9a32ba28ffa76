#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "plant/axis_response.h"
#include "thimble/device_sim/settings.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::device_sim {

/// Position and velocity of one axis of the tip.
struct AxisState {
  double x = 0;  ///< m
  double v = 0;  ///< m/s; exactly 0 while dry friction holds the axis.
};

/// Inputs of one axis during a step.
struct AxisDrive {
  double force = 0;         ///< Held over the step (zero-order hold), N.
  double anchor = 0;        ///< Wanted position of the hand when the step begins, m.
  double anchor_speed = 0;  ///< Velocity of that position, constant over the step, m/s.
};

/// Counters of events inside the steps.
struct AxisCounters {
  std::uint64_t reversals = 0;   ///< Velocity reached zero while sliding.
  std::uint64_t breakaways = 0;  ///< A moving anchor broke the axis loose.
  std::uint64_t unresolved = 0;  ///< Steps with more than kMaxEvents events; the axis then rested.
};

/// Moves one axis by its exact map:
///
///     m x'' = f - b v - c sgn(v) - k (x - a) - B (v - a'),    a(t) = a_0 + a' t,
///
/// with set-valued dry friction: at v = 0 it takes any value up to c that keeps the axis at rest. m
/// is the mass of arm and hand together, b and c the arm's friction, k and B the hand's spring and
/// damper. Between two events (velocity reaches zero, a held axis breaks loose) the motion is the
/// closed form of AxisMotion. Events are located to rounding error. The only approximations are
/// those of the drive: a held force and an anchor with constant velocity.
///
/// One object serves any number of axes with the same constants; it caches the maps of the last few
/// step lengths. Used by one thread.
class THIMBLE_EXPORT AxisDynamics {
 public:
  /// Max. number of events in one piece of a step. A smooth drive has at most a few.
  static constexpr int kMaxEvents = 16;

  /// Makes the dynamics. Fails if mass is not > 0 or anything else is negative or not finite.
  /// Real-time: never from the servo thread.
  static driver::Result<AxisDynamics> make(const PlantSettings& plant, const HandSettings& hand);

  /// Moves `state` by `dt_ns`; does nothing if dt_ns is not > 0. A drive that is not finite gives a
  /// state that is not finite. Real-time: safe; bounded by 1 + dt sqrt(k/m) / 1.5 pieces.
  void step(AxisState& state, const AxisDrive& drive, std::int64_t dt_ns) noexcept;

  /// Returns the moving mass of arm and hand, kg. Real-time: safe.
  double mass() const noexcept { return mass_; }
  double viscous() const noexcept { return damping_ * mass_; }        ///< Of arm and hand, N s/m.
  double coulomb() const noexcept { return friction_; }               ///< N
  double hand_stiffness() const noexcept { return hand_stiffness_; }  ///< N/m
  double hand_damping() const noexcept { return hand_damping_; }      ///< N s/m
  /// Returns the counters of all steps so far. Real-time: safe.
  const AxisCounters& counters() const noexcept { return counters_; }

 private:
  AxisDynamics(const PlantSettings& plant, const HandSettings& hand) noexcept;

  // Map of one step length. The step is divided into `pieces` equal pieces, each so short that the
  // acceleration changes its sign at most once in it.
  struct Map {
    std::int64_t dt_ns = 0;
    int pieces = 1;
    double t = 0;  // of one piece, s
    AxisResponse response;
  };

  const Map& map_for(std::int64_t dt_ns) noexcept;
  const Map& other_map_for(std::int64_t dt_ns) noexcept;
  double force_at_rest(double x, double anchor, const AxisDrive& drive) const noexcept;
  AxisMotion motion(double v, double net, const AxisDrive& drive) const noexcept;
  void step_with_events(AxisState& state, AxisDrive drive, double t) noexcept;

  double mass_;            // kg
  double inverse_mass_;    // 1/kg
  double friction_;        // Coulomb, N
  double hand_stiffness_;  // N/m
  double hand_damping_;    // N s/m
  double damping_;         // total damping per mass, 1/s
  double stiffness_;       // per mass, 1/s^2
  AxisCounters counters_;
  std::array<Map, 4> maps_;
  std::size_t last_map_ = 0;
};

}  // namespace thimble::device_sim
