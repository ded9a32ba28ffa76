#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "body/motion/free_turn.h"
#include "body/motion/mass_properties.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/render/body/motion_choice.h"

namespace thimble::render {

/// Sets what acts on a body besides what touches it, as data.
struct RigidBodySettings {
  MassProperties mass;                 ///< Mass, centre, inertia.
  Eigen::Vector3d gravity_W{0, 0, 0};  ///< m/s^2
  double damping = 0;                  ///< N s/m, >= 0
  double angular_damping = 0;          ///< N m s, >= 0: the torque is this times the turning rate.
  /// The body's time over ours, > 0: smaller feels heavier, as 1 / time_scale^2 times the mass,
  /// and as if in a thick liquid [BP 4.3].
  double time_scale = 1;
  std::optional<Floor> floor{};  ///< Where it cannot go below.
  /// Points that stand on the floor, m in B; kSupportMax at most. Corners of the hull do.
  std::vector<Eigen::Vector3d> support_B;
};

/// Moves and turns a rigid body in time [BP 4.3].
///
/// Momentum and angular momentum are what is stored, in W, so that nothing but forces changes them.
/// It turns by `FreeTurn`: of order 4 in time, and the angular momentum is kept to rounding
/// whatever the step is, so a body cannot spin itself up.
class THIMBLE_EXPORT RigidBody {
 public:
  static constexpr std::size_t kSupportMax = 64;  ///< Most points of its hull on the floor.

  /// Makes a body at rest where its mass properties put it. The error says which number a body
  /// cannot have. Real-time: never from the servo thread.
  static driver::Result<RigidBody> build(const RigidBodySettings& settings);

  // All of the following are Real-time: safe.

  /// Pushes with `f_W` (N) at the point `p_W` (m), and turns with `tau_W` (N m), during the next
  /// step. What is NaN, or beyond 10^6, is left out.
  void push(const Eigen::Vector3d& f_W, const Eigen::Vector3d& p_W) noexcept;
  /// Moves on by `step` s under what was pushed, which is then gone. Nonsense: stays.
  void step(double step) noexcept;

  /// Gives momentum (kg m/s) and angular momentum about C (kg m^2/s) at once.
  void set_momentum(const Eigen::Vector3d& momentum_W, const Eigen::Vector3d& angular_W) noexcept {
    momentum_W_ = momentum_W;
    angular_W_ = angular_W;
  }

  const Eigen::Vector3d& p_WC() const noexcept { return p_WC_; }     ///< Returns where C is, m.
  const Eigen::Quaterniond& q_WB() const noexcept { return q_WB_; }  ///< Returns how it is turned.
  /// Returns the momentum, kg m/s, in the body's own time.
  const Eigen::Vector3d& momentum_W() const noexcept { return momentum_W_; }
  /// Returns the angular momentum about C, kg m^2/s, in the body's own time.
  const Eigen::Vector3d& angular_momentum_W() const noexcept { return angular_W_; }
  const RigidBodySettings& settings() const noexcept { return settings_; }
  /// Returns the velocity of C (m/s) and the turning rate (rad/s), in the body's own time.
  Eigen::Vector3d v_WC() const noexcept { return momentum_W_ / settings_.mass.mass; }
  Eigen::Vector3d omega_W() const noexcept;  ///< Returns the turning rate, rad/s.
  /// Returns the velocity (m/s, in our time) of the body's point at `p_W`.
  Eigen::Vector3d velocity_at(const Eigen::Vector3d& p_W) const noexcept;
  /// Returns which velocity (m/s, in our time) the body's point at `p_W` gains by an impulse (N s,
  /// in our time) given there.
  Eigen::Vector3d gain_at(const Eigen::Vector3d& p_W,
                          const Eigen::Vector3d& impulse) const noexcept {
    return settings_.time_scale * settings_.time_scale * give(p_W - p_WC_, impulse);
  }
  /// Keeps C within `reach` m of where it was at first: puts it back and takes the momentum that
  /// leads away, so that energy only falls. Nonsense: nothing.
  void keep_within(double reach) noexcept;
  /// Counts half steps in which the floor's impulses ended less accurate than
  /// FloorImpulses::kTolerance.
  std::uint64_t floor_unsolved() const noexcept { return floor_unsolved_; }
  /// Returns where a point of the body that was at `p_W` at first is now, m.
  Eigen::Vector3d moved(const Eigen::Vector3d& p_W) const noexcept {
    return p_WC_ + q_WB_ * (settings_.mass.q_WB.conjugate() * (p_W - settings_.mass.p_WC));
  }
  /// Returns the energy of motion, and of height over the origin where there is gravity, J.
  double kinetic_energy() const noexcept;
  double potential_energy() const noexcept;  ///< Returns the energy of height, J.

 private:
  explicit RigidBody(const RigidBodySettings& settings)
      : settings_(settings),
        free_turn_(settings.mass.inertia),
        p_WC_(settings.mass.p_WC),
        q_WB_(settings.mass.q_WB) {}
  Eigen::Vector3d give(const Eigen::Vector3d& arm, const Eigen::Vector3d& f) const noexcept;
  void kick(double time) noexcept;
  void fade() noexcept;
  void prepare_fading(double time) noexcept;
  Eigen::Quaterniond middle_of_turn(double time) const noexcept;
  void stand_on_floor(double time, const Eigen::Quaterniond& q_WB) noexcept;
  void lift_out() noexcept;

  /// Factors of half a step of damping.
  struct Fading {
    double time = 0;  // s, of the step that they are for
    double momentum = 1;
    Eigen::Vector3d angular{1, 1, 1};
  };

  RigidBodySettings settings_;
  FreeTurn free_turn_;
  Fading fading_;
  Eigen::Vector3d p_WC_;
  Eigen::Quaterniond q_WB_;
  Eigen::Vector3d momentum_W_{0, 0, 0};
  Eigen::Vector3d angular_W_{0, 0, 0};
  Eigen::Vector3d f_W_{0, 0, 0};
  Eigen::Vector3d tau_W_{0, 0, 0};
  std::uint64_t floor_unsolved_ = 0;
};

}  // namespace thimble::render
