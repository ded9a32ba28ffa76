#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>

namespace thimble::render {

/// Impulses of a floor on a rigid body at one moment: no rebound, Coulomb friction at each support
/// point.
///
/// Let v_i be the velocity of support point i after the impulses r_i, split into the part along the
/// floor's normal and the part along the floor. The impulses satisfy, at all points at once,
///
///     v_n >= -allowed,   r_n >= 0,   r_n (v_n + allowed) = 0,
///     |r_t| <= mu r_n,   and where v_t is not 0, r_t = -mu r_n v_t / |v_t|.
///
/// For a given slip s_i = |v_t| these are the conditions of a convex problem in the body's six
/// velocities. Its solution is the closest velocity, measured by the kinetic energy, with v_n +
/// allowed >= mu (|v_t| - s_i) [DeSaxce, Cadoux]. The problem is solved by an augmented Lagrangian,
/// whose smooth convex function is minimised by Newton's method with a line search. The slips are
/// updated with the multipliers, by the secant of the last two. Accumulated impulses are projected
/// onto their cones as a whole, so an impulse that was too large is reduced again. The result does
/// not depend on the order of the points. If several distributions of the load give the same
/// motion, the most even one is chosen. The kinetic energy never rises, and no point goes through
/// the floor. If the iteration ends early, the impulses are scaled down until the energy does not
/// rise. Points that still approach too fast are stopped without friction.
class FloorImpulses {
 public:
  static constexpr std::size_t kPointsMax = 64;  ///< Maximum number of support points.
  /// Accuracy of the velocities of the support points at which the iteration ends, as a share of
  /// the fastest one's before.
  static constexpr double kTolerance = 1e-7;

  /// Takes the body's mass (kg) and principal inertias (kg m^2), the floor's normal (unit) and
  /// friction coefficient (>= 0). All vectors of this class are in the frame B of the principal
  /// axes. Real-time: safe.
  FloorImpulses(double mass, const Eigen::Vector3d& inertia, const Eigen::Vector3d& n_B,
                double friction) noexcept;

  /// Adds the support point at `arm_B` (m, from the centre of mass), which may approach the floor
  /// at `allowed` m/s. Precondition: fewer than `kPointsMax` were added. Real-time: safe.
  void add(const Eigen::Vector3d& arm_B, double allowed) noexcept;

  /// Changes the velocity of the centre of mass (m/s) and the angular velocity (rad/s) by the
  /// impulses. Returns whether `kTolerance` was reached within the bounded number of iterations.
  /// Velocities that are not finite are left as they are. Real-time: safe; on
  /// average 5 iterations of about 0.1 us per point, at worst twice `kPointStepsMax` such steps.
  bool solve(Eigen::Vector3d& v_B, Eigen::Vector3d& omega_B) noexcept;

  /// Returns how many iterations of Newton's method the last `solve` took. Real-time: safe.
  int iterations() const noexcept { return iterations_; }

  /// Maximum number of iterations of Newton's method on few points; on many, `kPointStepsMax`
  /// divided by their number. After reaching this bound, up to as many again, without friction.
  static constexpr int kIterationsMax = 200;
  static constexpr int kPointStepsMax = 2400;  ///< Maximum of iterations times points.

 private:
  // Velocities of the body in units of the root of its mass and inertias: the squared length is
  // twice the kinetic energy.
  using Velocity = Eigen::Matrix<double, 6, 1>;
  using Matrix6 = Eigen::Matrix<double, 6, 6>;

  // Velocities and impulses of a point are in the frame of the floor: normal, then two tangents.
  struct Point {
    Eigen::Matrix<double, 3, 6> J;  // velocity of the point by the body's velocity
    double allowed = 0;             // m/s
    double slip = 0;                // m/s along the floor, as estimated
    double wrong = 0;               // m/s by which the last estimate was too small
    double slip_before = 0;         // slip and error of the estimate before
    double wrong_before = 0;
    Eigen::Vector3d held{0, 0, 0};  // impulse of the multiplier, N s
    Eigen::Vector3d v{0, 0, 0};     // of the point, m/s
    // Starts a new solution.
    void forget() noexcept {
      slip = wrong = slip_before = wrong_before = 0;
      held.setZero();
    }

    Eigen::Vector3d change{0, 0, 0};  // of v along the direction of search
  };

  Eigen::Vector3d impulse(const Point& point, const Eigen::Vector3d& v) const noexcept;
  void add_curvature(const Point& point, Matrix6& hessian) const noexcept;
  Eigen::Vector3d pressed(const Point& point, const Eigen::Vector3d& v) const noexcept;
  void minimise(const Velocity& start, double small, Velocity& y) noexcept;
  double search(const Velocity& start, const Velocity& y, const Velocity& way,
                double slope) const noexcept;
  double update() noexcept;
  bool iterate(const Velocity& start, double small, double tolerance, Velocity& y) noexcept;
  Velocity without_gain(const Velocity& start, const Velocity& y) const noexcept;
  int iterations_max() const noexcept {
    return std::min(kIterationsMax, kPointStepsMax / static_cast<int>(count_));
  }

  Eigen::Vector3d root_mass_;     // of mass, three times
  Eigen::Vector3d root_inertia_;  // of the inertias
  Eigen::Matrix3d axes_;          // rows: normal and two tangents, in B
  double friction_;
  double softness_ = 1;  // m/s per N s: of the penalty
  int iterations_ = 0;
  std::size_t count_ = 0;
  std::array<Point, kPointsMax> points_;
};

}  // namespace thimble::render
