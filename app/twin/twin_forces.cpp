#include "twin/twin_forces.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "math/least_squares.h"
#include "twin/twin_motors.h"

namespace thimble::twin {
namespace {

using Eigen::Vector3d;

constexpr double kHalf = 0.03;            // s, half of a bump [as in identify]
constexpr double kBetween = 0.01;         // s from one piece to the next
constexpr double kDirectionSpan = 0.005;  // s to each side, for the direction of motion
constexpr double kStands = 3;             // times the encoders' error: a smaller motion is none
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// A bump (1 - s^2)^n with its derivatives at each tick of a piece, and between two. Four of them
/// vanish at its ends with n = 5, two with n = 3.
struct Bump {
  std::vector<double> value, first, second, fourth;  // at ticks -half to half
  std::vector<double> between, between_second;       // from each tick to the next
  std::ptrdiff_t half;

  Bump(double dt, int n) : half(std::lround(kHalf / dt)) {
    const double width = static_cast<double>(half) * dt;
    // Scaled so that its integral is 1: those of (1 - s^2)^3 and (1 - s^2)^5 from -1 to 1.
    const double scale = (n == 3 ? 35.0 / 32 : 693.0 / 512) / width;
    const auto power = [](double u, int times) {
      double product = 1;
      for (; times > 0; --times) product *= u;
      return product;
    };
    const double n2 = n * (n - 1), n3 = n2 * (n - 2), n4 = n3 * (n - 3);
    const auto value_at = [&](double s) { return scale * power(1 - s * s, n); };
    const auto second_at = [&](double s) {
      const double u = 1 - s * s;
      return scale / (width * width) *
             (-2 * n * power(u, n - 1) + 4 * n2 * s * s * power(u, n - 2));
    };
    for (std::ptrdiff_t j = -half; j <= half; ++j) {
      const double s = static_cast<double>(j) / static_cast<double>(half);
      const double u = 1 - s * s, s2 = s * s;
      value.push_back(dt * value_at(s));
      first.push_back(dt * scale / width * -2 * n * s * power(u, n - 1));
      second.push_back(dt * second_at(s));
      if (n > 4) {
        fourth.push_back(dt * scale / power(width, 4) *
                         (12 * n2 * power(u, n - 2) - 48 * n3 * s2 * power(u, n - 3) +
                          16 * n4 * s2 * s2 * power(u, n - 4)));
      }
      if (j == half) break;
      const double after = s + 0.5 / static_cast<double>(half);
      between.push_back(dt * value_at(after));
      between_second.push_back(dt * second_at(after));
    }
  }
};

/// One piece of motion, smoothed, in the base.
struct Piece {
  Vector3d p{0, 0, 0}, v{0, 0, 0}, a{0, 0, 0};
  Vector3d direction{0, 0, 0};      // mean sign of the velocity; not a number at rest
  Vector3d motors{0, 0, 0};         // N
  Vector3d fourth{0, 0, 0};         // derivative of the position, m/s^4
  Vector3d motors_second{0, 0, 0};  // derivative of their force, N/s^2
};

Piece piece_at(const std::vector<TwinSample>& stretch, const std::vector<Vector3d>& pulls,
               std::size_t middle, const Bump& bump, double dt, double stands) {
  Piece piece;
  const auto at = [&](std::ptrdiff_t j) -> const TwinSample& {
    return stretch[static_cast<std::size_t>(static_cast<std::ptrdiff_t>(middle) + j)];
  };
  const Vector3d p0 = at(0).p_BT;
  const std::ptrdiff_t slope = std::max<std::ptrdiff_t>(1, std::lround(kDirectionSpan / dt));
  for (std::ptrdiff_t j = -bump.half; j <= bump.half; ++j) {
    const auto k = static_cast<std::size_t>(j + bump.half);
    const Vector3d p = at(j).p_BT - p0;
    piece.p += bump.value[k] * p;
    piece.v -= bump.first[k] * p;
    piece.a += bump.second[k] * p;
    if (!bump.fourth.empty()) piece.fourth += bump.fourth[k] * p;
    const Vector3d way = at(j + slope).p_BT - at(j - slope).p_BT;
    for (int i = 0; i < 3; ++i) {
      // Written so that an axis that once stood still remains excluded.
      piece.direction[i] +=
          std::abs(way[i]) > stands ? bump.value[k] * (way[i] > 0 ? 1 : -1) : kNone;
    }
    if (j < bump.half) {
      const Vector3d& pull =
          pulls[static_cast<std::size_t>(static_cast<std::ptrdiff_t>(middle) + j)];
      piece.motors += bump.between[k] * pull;
      piece.motors_second += bump.between_second[k] * pull;
    }
  }
  piece.p += p0;
  return piece;
}

/// Returns the force of the motors on a tip in each tick of a stretch, N in the base.
std::vector<Vector3d> pulls_of(const std::vector<TwinSample>& stretch, const TwinMotors& motors,
                               const TwinDelay& delay, double dt) {
  std::vector<Vector3d> pulls(stretch.size(), Vector3d::Zero());
  const double older = 1e-9 * static_cast<double>(delay.part_ns) / dt;
  for (std::size_t k = delay.whole + 1; k + 1 < stretch.size(); ++k) {
    const Eigen::Matrix3d G = 0.5 * (stretch[k].G + stretch[k + 1].G);
    const Vector3d before = motors.torque(stretch[k - delay.whole - 1].amperes);
    const Vector3d now = motors.torque(stretch[k - delay.whole].amperes);
    pulls[k] = G.transpose() * (older * before + (1 - older) * now);
  }
  return pulls;
}

/// Effect of elastic cables on forces at the tip in one pose. Motors move as the encoders report,
/// x, and pull the tip by the remainder of their force f, c = f - M_r x'' - b_r x'. The tip is
/// behind them by C c, with M_r = G^T I G, b_r = G^T b G and C = G^-1 K^-1 G^-T. So m times its
/// acceleration is m (x'' - C c''), in which damping of cables and derivatives of friction are
/// neglected: below 20 Hz they are a hundredth.
struct CablesInPose {
  Eigen::Matrix3d rotors, rubbing, compliance;

  CablesInPose(const device_sim::DriveTrainSettings& train, const Eigen::Matrix3d& G)
      : rotors(G.transpose() * train.inertia.asDiagonal() * G),
        rubbing(G.transpose() * train.viscous.asDiagonal() * G) {
    const Eigen::Matrix3d J = G.inverse();
    compliance = J * train.stiffness.cwiseInverse().asDiagonal() * J.transpose();
  }

  /// Returns the force that motion needs in addition to that of a rigid arm, N in the base.
  Vector3d needed(const Piece& piece, double mass) const {
    return rotors * piece.a + rubbing * piece.v -
           mass * (compliance * (piece.motors_second - rotors * piece.fourth));
  }
};

/// Returns the friction of joints that are rigidly connected to their motors in a piece, N in the
/// base. Not a number if a joint with friction stands still.
Vector3d rubbed(const device_sim::DriveTrainSettings& train, const std::vector<TwinSample>& stretch,
                std::size_t middle, const Bump& bump, double dt, double step_error) {
  Vector3d force(0, 0, 0);
  const std::ptrdiff_t slope = std::max<std::ptrdiff_t>(1, std::lround(kDirectionSpan / dt));
  for (std::ptrdiff_t j = -bump.half; j <= bump.half; ++j) {
    const auto at = static_cast<std::ptrdiff_t>(middle) + j;
    const Eigen::Matrix3d& G = stretch[static_cast<std::size_t>(at)].G;
    const Vector3d way = G * (stretch[static_cast<std::size_t>(at + slope)].p_BT -
                              stretch[static_cast<std::size_t>(at - slope)].p_BT);
    Vector3d torque = train.viscous.cwiseProduct(way) / (2 * static_cast<double>(slope) * dt);
    for (int joint = 0; joint < 3; ++joint) {
      if (train.coulomb[joint] == 0) continue;
      const double stands = kStands * step_error * G.row(joint).norm();
      torque[joint] +=
          std::abs(way[joint]) > stands ? std::copysign(train.coulomb[joint], way[joint]) : kNone;
    }
    force += bump.value[static_cast<std::size_t>(j + bump.half)] * (G.transpose() * torque);
  }
  return force;
}

/// Transforms a force into the world: an axis that stands still invalidates only the components
/// that contain it.
Vector3d turned(const Eigen::Matrix3d& R_WB, const Vector3d& f_B) {
  constexpr double kNoPart = 1e-9;
  Vector3d f_W(0, 0, 0);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (std::abs(R_WB(i, j)) > kNoPart) f_W[i] += R_WB(i, j) * f_B[j];
    }
  }
  return f_W;
}

/// The normal equations of a hand: other = -mass a - damping v - stiffness p + constant force.
class HandFit {
 public:
  void add(const Piece& piece, const Vector3d& other) {
    for (int i = 0; i < 3; ++i) {
      if (std::isnan(other[i])) continue;
      Eigen::Matrix<double, 6, 1> row = Eigen::Matrix<double, 6, 1>::Zero();
      row[0] = -piece.a[i];
      row[1] = -piece.v[i];
      row[2] = -piece.p[i];
      row[3 + i] = 1;
      normal_ += row * row.transpose();
      right_ += row * other[i];
      square_ += other[i] * other[i];
    }
  }
  TwinHand hand() const {
    if (!(square_ > 0)) return {};
    const Eigen::Matrix<double, 6, 1> best =
        math::ScaledNormal<Eigen::Matrix<double, 6, 6>>(normal_).solve(right_);
    return {.mass = best[0],
            .stiffness = best[2],
            .damping = best[1],
            .explained = best.dot(right_) / square_};
  }

 private:
  Eigen::Matrix<double, 6, 6> normal_ = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 1> right_ = Eigen::Matrix<double, 6, 1>::Zero();
  double square_ = 0;
};

/// Returns the effect of noise of 1 m at each tick on a piece, N RMS of an axis.
double noise_of(const Bump& bump, double mass, const device_sim::DriveTrainSettings& train,
                const TwinMotion& motion) {
  double of_second = mass, of_fourth = 0;  // kg, kg s^2
  if (train.compliant()) {
    const CablesInPose cables(train, motion.stretches.front().front().G);
    of_second += cables.rotors.trace() / 3;
    of_fourth = mass * (cables.compliance * cables.rotors).trace() / 3;
  }
  double square = 0;
  for (std::size_t k = 0; k < bump.second.size(); ++k) {
    const double one =
        of_second * bump.second[k] + (bump.fourth.empty() ? 0 : of_fourth * bump.fourth[k]);
    square += one * one;
  }
  return std::sqrt(square);
}

}  // namespace

bool TwinForces::other_acted() const {
  for (const TwinForceAxis& axis : axes) {
    if (axis.other_rms > std::max(kSeen * noise, kShare * axis.motors_rms)) return true;
  }
  return false;
}

bool TwinForces::hand_held() const {
  return other_acted() && !constants_explain && hand.explained > kHandExplains &&
         hand.stiffness > 0;
}

TwinForces twin_forces(const TwinMotion& motion, const scene::ArmFile& file) {
  const auto& plant = file.simulated.plant;
  const TwinMotors motors(file);
  const TwinDelay delay(file, motion.dt);
  const device_sim::DriveTrainSettings& train = file.simulated.drive_train;
  const bool soft = train.compliant();
  const Bump bump(motion.dt, soft ? 5 : 3);
  const auto every = static_cast<std::size_t>(std::max(1L, std::lround(kBetween / motion.dt)));
  const auto lead = static_cast<std::size_t>(bump.half) +
                    static_cast<std::size_t>(std::lround(TwinMotion::kLead / motion.dt)) + 1;
  TwinForces found;
  HandFit fit;
  Vector3d squares_motors(0, 0, 0), squares_needed(0, 0, 0), squares_other(0, 0, 0);
  double before = 0;  // s, of the stretches before
  for (const auto& stretch : motion.stretches) {
    const std::vector<Vector3d> pulls = pulls_of(stretch, motors, delay, motion.dt);
    for (std::size_t k = lead; k + lead < stretch.size(); k += every) {
      const Piece piece = piece_at(stretch, pulls, k, bump, motion.dt, kStands * motion.step_error);
      Vector3d needed_B = plant.mass * piece.a + plant.viscous * piece.v +
                          plant.coulomb * piece.direction - file.simulated.weight_B;
      if (soft) needed_B += CablesInPose(train, stretch[k].G).needed(piece, plant.mass);
      if (train.has_joint_friction())
        needed_B += rubbed(train, stretch, k, bump, motion.dt, motion.step_error);
      const Vector3d other_B = needed_B - piece.motors;
      fit.add(piece, other_B);
      const Vector3d other_W = turned(motion.R_WB, other_B);
      const Vector3d motors_W = motion.R_WB * piece.motors;
      const Vector3d needed_W = turned(motion.R_WB, needed_B);
      found.samples.push_back({.time = before + static_cast<double>(k) * motion.dt,
                               .f_motors_W = motors_W,
                               .f_other_W = other_W});
      for (int i = 0; i < 3; ++i) {
        if (std::isnan(other_W[i])) continue;
        ++found.axes[static_cast<std::size_t>(i)].counted;
        squares_motors[i] += motors_W[i] * motors_W[i];
        squares_needed[i] += needed_W[i] * needed_W[i];
        squares_other[i] += other_W[i] * other_W[i];
      }
    }
    before += static_cast<double>(stretch.size()) * motion.dt;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    TwinForceAxis& axis = found.axes[i];
    const auto k = static_cast<Eigen::Index>(i);
    axis.name = "xyz"[i];
    if (axis.counted == 0) continue;
    const auto count = static_cast<double>(axis.counted);
    axis.motors_rms = std::sqrt(squares_motors[k] / count);
    axis.needed_rms = std::sqrt(squares_needed[k] / count);
    axis.other_rms = std::sqrt(squares_other[k] / count);
  }
  found.noise = motion.step_error * noise_of(bump, plant.mass, train, motion);
  found.hand = fit.hand();
  return found;
}

std::vector<session::Figure> force_figures(const TwinForces& forces) {
  std::vector<session::Figure> figures;
  for (const TwinForceAxis& axis : forces.axes) {
    figures.push_back(
        {fmt::format("force_of_motors_{}", axis.name), axis.motors_rms, "N", "", "RMS"});
    figures.push_back({fmt::format("force_needed_{}", axis.name), axis.needed_rms, "N", "", "RMS"});
    figures.push_back({fmt::format("other_force_{}", axis.name), axis.other_rms, "N", "",
                       "RMS; from a hand, or from an error of the file"});
  }
  figures.push_back({"other_force_of_encoders", forces.noise, "N", "", "from encoder steps"});
  if (forces.hand_held()) {
    figures.push_back({"hand_stiffness", forces.hand.stiffness, "N/m", "", ""});
    figures.push_back({"hand_damping", forces.hand.damping, "N s/m", "", ""});
    figures.push_back({"hand_mass", forces.hand.mass, "kg", "", ""});
  }
  return figures;
}

std::string force_table(const TwinForces& forces) {
  std::string text =
      fmt::format("{:<5} {:>12} {:>16} {:>16}\n", "axis", "motors", "motion", "other");
  for (const TwinForceAxis& axis : forces.axes) {
    if (axis.counted == 0) {
      text += fmt::format("{:<5} {:>12}\n", axis.name, "at rest");
      continue;
    }
    text += fmt::format("{:<5} {:>9.1f} mN {:>13.1f} mN {:>13.1f} mN\n", axis.name,
                        1e3 * axis.motors_rms, 1e3 * axis.needed_rms, 1e3 * axis.other_rms);
  }
  if (forces.hand_held()) {
    const TwinHand& hand = forces.hand;
    text += fmt::format(
        "Something held the tip like a hand of {:.2g} N/m, {:.2g} N s/m and {:.2g} kg, which "
        "explains {:.0f} % of the other force. The values of the constants above are not valid. "
        "Record without a hand.\n",
        hand.stiffness, hand.damping, std::max(0.0, hand.mass), 100 * hand.explained);
  } else if (forces.constants_explain) {
    text +=
        "The constants of the file are wrong: with the values above, only the motors acted on the "
        "tip.\n";
  } else if (forces.other_acted()) {
    text +=
        "Forces other than those of the motors acted on the tip, but not those of a hand at rest: "
        "constants of the file are wrong, or a hand moved the tip.\n";
  } else {
    text += "Only the motors acted on the tip, within the resolution of the encoders.\n";
  }
  return text;
}

}  // namespace thimble::twin
