#include "bringup/identify/motion_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace thimble::app {
namespace {

constexpr int kHalf = 30;        // ticks to either side of a bump's middle
constexpr int kHop = 15;         // ticks between bumps
constexpr int kSmooth = 10;      // ticks to either side, for the sign of a velocity
constexpr int kCluster = 500;    // ticks whose residuals may hang together
constexpr double kSlow = 0.003;  // m/s, below which the sign of a velocity is not known
constexpr int kSlowMost = 3;  // ticks that an axis may be so slow, which turns and does not stick
constexpr double kDelayMost = 0.02;  // s

using Row = Eigen::Matrix<double, PerMass::kCount + 1, 1>;  // the delay's column is the last

/// A smooth bump (1 - x^2)^4 over |x| < 1 with its derivatives, at the ticks, per second.
struct Bump {
  std::array<double, 2 * kHalf + 1> value{}, slope{}, curvature{};

  Bump(int half, double dt) {
    const double width = half * dt;
    for (int j = -half; j <= half; ++j) {
      const double x = static_cast<double>(j) / half, y = 1 - x * x;
      const auto i = static_cast<std::size_t>(j + half);
      value[i] = y * y * y * y;
      slope[i] = -8 * x * y * y * y / width;
      curvature[i] = (-8 * y * y * y + 48 * x * x * y * y) / (width * width);
    }
  }
};

/// One bump of one axis: what stands on the left, and what the constants multiply.
struct Equation {
  int middle = 0;  // tick
  int axis = 0;
  double left = 0;  // m/s^2
};

class Fit {
 public:
  Fit(const ArmMotion& motion, bool with_stiffness)
      : motion_(motion), with_stiffness_(with_stiffness), bump_(kHalf, motion.dt) {
    for (const double value : bump_.value) area_ += value;
    find_velocities();
    find_signs(0);
    gather();
  }

  driver::Result<PerMass> run() {
    if (torn_ > whole_) {
      return driver::Error{
          "Too many ticks came without a new report, so the motion was not seen well enough. Run "
          "`thimble doctor`: it says what makes reports late."};
    }
    if (equations_.size() < 300) {
      return driver::Error{
          "The motion is too short or the tip stood still for most of it, so nothing can be "
          "fitted; let it move freely for some ten seconds."};
    }
    constexpr std::size_t kSome = 8;  // enough for a first look
    double best = 0, least = residual_at(0, kSome);
    for (double delay = 0.0005; delay < kDelayMost; delay += 0.0005) {
      const double sum = residual_at(delay, kSome);
      if (sum < least) least = sum, best = delay;
    }
    // Where friction turns its sign hangs on how strong it is.
    for (int round = 0; round < 3; ++round) {
      Row theta;
      solve(best, theta);
      find_signs(theta[PerMass::kCoulomb]);
      best = refine(best);
    }
    return at_delay(best);
  }

 private:
  const MotionSample& at(int tick) const { return motion_.samples[static_cast<std::size_t>(tick)]; }

  /// Smooths by a bump times 1 - b x^2, whose second moment is zero: where a velocity turns,
  /// neither its slope nor how that changes moves the place.
  void find_velocities() {
    const Bump smooth(kSmooth, motion_.dt);
    const double width = kSmooth * motion_.dt;
    double second = 0, fourth = 0, area = 0;
    for (int j = -kSmooth; j <= kSmooth; ++j) {
      const double x2 = static_cast<double>(j * j) / (kSmooth * kSmooth);
      second += smooth.value[static_cast<std::size_t>(j + kSmooth)] * x2;
      fourth += smooth.value[static_cast<std::size_t>(j + kSmooth)] * x2 * x2;
    }
    const double b = second / fourth;
    std::array<double, 2 * kSmooth + 1> slope{};
    for (int j = -kSmooth; j <= kSmooth; ++j) {
      const auto i = static_cast<std::size_t>(j + kSmooth);
      const double x = static_cast<double>(j) / kSmooth, y = 1 - b * x * x;
      slope[i] = smooth.slope[i] * y - smooth.value[i] * 2 * b * x / width;
      area += smooth.value[i] * y;
      mean_distance_ += smooth.value[i] * y * std::abs(j) * motion_.dt;
    }
    mean_distance_ /= area;
    velocity_.assign(motion_.samples.size(), Eigen::Vector3d::Zero());
    const int end = static_cast<int>(motion_.samples.size()) - kSmooth;
    for (int k = kSmooth; k < end; ++k) {
      Eigen::Vector3d sum(0, 0, 0);
      for (int j = -kSmooth; j <= kSmooth; ++j) {
        sum -= slope[static_cast<std::size_t>(j + kSmooth)] * at(k + j).p_BT;
      }
      velocity_[static_cast<std::size_t>(k)] = sum / area;
    }
  }

  /// Finds the mean sign of the velocity over each tick. Where the velocity turns, dry friction
  /// `coulomb` (per mass, m/s^2) bends it by 2 c |t| / 2, which smoothing lifts by c times the
  /// bump's mean distance: the axis turns when the smoothed velocity is that far from zero.
  void find_signs(double coulomb) {
    sign_.assign(velocity_.size(), Eigen::Vector3d::Zero());
    const double lift = std::max(0.0, coulomb) * mean_distance_;
    for (std::size_t k = 1; k + 1 < velocity_.size(); ++k) {
      for (int axis = 0; axis < 3; ++axis) {
        const double rise = velocity_[k + 1][axis] - velocity_[k - 1][axis];
        const double v = velocity_[k][axis] + std::copysign(lift, rise);
        const double half_tick = 0.25 * std::abs(rise);
        sign_[k][axis] = std::abs(v) < half_tick ? v / half_tick : v > 0 ? 1 : v < 0 ? -1 : 0;
      }
    }
  }

  void gather() {
    const int first = kHalf + static_cast<int>(kDelayMost / motion_.dt) + 2;
    const int end = static_cast<int>(motion_.samples.size()) - kHalf - kSmooth;
    for (int middle = first; middle < end; middle += kHop) {
      bool whole = true;
      for (int j = -kHalf; j <= kHalf; ++j) whole = whole && at(middle + j).fresh;
      if (!whole) {
        ++torn_;
        continue;
      }
      ++whole_;
      for (int axis = 0; axis < 3; ++axis) {
        int slow = 0, slowest = 0;
        double left = 0;
        for (int j = -kHalf; j <= kHalf; ++j) {
          const auto i = static_cast<std::size_t>(j + kHalf);
          const double v = velocity_[static_cast<std::size_t>(middle + j)][axis];
          slow = std::abs(v) < kSlow ? slow + 1 : 0;
          slowest = std::max(slowest, slow);
          left += bump_.curvature[i] * (at(middle + j).p_BT[axis] - at(middle).p_BT[axis]);
        }
        if (slowest > kSlowMost) {
          ++left_out_;
          continue;
        }
        equations_.push_back({.middle = middle, .axis = axis, .left = left / area_});
      }
    }
  }

  /// What the constants of an equation multiply, at a delay (s). Torques stand from tick to tick:
  /// within the tick that they arrive in, the older ones last for the delay's fraction.
  Row row(const Equation& equation, double delay) const {
    Row row = Row::Zero();
    const double ticks = delay / motion_.dt;
    const int whole = static_cast<int>(std::floor(ticks));
    const double part = ticks - whole;
    const int axis = equation.axis, middle = equation.middle;
    for (int j = -kHalf; j < kHalf; ++j) {
      const auto i = static_cast<std::size_t>(j + kHalf);
      const int tick = middle + j;
      const MotionSample &here = at(tick), &next = at(tick + 1);
      const Eigen::Vector3d& older = at(tick - whole - 1).tau;
      const Eigen::Vector3d& newer = at(tick - whole).tau;
      for (int joint = 0; joint < 3; ++joint) {
        const double from = bump_.value[i] * here.G(joint, axis);
        const double rise = bump_.value[i + 1] * next.G(joint, axis) - from;
        row[PerMass::kGain + joint] += part * older[joint] * (from + 0.5 * part * rise) +
                                       (1 - part) * newer[joint] * (from + 0.5 * (1 + part) * rise);
      }
      const double value = bump_.value[i];
      row[PerMass::kViscous] += bump_.slope[i] * (here.p_BT[axis] - at(middle).p_BT[axis]);
      row[PerMass::kCoulomb] -= value * sign_[static_cast<std::size_t>(tick)][axis];
      row[PerMass::kStiffness] -= value * here.p_BT[axis];
    }
    row /= area_;
    row[PerMass::kWeight + axis] = 1;
    return row;
  }

  /// The constants that fit best at a delay, with the sum of the residuals' squares. Takes each
  /// equation, or one in `stride`.
  double solve(double delay, Row& theta, std::size_t stride = 1,
               Eigen::MatrixXd* rows = nullptr) const {
    Eigen::Matrix<double, PerMass::kCount + 1, PerMass::kCount + 1> normal;
    normal.setZero();
    Row right = Row::Zero();
    double square = 0;
    for (std::size_t i = 0; i < equations_.size(); i += stride) {
      const Row one = row(equations_[i], delay);
      if (rows != nullptr) rows->row(static_cast<Eigen::Index>(i)) = one.transpose();
      normal += one * one.transpose();
      right += equations_[i].left * one;
      square += equations_[i].left * equations_[i].left;
    }
    normal(PerMass::kCount, PerMass::kCount) = 1;
    if (!with_stiffness_) {
      normal.row(PerMass::kStiffness).setZero();
      normal.col(PerMass::kStiffness).setZero();
      normal(PerMass::kStiffness, PerMass::kStiffness) = 1;
      right[PerMass::kStiffness] = 0;
    }
    theta = normal.ldlt().solve(right);
    return square - theta.dot(right);
  }

  double residual_at(double delay, std::size_t stride = 1) const {
    Row theta;
    return solve(delay, theta, stride);
  }

  /// Finds the least residual within half a millisecond by golden sections.
  double refine(double about) const {
    constexpr double kGolden = 0.6180339887498949;
    double low = std::max(0.0, about - 0.0005), high = about + 0.0005;
    double left = high - kGolden * (high - low), right = low + kGolden * (high - low);
    double at_left = residual_at(left), at_right = residual_at(right);
    while (high - low > 1e-6) {
      if (at_left < at_right) {
        high = right, right = left, at_right = at_left;
        at_left = residual_at(left = high - kGolden * (high - low));
      } else {
        low = left, left = right, at_left = at_right;
        at_right = residual_at(right = low + kGolden * (high - low));
      }
    }
    return 0.5 * (low + high);
  }

  PerMass at_delay(double delay) const {
    constexpr int kAll = PerMass::kCount + 1;
    const auto count = static_cast<Eigen::Index>(equations_.size());
    Eigen::MatrixXd rows(count, kAll);
    Row theta;
    solve(delay, theta, 1, &rows);
    Eigen::VectorXd left(count);
    for (Eigen::Index i = 0; i < count; ++i) left[i] = equations_[static_cast<std::size_t>(i)].left;
    theta[PerMass::kCount] = 0;
    const Eigen::VectorXd rest = left - rows * theta;
    // How the residual changes with the delay, by a central difference.
    constexpr double kStep = 2e-5;
    for (Eigen::Index i = 0; i < count; ++i) {
      const Equation& equation = equations_[static_cast<std::size_t>(i)];
      const double early = std::max(0.0, delay - kStep);
      rows(i, PerMass::kCount) = (row(equation, delay + kStep) - row(equation, early)).dot(theta) /
                                 (delay + kStep - early);
    }
    if (!with_stiffness_) rows.col(PerMass::kStiffness).setZero();
    Eigen::Matrix<double, kAll, kAll> normal = rows.transpose() * rows;
    if (!with_stiffness_) normal(PerMass::kStiffness, PerMass::kStiffness) = 1;
    const Eigen::Matrix<double, kAll, kAll> inverse =
        normal.ldlt().solve(Eigen::Matrix<double, kAll, kAll>::Identity());
    Eigen::Matrix<double, kAll, kAll> meat = Eigen::Matrix<double, kAll, kAll>::Zero();
    Row score = Row::Zero();
    int cluster = -1, clusters = 0;
    const auto close = [&] {
      meat += score * score.transpose();
      score.setZero();
      ++clusters;
    };
    for (Eigen::Index i = 0; i < count; ++i) {
      const int here = equations_[static_cast<std::size_t>(i)].middle / kCluster;
      if (cluster >= 0 && here != cluster) close();
      cluster = here;
      score += rest[i] * rows.row(i).transpose();
    }
    close();
    const double fewer = static_cast<double>(clusters) / std::max(1, clusters - 1);
    const Eigen::Matrix<double, kAll, kAll> covariance = fewer * inverse * meat * inverse;
    PerMass found;
    found.theta = theta.head<PerMass::kCount>();
    found.covariance = covariance.topLeftCorner<PerMass::kCount, PerMass::kCount>();
    found.delay = {delay, kNormal95 * std::sqrt(covariance(PerMass::kCount, PerMass::kCount))};
    found.residual = std::sqrt(rest.squaredNorm() / static_cast<double>(count));
    found.explained = 1 - rest.squaredNorm() / left.squaredNorm();
    found.noise = noise();
    found.windows = equations_.size();
    found.left_out = left_out_;
    return found;
  }

  /// What the steps of the encoders leave, were they evenly spread noise.
  double noise() const {
    double curvature = 0;
    for (const double value : bump_.curvature) curvature += value * value;
    const Eigen::Matrix3d J = at(equations_.front().middle).G.inverse();
    const double at_tip = (J * motion_.step.asDiagonal()).squaredNorm() / 3;
    return std::sqrt(curvature * at_tip / 12) / area_;
  }

  const ArmMotion& motion_;
  bool with_stiffness_;
  Bump bump_;
  double area_ = 0;
  std::vector<Eigen::Vector3d> velocity_, sign_;
  double mean_distance_ = 0;  // of a tick from the middle of the smoothing bump, s
  std::vector<Equation> equations_;
  std::size_t left_out_ = 0;
  std::size_t whole_ = 0, torn_ = 0;  // pieces of motion without and with ticks that saw no report
};

}  // namespace

driver::Result<PerMass> fit_motion(const ArmMotion& motion, bool with_stiffness) {
  return Fit(motion, with_stiffness).run();
}

}  // namespace thimble::app
