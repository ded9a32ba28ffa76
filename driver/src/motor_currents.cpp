#include "thimble/driver/motor_currents.h"

#include <cmath>

namespace thimble::driver {

MotorCurrents::MotorCurrents(const GatedForce& force, const Eigen::Matrix3d& R_WB,
                             const Eigen::Matrix3d& J_BT,
                             const std::array<MotorDrive, 3>& drives) noexcept {
  const Eigen::Vector3d f_T_B = R_WB.transpose() * force.f_T_W();
  const Eigen::Vector3d tau = J_BT.transpose() * f_T_B;
  const auto wanted = [&](std::size_t i) noexcept {
    const MotorDrive& drive = drives[i];
    return drive.sign * tau[static_cast<Eigen::Index>(i)] / (drive.ratio * drive.torque_constant);
  };
  const double a = wanted(0), b = wanted(1), c = wanted(2);
  double scale = 1;
  const auto keep_below_most = [&](std::size_t i, double amperes) noexcept {
    const double most = drives[i].current_max;
    if (std::abs(amperes) * scale > most) scale = most / std::abs(amperes);
  };
  keep_below_most(0, a);
  keep_below_most(1, b);
  keep_below_most(2, c);
  // A comparison with NaN is false, so anything that is not finite ends as zero.
  if (a * a + b * b + c * c < HUGE_VAL) {
    amperes_ = {scale * a, scale * b, scale * c};
    scale_ = scale;
  } else {
    scale_ = 0;
  }
}

}  // namespace thimble::driver
