#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "plant/axis_dynamics.h"

namespace thimble::device_sim {

/// The mechanics of an arm with a hand on it, whatever its build: motors pull on the joints, the
/// tip moves as a mass with friction. Frames: B base, T tip, H where the hand wants to be. All
/// functions are Real-time: safe.
class Plant {
 public:
  virtual ~Plant() = default;

  /// Sets what the amplifiers are asked for, A. They saturate; what is not a number counts as zero.
  virtual void set_currents(const Eigen::Vector3d& amperes) noexcept = 0;

  /// Lets 0 < dt_ns <= 1 ms pass, while the point the hand wants moves evenly to p_BH (m). At the
  /// end of reach the tip stays where it was, with no velocity.
  virtual void step(const Eigen::Vector3d& p_BH, std::int64_t dt_ns) noexcept = 0;

  /// Gives mass, friction and hand at the tip other constants from now on: a hand lets go of the
  /// tip, or takes it. How the tip moves stays as it is.
  virtual void take_tip(const AxisDynamics& tip) noexcept = 0;

  /// Sets what pulls on the tip beside motors and hand, such as its weight, N in the base.
  virtual void set_pull(const Eigen::Vector3d& f_T_B) noexcept = 0;

  /// Returns where the tip is, m.
  virtual Eigen::Vector3d p_BT() const noexcept = 0;
  /// Returns how the tip moves, m/s.
  virtual Eigen::Vector3d v_BT() const noexcept = 0;
  /// Returns where the hand wants the tip, m.
  virtual const Eigen::Vector3d& p_BH() const noexcept = 0;
  /// Returns the true joint angles, rad.
  virtual Eigen::Vector3d q() const noexcept = 0;
  /// Returns the same to within kAboutError, for less work where the plant knows how.
  virtual Eigen::Vector3d q_about() noexcept { return q(); }
  /// The most that `q_about` is wrong by, rad.
  static constexpr double kAboutError = 1e-12;
  /// Returns the currents that flow, A.
  virtual const Eigen::Vector3d& currents() const noexcept = 0;
  /// Returns the motors' force on the tip, N.
  virtual Eigen::Vector3d f_T_B() const noexcept = 0;
  /// Returns how much warmer than the room each motor's winding is, K; 0 where heat is not named.
  virtual Eigen::Vector3d winding_rise() const noexcept { return {0, 0, 0}; }
  /// Returns how many sub-steps ended at a mechanical stop.
  virtual std::uint64_t stops() const noexcept = 0;

 protected:
  Plant() = default;
  Plant(const Plant&) = default;
  Plant& operator=(const Plant&) = default;
};

}  // namespace thimble::device_sim
