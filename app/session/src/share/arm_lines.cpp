#include "share/arm_lines.h"

#include <cmath>
#include <variant>

#include "math/elementary.h"

namespace thimble::session {
namespace {

using Eigen::Vector3d;

std::vector<ArmLine> lines_of(const driver::SerialArm& arm, const Vector3d& q, const Vector3d&) {
  const Vector3d outwards(math::cos(q[0]), math::sin(q[0]), 0);
  const Vector3d shoulder(0, 0, arm.height);
  const Vector3d elbow =
      shoulder + arm.length_b * (math::sin(q[1]) * outwards + math::cos(q[1]) * Vector3d::UnitZ());
  const Vector3d tip =
      elbow + arm.length_c * (math::sin(q[2]) * outwards - math::cos(q[2]) * Vector3d::UnitZ());
  return {{Vector3d::Zero(), shoulder, elbow, tip}};
}

std::vector<ArmLine> lines_of(const driver::LinkageArm& arm, const Vector3d& q,
                              const Vector3d& p_BT) {
  const Vector3d outwards(math::cos(q[0]), math::sin(q[0]), 0);
  const auto at_angle = [&](double angle) -> Vector3d {
    return math::cos(angle) * outwards + math::sin(angle) * Vector3d::UnitZ();
  };
  const Vector3d front = 0.5 * arm.length_0 * outwards, back = -front;
  const Vector3d elbow = front + arm.length_1 * at_angle(q[1]);
  const Vector3d crank = back + arm.length_2 * at_angle(q[2]);
  const Vector3d joint = elbow - arm.length_4 * (p_BT - elbow) / arm.length_5;
  return {{joint, elbow, p_BT}, {back, front, elbow}, {back, crank, joint}};
}

std::vector<ArmLine> lines_of(const driver::DeltaArm& arm, const Vector3d& q,
                              const Vector3d& p_BT) {
  std::vector<ArmLine> lines(1);
  ArmLine base, plate;
  for (std::size_t leg = 0; leg < 3; ++leg) {
    const double angle = q[static_cast<Eigen::Index>(leg)];
    const Vector3d u(arm.outwards[leg].x(), arm.outwards[leg].y(), 0);
    const Vector3d v(-u.y(), u.x(), 0);
    const Vector3d joint = arm.r * u + arm.s * v;
    const Vector3d elbow =
        joint + arm.a * (math::cos(angle) * u + math::sin(angle) * Vector3d::UnitZ());
    const Vector3d end = p_BT + arm.c * u + arm.f * v;
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

/// Returns only the tip for an arm of unknown geometry.
std::vector<ArmLine> lines_of(const driver::VendorPoseArm&, const Vector3d&, const Vector3d& p_BT) {
  return {{p_BT}};
}

/// Returns the handle from its pivot, which is drawn on the y axis of the base: the tip's line is
/// its arc, straightened.
std::vector<ArmLine> lines_of(const driver::PaddleArm& arm, const Vector3d&, const Vector3d& p_BT) {
  return {{Vector3d(0, -arm.handle, 0), p_BT}};
}

std::vector<ArmLine> lines_of(const driver::FiveBarArm& arm, const Vector3d& q,
                              const Vector3d& p_BT) {
  const Vector3d motor(arm.base / 2, 0, 0);
  const Vector3d elbow_1 = arm.crank_1 * Vector3d(math::cos(q[0]), math::sin(q[0]), 0) - motor;
  const Vector3d elbow_2 = arm.crank_2 * Vector3d(math::cos(q[1]), math::sin(q[1]), 0) + motor;
  return {{-motor, elbow_1, p_BT, elbow_2, motor}};
}

/// Returns the rails from the origin of the base, one after the other.
std::vector<ArmLine> lines_of(const driver::CartesianArm&, const Vector3d&, const Vector3d& p_BT) {
  return {{Vector3d::Zero(), {p_BT.x(), 0, 0}, {p_BT.x(), p_BT.y(), 0}, p_BT}};
}

}  // namespace

std::vector<ArmLine> arm_lines(const SharedScene::Arm& arm, const driver::TickRecord& tick) {
  const Vector3d p_WT = Eigen::Map<const Vector3d>(tick.p_WT.data());
  const Vector3d q = Eigen::Map<const Vector3d>(tick.q.data());
  const Vector3d p_BT = arm.R_WB.transpose() * (p_WT - arm.p_WB);
  if (!arm.geometry) return {{p_WT}};
  std::vector<ArmLine> lines =
      std::visit([&](const auto& build) { return lines_of(build, q, p_BT); }, *arm.geometry);
  for (ArmLine& line : lines) {
    for (Vector3d& point : line) point = arm.p_WB + arm.R_WB * point;
  }
  return lines;
}

}  // namespace thimble::session
