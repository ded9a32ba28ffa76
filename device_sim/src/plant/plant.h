#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "plant/axis_dynamics.h"

namespace thimble::device_sim {

/// The mechanics of an arm of any geometry with a hand on it: motors exert torques on the joints,
/// the tip moves as a mass with friction. Frames: B base, T tip, H where the hand wants to be. All
/// functions are Real-time: safe.
class Plant {
 public:
  virtual ~Plant() = default;

  /// Sets the requested currents of the amplifiers, A. They saturate; a current that is not a
  /// number counts as zero.
  virtual void set_currents(const Eigen::Vector3d& amperes) noexcept = 0;

  /// Advances by 0 < dt_ns <= 1 ms, while the hand's point moves to p_BH (m) at constant velocity.
  /// At the end of reach the tip stays where it was, with no velocity.
  virtual void step(const Eigen::Vector3d& p_BH, std::int64_t dt_ns) noexcept = 0;

  /// Sets other constants of mass, friction and hand at the tip from now on: a hand lets go of the
  /// tip, or takes it. The motion of the tip continues unchanged.
  virtual void take_tip(const AxisDynamics& tip) noexcept = 0;

  /// Sets the force on the tip in addition to motors and hand, such as its weight, N in the base.
  virtual void set_pull(const Eigen::Vector3d& f_T_B) noexcept = 0;

  /// Returns the position of the tip, m.
  virtual Eigen::Vector3d p_BT() const noexcept = 0;
  /// Returns the velocity of the tip, m/s.
  virtual Eigen::Vector3d v_BT() const noexcept = 0;
  /// Returns the point where the hand wants the tip, m.
  virtual const Eigen::Vector3d& p_BH() const noexcept = 0;
  /// Returns the true joint angles, rad.
  virtual Eigen::Vector3d q() const noexcept = 0;
  /// Returns the joint angles with an error of at most kAboutError, in less time if the plant
  /// supports it.
  virtual Eigen::Vector3d q_about() noexcept { return q(); }
  /// Max. error of `q_about`, rad.
  static constexpr double kAboutError = 1e-12;
  /// Returns the actual currents, A.
  virtual const Eigen::Vector3d& currents() const noexcept = 0;
  /// Returns the motors' force on the tip, N.
  virtual Eigen::Vector3d f_T_B() const noexcept = 0;
  /// Returns the temperature of each motor's winding above the room, K; 0 if heat is not simulated.
  virtual Eigen::Vector3d winding_rise() const noexcept { return {0, 0, 0}; }
  /// Returns the number of sub-steps that ended at a mechanical stop.
  virtual std::uint64_t stops() const noexcept = 0;

 protected:
  Plant() = default;
  Plant(const Plant&) = default;
  Plant& operator=(const Plant&) = default;
};

}  // namespace thimble::device_sim
