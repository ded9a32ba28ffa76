#include "share/arm_lines.h"

#include <cmath>
#include <tuple>

namespace thimble::session {
namespace {

using Eigen::Vector3d;

std::vector<ArmLine> serial_lines(const std::array<double, 12>& n, const Vector3d& q) {
  const auto [height, length_b, length_c] = std::tuple(n[0], n[1], n[2]);
  const Vector3d outwards(std::cos(q[0]), std::sin(q[0]), 0);
  const Vector3d shoulder(0, 0, height);
  const Vector3d elbow =
      shoulder + length_b * (std::sin(q[1]) * outwards + std::cos(q[1]) * Vector3d::UnitZ());
  const Vector3d tip =
      elbow + length_c * (std::sin(q[2]) * outwards - std::cos(q[2]) * Vector3d::UnitZ());
  return {{Vector3d::Zero(), shoulder, elbow, tip}};
}

std::vector<ArmLine> linkage_lines(const std::array<double, 12>& n, const Vector3d& q,
                                   const Vector3d& p_BT) {
  const Vector3d outwards(std::cos(q[0]), std::sin(q[0]), 0);
  const auto at_angle = [&](double angle) -> Vector3d {
    return std::cos(angle) * outwards + std::sin(angle) * Vector3d::UnitZ();
  };
  const Vector3d front = 0.5 * n[0] * outwards, back = -front;
  const Vector3d elbow = front + n[1] * at_angle(q[1]);
  const Vector3d crank = back + n[2] * at_angle(q[2]);
  const Vector3d joint = elbow - n[4] * (p_BT - elbow) / n[5];
  return {{joint, elbow, p_BT}, {back, front, elbow}, {back, crank, joint}};
}

std::vector<ArmLine> delta_lines(const std::array<double, 12>& n, const Vector3d& q,
                                 const Vector3d& p_BT) {
  const auto [a, c, f, r, s] = std::tuple(n[0], n[2], n[5], n[6], n[7]);
  std::vector<ArmLine> lines(1);
  ArmLine base, plate;
  for (std::size_t leg = 0; leg < 3; ++leg) {
    const double azimuth = n[8 + leg];
    const double angle = q[static_cast<Eigen::Index>(leg)];
    const Vector3d u(std::cos(azimuth), std::sin(azimuth), 0);
    const Vector3d v(-std::sin(azimuth), std::cos(azimuth), 0);
    const Vector3d joint = r * u + s * v;
    const Vector3d elbow = joint + a * (std::cos(angle) * u + std::sin(angle) * Vector3d::UnitZ());
    const Vector3d end = p_BT + c * u + f * v;
    lines.push_back({joint, elbow, end});
    base.push_back(joint);
    plate.push_back(end);
  }
  base.push_back(base.front());
  plate.push_back(plate.front());
  lines.front() = {plate[0], p_BT};
  lines.push_back(base);
  lines.push_back(plate);
  return lines;
}

}  // namespace

std::vector<ArmLine> arm_lines(const SharedScene::Arm& arm, const driver::TickRecord& tick) {
  const Vector3d p_WT = Eigen::Map<const Vector3d>(tick.p_WT.data());
  const Vector3d q = Eigen::Map<const Vector3d>(tick.q.data());
  const Vector3d p_BT = arm.R_WB.transpose() * (p_WT - arm.p_WB);
  std::vector<ArmLine> lines;
  switch (arm.shape) {
    case SharedArmShape::kUnknown:
      return {{p_WT}};
    case SharedArmShape::kSerial:
      lines = serial_lines(arm.numbers, q);
      break;
    case SharedArmShape::kLinkage:
      lines = linkage_lines(arm.numbers, q, p_BT);
      break;
    case SharedArmShape::kDelta:
      lines = delta_lines(arm.numbers, q, p_BT);
      break;
  }
  for (ArmLine& line : lines) {
    for (Vector3d& point : line) point = arm.p_WB + arm.R_WB * point;
  }
  return lines;
}

}  // namespace thimble::session
