#include "ros2/arm_urdf.h"

#include <fmt/format.h>

#include <cmath>

#include "ros2/ros_names.h"

namespace thimble::ros2 {
namespace {

constexpr double kThick = 0.006;  // m, drawn radius of the links [chosen]
constexpr double kTip = 0.008;    // m, drawn radius of the tip

/// Returns roll, pitch and yaw of a rotation in URDF's convention: R = Rz(yaw) Ry(pitch) Rx(roll).
Eigen::Vector3d rpy_of(const Eigen::Matrix3d& R) {
  const double pitch = std::atan2(-R(2, 0), std::hypot(R(0, 0), R(1, 0)));
  return {std::atan2(R(2, 1), R(2, 2)), pitch, std::atan2(R(1, 0), R(0, 0))};
}

/// Writes the links and joints of one arm.
class Writer {
 public:
  Writer(const scene::ArmFile& arm, const std::string& world, const std::string& name_in_scene)
      : arm_(arm) {
    const std::string robot =
        frame_name_of(name_in_scene.empty() ? arm.name : name_in_scene + "_" + arm.name);
    prefix_ = robot + "_";
    text_ = fmt::format("<?xml version=\"1.0\"?>\n<robot name=\"{}\">\n  <link name=\"{}\"/>\n",
                        robot, frame_name_of(world));
    const Eigen::Vector3d rpy = rpy_of(arm.R_WB);
    text_ += fmt::format("  <link name=\"{}base\">\n{}  </link>\n", prefix_,
                         visual("<sphere radius=\"0.012\"/>", {0, 0, 0}, {0, 0, 0}));
    text_ += fmt::format(
        "  <joint name=\"{}stand\" type=\"fixed\">\n    <parent link=\"{}\"/>\n    <child "
        "link=\"{}base\"/>\n    <origin xyz=\"{}\" rpy=\"{}\"/>\n  </joint>\n",
        prefix_, frame_name_of(world), prefix_, numbers(arm.p_WB), numbers(rpy));
  }

  /// Writes a link that is a bar from its joint to `end` (m, in its frame); a bar without length is
  /// not drawn.
  void bar(const char* name, const Eigen::Vector3d& end) {
    const double length = end.norm();
    text_ += fmt::format("  <link name=\"{}{}\">\n", prefix_, name);
    if (length > 0) {
      // A cylinder has its axis along z.
      const Eigen::Vector3d way = end / length;
      const double pitch = std::atan2(std::hypot(way.x(), way.y()), way.z());
      text_ += visual(fmt::format("<cylinder radius=\"{}\" length=\"{}\"/>", kThick, length),
                      end / 2, {0, pitch, std::atan2(way.y(), way.x())});
    }
    text_ += "  </link>\n";
  }

  /// Writes a joint with an encoder; `number` from 0.
  void joint(int number, const char* parent, const char* child, const Eigen::Vector3d& p,
             const Eigen::Vector3d& axis) {
    const driver::MotorDrive& drive = arm_.model.drives[static_cast<std::size_t>(number)];
    begin_joint(fmt::format("joint{}", number + 1), parent, child, p, axis);
    text_ += fmt::format(
        "    <limit lower=\"{0}\" upper=\"{1}\" effort=\"{2:.6g}\" velocity=\"{3:.6g}\"/>\n"
        "  </joint>\n",
        -kTurn, kTurn, std::abs(drive.ratio * drive.torque_constant) * drive.current_max, kFast);
  }

  /// Writes a joint that compensates the rotation of joint2.
  void level_joint(const char* parent, const char* child, const Eigen::Vector3d& p,
                   const Eigen::Vector3d& axis) {
    begin_joint(prefix_ + "level", parent, child, p, axis);
    text_ += fmt::format(
        "    <limit lower=\"{0}\" upper=\"{1}\" effort=\"0\" velocity=\"{2:.6g}\"/>\n"
        "    <mimic joint=\"joint2\" multiplier=\"-1\" offset=\"0\"/>\n  </joint>\n",
        -kTurn, kTurn, kFast);
  }

  void tip(const char* parent, const Eigen::Vector3d& p) {
    const double mass = arm_.simulated.plant.mass;
    text_ +=
        fmt::format("  <link name=\"{}tip\">\n{}", prefix_,
                    visual(fmt::format("<sphere radius=\"{}\"/>", kTip), {0, 0, 0}, {0, 0, 0}));
    if (mass > 0) {
      // Inertia of a ball of the drawn size: some programs reject a mass without inertia.
      const double inertia = 0.4 * mass * kTip * kTip;
      text_ += fmt::format(
          "    <inertial>\n      <mass value=\"{0:.6g}\"/>\n      <inertia ixx=\"{1:.6g}\" "
          "iyy=\"{1:.6g}\" izz=\"{1:.6g}\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/>\n    </inertial>\n",
          mass, inertia);
    }
    text_ += fmt::format(
        "  </link>\n  <joint name=\"{0}end\" type=\"fixed\">\n    <parent link=\"{0}{1}\"/>\n"
        "    <child link=\"{0}tip\"/>\n    <origin xyz=\"{2}\" rpy=\"0 0 0\"/>\n  </joint>\n",
        prefix_, parent, numbers(p));
  }

  std::string take() && { return std::move(text_) + "</robot>\n"; }

 private:
  static constexpr double kTurn = 3.1416;  // rad: arm files contain no limits of single joints
  static constexpr double kFast = 20;      // rad/s, faster than any hand [chosen]

  static std::string numbers(const Eigen::Vector3d& v) {
    return fmt::format("{:.9g} {:.9g} {:.9g}", v.x(), v.y(), v.z());
  }
  static std::string visual(const std::string& shape, const Eigen::Vector3d& p,
                            const Eigen::Vector3d& rpy) {
    return fmt::format(
        "    <visual>\n      <origin xyz=\"{}\" rpy=\"{}\"/>\n      <geometry>{}</geometry>\n"
        "    </visual>\n",
        numbers(p), numbers(rpy), shape);
  }
  void begin_joint(const std::string& name, const char* parent, const char* child,
                   const Eigen::Vector3d& p, const Eigen::Vector3d& axis) {
    text_ += fmt::format(
        "  <joint name=\"{0}\" type=\"revolute\">\n    <parent link=\"{1}{2}\"/>\n"
        "    <child link=\"{1}{3}\"/>\n    <origin xyz=\"{4}\" rpy=\"0 0 0\"/>\n"
        "    <axis xyz=\"{5}\"/>\n",
        name, prefix_, parent, child, numbers(p), numbers(axis));
  }

  const scene::ArmFile& arm_;
  std::string prefix_;
  std::string text_;
};

}  // namespace

std::string arm_urdf(const scene::ArmFile& arm, const std::string& world_frame,
                     const std::string& name_in_scene) {
  const Eigen::Vector3d up(0, 0, 1), right(0, 1, 0), left(0, -1, 0), here(0, 0, 0);
  Writer writer(arm, world_frame, name_in_scene);
  if (const auto* serial = std::get_if<driver::SerialArm>(&arm.model.geometry)) {
    const Eigen::Vector3d shoulder(0, 0, serial->height), elbow(0, 0, serial->length_b),
        tip(0, 0, -serial->length_c);
    writer.bar("yaw", shoulder);
    writer.joint(0, "base", "yaw", here, up);
    writer.bar("upper", elbow);
    writer.joint(1, "yaw", "upper", shoulder, right);
    writer.bar("level", here);
    writer.level_joint("upper", "level", elbow, right);
    writer.bar("lower", tip);
    writer.joint(2, "level", "lower", here, left);
    writer.tip("lower", tip);
  } else if (const auto* linkage = std::get_if<driver::LinkageArm>(&arm.model.geometry)) {
    const Eigen::Vector3d aside(linkage->length_0 / 2, 0, 0);
    writer.bar("yaw", here);
    writer.joint(0, "base", "yaw", here, up);
    writer.bar("front_bar", {linkage->length_1, 0, 0});
    writer.joint(1, "yaw", "front_bar", aside, left);
    writer.bar("crank", {linkage->length_2, 0, 0});
    writer.joint(2, "yaw", "crank", -aside, left);
  } else if (const auto* five_bar = std::get_if<driver::FiveBarArm>(&arm.model.geometry)) {
    const Eigen::Vector3d aside(five_bar->base / 2, 0, 0);
    writer.bar("crank_1", {five_bar->crank_1, 0, 0});
    writer.joint(0, "base", "crank_1", -aside, up);
    writer.bar("crank_2", {five_bar->crank_2, 0, 0});
    writer.joint(1, "base", "crank_2", aside, up);
  }
  return std::move(writer).take();
}

}  // namespace thimble::ros2
