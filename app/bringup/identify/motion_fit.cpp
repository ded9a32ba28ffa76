#include "bringup/identify/motion_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "bringup/identify/smooth_bump.h"

namespace thimble::app {
namespace {

constexpr int kHalf = 30;        // ticks to either side of a bump's middle
constexpr int kHop = 15;         // ticks between bumps
constexpr int kSmooth = 10;      // ticks to either side, for the sign of a velocity
constexpr int kCluster = 500;    // ticks whose residuals may hang together
constexpr double kSlow = 0.003;  // m/s, below which the sign of a velocity is not known
constexpr int kSlowMost = 3;  // ticks that an axis may be so slow, which turns and does not stick
constexpr double kDelayMost = 0.02;    // s
constexpr std::size_t kLateMost = 24;  // ticks, kDelayMost and what the line search looks beyond it

using Row = Eigen::Matrix<double, PerMass::kCount + 1, 1>;  // the delay's column is the last

/// One bump of one axis: what stands on the left, and what the constants multiply.
struct Equation {
  int middle = 0;  // tick
  int axis = 0;
  double left = 0;  // m/s^2
  double viscous = 0, coulomb = 0, stiffness = 0;
};

class Fit {
 public:
  Fit(const ArmMotion& motion, bool with_stiffness, bool with_inertia)
      : motion_(motion),
        with_stiffness_(with_stiffness),
        with_inertia_(with_inertia),
        bump_(motion.dt) {
    for (const double value : bump_.value) area_ += value;
    find_velocities();
    gather();
    find_signs(0);
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

  void find_velocities() {
    const TurnSmoothing<kSmooth> smooth(motion_.dt);
    mean_distance_ = smooth.mean_distance;
    velocity_.assign(motion_.samples.size(), Eigen::Vector3d::Zero());
    const int end = static_cast<int>(motion_.samples.size()) - kSmooth;
    for (int k = kSmooth; k < end; ++k) {
      Eigen::Vector3d sum(0, 0, 0);
      for (int j = -kSmooth; j <= kSmooth; ++j) {
        sum -= smooth.slope[static_cast<std::size_t>(j + kSmooth)] * at(k + j).p_BT;
      }
      velocity_[static_cast<std::size_t>(k)] = sum;
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
    sum_frictions();
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

  /// What torques do to an equation when they are a number of ticks late: sums over the bump, of
  /// its value at the beginning of each tick and of its rise over it, joint by joint.
  struct Pushed {
    Eigen::Vector3d from{0, 0, 0}, rise{0, 0, 0}, inert{0, 0, 0};
    bool summed = false;
  };

  /// The line search asks for the same ticks again and again, so each is summed up once.
  const Pushed& pushed(std::size_t number, int late) const {
    auto& all = pushed_[static_cast<std::size_t>(late)];
    if (all.empty()) all.resize(equations_.size());
    Pushed& sums = all[number];
    if (sums.summed) return sums;
    const int axis = equations_[number].axis, middle = equations_[number].middle;
    for (int j = -kHalf; j < kHalf; ++j) {
      const auto i = static_cast<std::size_t>(j + kHalf);
      const MotionSample &here = at(middle + j), &next = at(middle + j + 1);
      const Eigen::Vector3d& tau = at(middle + j - late).tau;
      const Eigen::Vector3d from = bump_.value[i] * here.G.col(axis);
      const Eigen::Vector3d rise = bump_.value[i + 1] * next.G.col(axis) - from;
      sums.from += tau.cwiseProduct(from);
      sums.rise += tau.cwiseProduct(rise);
      // That of accelerations moves little within a tick.
      if (with_inertia_) sums.inert -= at(middle + j - late).ddq.cwiseProduct(from + 0.5 * rise);
    }
    sums.summed = true;
    return sums;
  }

  /// Sums up what does not hang on the delay. Dry friction hangs on where the signs turn.
  void sum_frictions() {
    for (Equation& equation : equations_) {
      const int axis = equation.axis, middle = equation.middle;
      equation.viscous = equation.coulomb = equation.stiffness = 0;
      for (int j = -kHalf; j < kHalf; ++j) {
        const auto i = static_cast<std::size_t>(j + kHalf);
        const double p = at(middle + j).p_BT[axis];
        equation.viscous += bump_.slope[i] * (p - at(middle).p_BT[axis]);
        equation.coulomb -= bump_.value[i] * sign_[static_cast<std::size_t>(middle + j)][axis];
        equation.stiffness -= bump_.value[i] * p;
      }
    }
  }

  /// What the constants of an equation multiply, at a delay (s). Torques stand from tick to tick:
  /// within the tick that they arrive in, the older ones last for the delay's fraction.
  Row row(std::size_t number, double delay) const {
    Row row = Row::Zero();
    const Equation& equation = equations_[number];
    const double ticks = delay / motion_.dt;
    const int whole = static_cast<int>(std::floor(ticks));
    const double part = ticks - whole;
    const Pushed &older = pushed(number, whole + 1), &newer = pushed(number, whole);
    row.segment<3>(PerMass::kGain) = part * (older.from + 0.5 * part * older.rise) +
                                     (1 - part) * (newer.from + 0.5 * (1 + part) * newer.rise);
    row.segment<3>(PerMass::kInertia) = part * older.inert + (1 - part) * newer.inert;
    row[PerMass::kViscous] = equation.viscous;
    row[PerMass::kCoulomb] = equation.coulomb;
    row[PerMass::kStiffness] = equation.stiffness;
    row /= area_;
    row[PerMass::kWeight + equation.axis] = 1;
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
      const Row one = row(i, delay);
      if (rows != nullptr) rows->row(static_cast<Eigen::Index>(i)) = one.transpose();
      normal += one * one.transpose();
      right += equations_[i].left * one;
      square += equations_[i].left * equations_[i].left;
    }
    normal(PerMass::kCount, PerMass::kCount) = 1;
    leave_out(normal);
    for (int k = 0; k < PerMass::kCount; ++k) right[k] = is_asked(k) ? right[k] : 0;
    theta = normal.ldlt().solve(right);
    return square - theta.dot(right);
  }

  bool is_asked(int k) const {
    return k < PerMass::kStiffness || k == PerMass::kCount ||
           (k == PerMass::kStiffness ? with_stiffness_ : with_inertia_);
  }

  /// Makes equations that say nothing of what is not asked.
  void leave_out(Eigen::Matrix<double, PerMass::kCount + 1, PerMass::kCount + 1>& normal) const {
    for (int k = 0; k < PerMass::kCount; ++k) {
      if (is_asked(k)) continue;
      normal.row(k).setZero();
      normal.col(k).setZero();
      normal(k, k) = 1;
    }
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
      const auto number = static_cast<std::size_t>(i);
      const double early = std::max(0.0, delay - kStep);
      rows(i, PerMass::kCount) =
          (row(number, delay + kStep) - row(number, early)).dot(theta) / (delay + kStep - early);
    }
    Eigen::Matrix<double, kAll, kAll> normal = rows.transpose() * rows;
    leave_out(normal);
    const Eigen::Matrix<double, kAll, kAll> inverse =
        normal.ldlt().solve(Eigen::Matrix<double, kAll, kAll>::Identity());
    for (int k = 0; k < PerMass::kCount; ++k) {
      if (!is_asked(k)) rows.col(k).setZero();
    }
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
  bool with_stiffness_, with_inertia_;
  SmoothBump<kHalf> bump_;
  double area_ = 0;
  std::vector<Eigen::Vector3d> velocity_, sign_;
  double mean_distance_ = 0;  // of a tick from the middle of the smoothing bump, s
  std::vector<Equation> equations_;
  mutable std::array<std::vector<Pushed>, kLateMost> pushed_;  // by ticks, for each equation
  std::size_t left_out_ = 0;
  std::size_t whole_ = 0, torn_ = 0;  // pieces of motion without and with ticks that saw no report
};

}  // namespace

driver::Result<PerMass> fit_motion(const ArmMotion& motion, bool with_stiffness,
                                   bool with_inertia) {
  return Fit(motion, with_stiffness, with_inertia).run();
}

}  // namespace thimble::app
