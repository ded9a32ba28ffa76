#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "bringup/identify/arm_motion.h"
#include "bringup/identify/motion_fit.h"
#include "bringup/identify/smooth_bump.h"
#include "thimble/driver/result.h"

namespace thimble::bringup {

/// A motion in the weak form: both sides of the law of MassNormalisedFit integrated against smooth
/// bumps of 60 ms. There is an equation for each bump and axis of the base in which the axis did
/// not stand still. The motion must outlive it. Real-time: never from the servo thread.
class MotionEquations {
 public:
  static constexpr int kHalf = 30;           ///< Ticks to either side of a bump's middle.
  static constexpr int kCluster = 500;       ///< Ticks whose residuals may be correlated.
  static constexpr double kDelayMax = 0.02;  ///< s
  /// Factors of the constants of MassNormalisedFit::theta; the last column is the delay's.
  using Row = Eigen::Matrix<double, MassNormalisedFit::kCount + 1, 1>;

  /// One bump of one axis: the left side, and the factors of the frictions.
  struct Equation {
    int middle = 0;   ///< Tick.
    int axis = 0;     ///< Of the base.
    double left = 0;  ///< Acceleration, plus the force per mass of known links, m/s^2.
    double viscous = 0, coulomb = 0, stiffness = 0;
  };

  /// Takes a motion; `with_inertia`: rows have the columns of the motors' accelerations.
  MotionEquations(const ArmMotion& motion, bool with_inertia);

  /// Computes the mean sign of the velocity over each tick. Where the velocity reverses, dry
  /// friction `coulomb` (per mass, m/s^2) bends it by 2 c |t| / 2, which smoothing shifts by c
  /// times the bump's mean distance. So the axis reverses when the smoothed velocity is that far
  /// from zero. Known links of the motion reduce the bend.
  void find_signs(double coulomb);

  /// As above, with the deceleration by dry friction along each axis (m/s^2).
  void find_signs(const Eigen::Vector3d& slowed);

  /// Returns the mean sign over a tick of a velocity, from three smoothed ticks. `slowed`:
  /// deceleration by dry friction, in its unit per second.
  double sign_over(double before, double here, double after, double slowed) const;

  /// Returns whether a joint stands still for too long about a tick to know its friction. `rate`:
  /// of the joints, smoothed, at each tick, rad/s.
  bool stands(int middle, const std::vector<Eigen::Vector3d>& rate) const;

  /// Returns the factors of the constants at a delay (s). Torques are held from tick to tick:
  /// within the tick in which they arrive, the previous ones last for the delay's fraction.
  Row row(std::size_t number, double delay) const;

  /// Returns the effect of the joints' torques `torques` (N m, tick by tick) on an equation if they
  /// are `delay` (s) late. A row has the same for the motion's own torques.
  Eigen::Vector3d pushed(std::size_t number, double delay,
                         const std::vector<Eigen::Vector3d>& torques) const;

  /// Returns the mean of a quantity of an axis over an equation's bump, `of(tick, axis)`.
  template <class Of>
  double mean(std::size_t number, const Of& of) const {
    const Equation& equation = equations_[number];
    double sum = 0;
    for (int j = -kHalf; j <= kHalf; ++j) {
      sum +=
          bump_.value[static_cast<std::size_t>(j + kHalf)] * of(equation.middle + j, equation.axis);
    }
    return sum / area_;
  }
  /// Returns the mean of many quantities at once over an equation's bump, `of(tick)`, using one
  /// tick in `every`.
  template <class Many, class Of>
  Many means(std::size_t number, int every, const Of& of) const {
    Many sum = Many::Zero();
    double area = 0;
    for (int j = -kHalf; j <= kHalf; j += every) {
      const double weight = bump_.value[static_cast<std::size_t>(j + kHalf)];
      sum += weight * of(equations_[number].middle + j);
      area += weight;
    }
    return sum / area;
  }
  /// Returns the effect of a shift of the seen tip, `of(tick, axis)` (m), on an equation's left
  /// side.
  template <class Of>
  double curved(std::size_t number, const Of& of) const {
    const Equation& equation = equations_[number];
    const double middle = of(equation.middle, equation.axis);
    double sum = 0;
    for (int j = -kHalf; j <= kHalf; ++j) {
      sum += bump_.curvature[static_cast<std::size_t>(j + kHalf)] *
             (of(equation.middle + j, equation.axis) - middle);
    }
    return sum / area_;
  }

  const std::vector<Equation>& equations() const { return equations_; }
  const ArmMotion& motion() const { return motion_; }
  /// Returns the smoothed velocity of the tip at a tick, base, m/s.
  const Eigen::Vector3d& velocity(int tick) const {
    return velocity_[static_cast<std::size_t>(tick)];
  }
  /// Returns the mean sign of the velocity over a tick, axis by axis.
  const Eigen::Vector3d& sign(int tick) const { return sign_[static_cast<std::size_t>(tick)]; }
  /// Returns the RMS residual of the encoders' steps, if they were uniform noise, m/s^2.
  double noise() const;
  /// Returns the number of pieces in which an axis stood still for too long to know its friction.
  std::size_t left_out() const { return left_out_; }
  /// Returns whether most pieces have ticks without a report.
  bool torn() const { return torn_ > whole_; }
  /// Returns the error for a torn motion.
  static driver::Error torn_error(const ArmMotion& motion);

 private:
  static constexpr std::size_t kLateMax = 24;  // ticks: kDelayMax and the margin of a search

  /// Effect of torques on an equation when they are a number of ticks late. It consists of sums
  /// over the bump, of its value at the beginning of each tick and of its rise over it, joint by
  /// joint.
  struct Pushed {
    Eigen::Vector3d from{0, 0, 0}, rise{0, 0, 0}, inert{0, 0, 0};
    bool summed = false;
  };

  const MotionSample& at(int tick) const { return motion_.samples[static_cast<std::size_t>(tick)]; }
  void find_velocities();
  void gather();
  void sum_frictions();
  template <class TorqueAt>
  Pushed sum_of(std::size_t number, int late, const TorqueAt& torque_at) const;
  const Pushed& pushed_late(std::size_t number, int late) const;
  /// Returns the fraction of the delay within a tick, and sets its whole ticks.
  double part_of(double delay, int& whole) const;
  static Eigen::Vector3d joined(const Pushed& older, const Pushed& newer, double part);

  const ArmMotion& motion_;
  bool with_inertia_;
  SmoothBump<kHalf> bump_;
  double area_ = 0;
  Eigen::Matrix3d masses_ = Eigen::Matrix3d::Identity();  // with known links, over the tip's own
  std::vector<Eigen::Vector3d> velocity_, sign_;
  double mean_distance_ = 0;  // of a tick from the middle of the smoothing bump, s
  std::vector<Equation> equations_;
  mutable std::array<std::vector<Pushed>, kLateMax> pushed_;  // by delay, for each equation
  std::size_t left_out_ = 0;
  std::size_t whole_ = 0, torn_ = 0;  // pieces of motion without and with ticks that have no report
};

}  // namespace thimble::bringup
