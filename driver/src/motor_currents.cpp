#include "thimble/driver/motor_currents.h"

#include <cmath>

namespace thimble::driver {

MotorCurrents::MotorCurrents(const GatedForce& force, const Eigen::Matrix3d& R_WB,
                             const Eigen::Matrix3d& J_BT,
                             const std::array<MotorDrive, 3>& drives) noexcept {
  const Eigen::Vector3d f_T_B = R_WB.transpose() * force.f_T_W();
  const Eigen::Vector3d tau = J_BT.transpose() * f_T_B;
  Eigen::Vector3d amperes;
  double scale = 1;
  for (int i = 0; i < 3; ++i) {
    const MotorDrive& drive = drives[static_cast<std::size_t>(i)];
    amperes[i] = drive.sign * tau[i] / (drive.ratio * drive.torque_constant);
    const double wanted = std::abs(amperes[i]);
    if (wanted * scale > drive.current_max) scale = drive.current_max / wanted;
  }
  // A comparison with NaN is false, so anything that is not finite becomes zero.
  if (amperes.squaredNorm() < HUGE_VAL) {
    amperes_ = scale * amperes;
    scale_ = scale;
  } else {
    scale_ = 0;
  }
}

}  // namespace thimble::driver
