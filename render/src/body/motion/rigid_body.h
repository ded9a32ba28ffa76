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

/// Settings of a rigid body and its loads, in addition to contact.
struct RigidBodySettings {
  MassProperties mass;                 ///< Mass, centre, inertia.
  Eigen::Vector3d gravity_W{0, 0, 0};  ///< m/s^2
  double damping = 0;                  ///< N s/m, >= 0
  double angular_damping = 0;          ///< N m s, >= 0: the torque is this times the turning rate.
  /// The body's time over ours, > 0. A smaller one feels heavier, as 1 / time_scale^2 times the
  /// mass, and as if in a viscous liquid [BP 4.3].
  double time_scale = 1;
  std::optional<Floor> floor{};  ///< Floor that the body cannot pass.
  /// Points that can rest on the floor, m in B; at most kSupportMax. Normally corners of the hull.
  std::vector<Eigen::Vector3d> support_B;
};

/// Moves and turns a rigid body in time [BP 4.3].
///
/// Momentum and angular momentum are stored, in W, so that only forces change them. It turns by
/// `FreeTurn`, of order 4 in time. The angular momentum is kept to rounding for any step, so a body
/// cannot spin itself up.
class THIMBLE_EXPORT RigidBody {
 public:
  static constexpr std::size_t kSupportMax = 64;  ///< Maximum number of support points.

  /// Makes a body at rest at the place of its mass properties. The error names an invalid number.
  /// Real-time: never from the servo thread.
  static driver::Result<RigidBody> build(const RigidBodySettings& settings);

  // All of the following are Real-time: safe.

  /// Pushes with `f_W` (N) at the point `p_W` (m), and turns with `tau_W` (N m), during the next
  /// step. Values that are NaN or beyond 10^6 are ignored.
  void push(const Eigen::Vector3d& f_W, const Eigen::Vector3d& p_W) noexcept;
  /// Sets the force (N) and the torque about C (N m) of all pushes during the next step. Values
  /// that are NaN or beyond 10^6 are ignored.
  void load(const Eigen::Vector3d& f_W, const Eigen::Vector3d& tau_W) noexcept;
  /// Moves the body and sets its velocities (m/s, rad/s, in the body's own time). The pushes are
  /// cleared.
  void place(const Eigen::Vector3d& p_WC, const Eigen::Quaterniond& q_WB,
             const Eigen::Vector3d& v_W, const Eigen::Vector3d& omega_W) noexcept;
  /// Advances by `step` s under the pushes, which are then cleared. An invalid step has no effect.
  void step(double step) noexcept;

  /// Sets momentum (kg m/s) and angular momentum about C (kg m^2/s).
  void set_momentum(const Eigen::Vector3d& momentum_W, const Eigen::Vector3d& angular_W) noexcept {
    momentum_W_ = momentum_W;
    angular_W_ = angular_W;
  }

  const Eigen::Vector3d& p_WC() const noexcept { return p_WC_; }  ///< Returns the position of C, m.
  const Eigen::Quaterniond& q_WB() const noexcept { return q_WB_; }  ///< Returns the orientation.
  /// Returns the momentum, kg m/s, in the body's own time.
  const Eigen::Vector3d& momentum_W() const noexcept { return momentum_W_; }
  /// Returns the angular momentum about C, kg m^2/s, in the body's own time.
  const Eigen::Vector3d& angular_momentum_W() const noexcept { return angular_W_; }
  const RigidBodySettings& settings() const noexcept { return settings_; }
  /// Returns the velocity of C, m/s, in the body's own time.
  Eigen::Vector3d v_WC() const noexcept { return momentum_W_ / settings_.mass.mass; }
  Eigen::Vector3d omega_W() const noexcept;  ///< Returns the angular velocity, rad/s.
  /// Returns the velocity (m/s, in our time) of the body's point at `p_W`.
  Eigen::Vector3d velocity_at(const Eigen::Vector3d& p_W) const noexcept;
  /// Returns the velocity (m/s, in our time) that the body's point at `p_W` gains by an impulse (N
  /// s, in our time) given there.
  Eigen::Vector3d gain_at(const Eigen::Vector3d& p_W,
                          const Eigen::Vector3d& impulse) const noexcept {
    return settings_.time_scale * settings_.time_scale * velocity_response(p_W - p_WC_, impulse);
  }
  /// Keeps C within `reach` m of its first place: moves it back and removes the outward momentum,
  /// so that energy only falls. An invalid reach has no effect.
  void keep_within(double reach) noexcept;
  /// Returns the number of half steps in which the floor's impulses were less accurate than
  /// FloorImpulses::kTolerance.
  std::uint64_t floor_unsolved() const noexcept { return floor_unsolved_; }
  /// Returns the present position of the body's point that was at `p_W` at first, m.
  Eigen::Vector3d moved(const Eigen::Vector3d& p_W) const noexcept {
    return p_WC_ + q_WB_ * (settings_.mass.q_WB.conjugate() * (p_W - settings_.mass.p_WC));
  }
  /// Returns the kinetic energy, J.
  double kinetic_energy() const noexcept;
  double potential_energy() const noexcept;  ///< Returns the energy of height over the origin, J.

 private:
  explicit RigidBody(const RigidBodySettings& settings)
      : settings_(settings),
        free_turn_(settings.mass.inertia),
        p_WC_(settings.mass.p_WC),
        q_WB_(settings.mass.q_WB) {}
  Eigen::Vector3d velocity_response(const Eigen::Vector3d& arm,
                                    const Eigen::Vector3d& f) const noexcept;
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
