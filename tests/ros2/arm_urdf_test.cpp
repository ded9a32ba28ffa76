// The arm as a URDF: its joint angles must put the tip where the driver's geometry has it.
#include "ros2/arm_urdf.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <optional>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

namespace thimble::ros2 {
namespace {

/// A joint of a URDF. The test has its own small parser, independent of the writer.
struct Joint {
  std::string name, type, parent, child, mimic;
  Eigen::Vector3d xyz{0, 0, 0}, rpy{0, 0, 0}, axis{1, 0, 0};
  double multiplier = 1;
};

std::string attribute(const std::string& text, const std::string& element,
                      const std::string& name) {
  std::smatch found;
  const std::regex wanted("<" + element + "[^>]*\\b" + name + "=\"([^\"]*)\"");
  return std::regex_search(text, found, wanted) ? found[1].str() : "";
}

Eigen::Vector3d vector(const std::string& text) {
  std::istringstream stream(text);
  Eigen::Vector3d v(0, 0, 0);
  stream >> v.x() >> v.y() >> v.z();
  return v;
}

std::vector<Joint> joints_of(const std::string& urdf) {
  std::vector<Joint> joints;
  for (std::size_t begin = urdf.find("<joint name"); begin != std::string::npos;
       begin = urdf.find("<joint name", begin + 1)) {
    const std::string text = urdf.substr(begin, urdf.find("</joint>", begin) - begin);
    Joint joint;
    joint.name = attribute(text, "joint", "name");
    joint.type = attribute(text, "joint", "type");
    joint.parent = attribute(text, "parent", "link");
    joint.child = attribute(text, "child", "link");
    joint.mimic = attribute(text, "mimic", "joint");
    if (!joint.mimic.empty()) joint.multiplier = std::stod(attribute(text, "mimic", "multiplier"));
    joint.xyz = vector(attribute(text, "origin", "xyz"));
    joint.rpy = vector(attribute(text, "origin", "rpy"));
    if (text.find("<axis") != std::string::npos)
      joint.axis = vector(attribute(text, "axis", "xyz"));
    joints.push_back(joint);
  }
  return joints;
}

/// Returns the pose of a link in the root frame at these joint angles.
Eigen::Isometry3d place_of(const std::string& link, const std::vector<Joint>& joints,
                           const std::map<std::string, double>& angles) {
  for (const Joint& joint : joints) {
    if (joint.child != link) continue;
    Eigen::Isometry3d T = place_of(joint.parent, joints, angles);
    T.translate(joint.xyz);
    T.rotate(Eigen::AngleAxisd(joint.rpy.z(), Eigen::Vector3d::UnitZ()) *
             Eigen::AngleAxisd(joint.rpy.y(), Eigen::Vector3d::UnitY()) *
             Eigen::AngleAxisd(joint.rpy.x(), Eigen::Vector3d::UnitX()));
    if (joint.type == "fixed") return T;
    const auto angle = angles.find(joint.mimic.empty() ? joint.name : joint.mimic);
    if (angle == angles.end()) {
      ADD_FAILURE() << "no angle for " << joint.name;
      return T;
    }
    T.rotate(Eigen::AngleAxisd(joint.multiplier * angle->second, joint.axis));
    return T;
  }
  return Eigen::Isometry3d::Identity();
}

TEST(ArmUrdf, TipOfASerialArmAgreesWithTheDriver) {
  for (const char* name : {"vintage_phantom", "woodenhaptics"}) {
    scene::ArmFile arm = scene::load_arm(name).value();
    // Rotated about all axes, so that a wrong order of rotations is detected.
    arm.R_WB = (Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()) *
                Eigen::AngleAxisd(-0.4, Eigen::Vector3d::UnitY()) *
                Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()))
                   .toRotationMatrix();
    const auto joints = joints_of(arm_urdf(arm, "world"));
    ASSERT_EQ(joints.size(), 6u);
    const std::string tip = joints.back().child;
    const auto& build = std::get<driver::SerialArm>(arm.model.geometry);
    for (const Eigen::Vector3d& q : {Eigen::Vector3d(0, 0.3, 0.2), Eigen::Vector3d(0.5, 1.1, -0.4),
                                     Eigen::Vector3d(-0.9, 0.1, 0.8)}) {
      const auto T = place_of(tip, joints, {{"joint1", q[0]}, {"joint2", q[1]}, {"joint3", q[2]}});
      const Eigen::Vector3d expected = arm.p_WB + arm.R_WB * build.forward(q);
      EXPECT_LT((T.translation() - expected).norm(), 1e-8) << name << " at " << q.transpose();
    }
  }
}

TEST(ArmUrdf, ElbowOfALinkageAgreesWithTheDriver) {
  const scene::ArmFile arm = scene::load_arm("polhem").value();
  const auto joints = joints_of(arm_urdf(arm, "world"));
  const auto& build = std::get<driver::LinkageArm>(arm.model.geometry);
  const Eigen::Vector3d q = arm.model.joint_angles({});
  Eigen::Vector3d p_BT;
  Eigen::Matrix3d J;
  build.forward(q, p_BT, J);
  // The elbow is the start of the forearm: length_5 behind the tip, along the forearm.
  const Eigen::Vector3d along = build.last_link(q, p_BT).col(0);
  const Eigen::Vector3d elbow = arm.p_WB + arm.R_WB * (p_BT - build.length_5 * along);
  const auto T =
      place_of("polhem_front_bar", joints, {{"joint1", q[0]}, {"joint2", q[1]}, {"joint3", q[2]}});
  EXPECT_LT((T * Eigen::Vector3d(build.length_1, 0, 0) - elbow).norm(), 1e-8);
}

TEST(ArmUrdf, ElbowsOfAFiveBarAgreeWithTheDriver) {
  for (const char* name : {"five_bar", "haply_2diy_1", "haply_2diy_2", "haply_2diy_3"}) {
    SCOPED_TRACE(name);
    const scene::ArmFile arm = scene::load_arm(name).value();
    const auto joints = joints_of(arm_urdf(arm, "world"));
    const std::string prefix = std::string(name) + "_";
    ASSERT_EQ(joints.size(), 3u);  // the stand and one for each motor
    const auto& build = std::get<driver::FiveBarArm>(arm.model.geometry);
    const Eigen::Vector3d middle = arm.R_WB.transpose() * (arm.workspace.middle() - arm.p_WB);
    for (const Eigen::Vector3d& away : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0.01, -0.01, 0),
                                        Eigen::Vector3d(-0.02, 0.01, 0)}) {
      const auto q = build.inverse(middle + away);
      ASSERT_TRUE(q);
      const Eigen::Vector3d p_WT = arm.p_WB + arm.R_WB * (middle + away);
      const std::map<std::string, double> angles{{"joint1", (*q)[0]}, {"joint2", (*q)[1]}};
      // The distal bars close the loop from the ends of the cranks to the tip.
      const Eigen::Vector3d elbow_1 =
          place_of(prefix + "crank_1", joints, angles) * Eigen::Vector3d(build.crank_1, 0, 0);
      const Eigen::Vector3d elbow_2 =
          place_of(prefix + "crank_2", joints, angles) * Eigen::Vector3d(build.crank_2, 0, 0);
      EXPECT_NEAR((elbow_1 - p_WT).norm(), build.distal_1, 1e-8);
      EXPECT_NEAR((elbow_2 - p_WT).norm(), build.distal_2, 1e-8);
    }
  }
}

TEST(ArmUrdf, IsATreeWithOneRootForEveryShippedArm) {
  for (const char* name : {"vintage_phantom", "woodenhaptics", "polhem", "falcon", "touch",
                           "omega3", "five_bar", "hapkit"}) {
    SCOPED_TRACE(name);
    const std::string urdf = arm_urdf(scene::load_arm(name).value(), "map");
    std::map<std::string, int> parents;
    const std::regex link("<link name=\"([^\"]*)\"");
    for (auto one = std::sregex_iterator(urdf.begin(), urdf.end(), link);
         one != std::sregex_iterator(); ++one) {
      EXPECT_TRUE(parents.emplace((*one)[1].str(), 0).second) << "twice: " << (*one)[1].str();
    }
    for (const Joint& joint : joints_of(urdf)) {
      ASSERT_TRUE(parents.contains(joint.parent)) << joint.parent;
      ASSERT_TRUE(parents.contains(joint.child)) << joint.child;
      ++parents[joint.child];
    }
    int roots = 0;
    for (const auto& [at, count] : parents) {
      EXPECT_LE(count, 1) << at;
      roots += count == 0 ? 1 : 0;
      EXPECT_NE(at, "tip") << "which /tf has";
    }
    EXPECT_EQ(roots, 1);
    EXPECT_EQ(parents.at("map"), 0);
    // Opening and closing tags must balance.
    const auto count = [&urdf](const std::string& what) {
      std::size_t found = 0;
      for (std::size_t at = urdf.find(what); at != std::string::npos; at = urdf.find(what, at + 1))
        ++found;
      return found;
    };
    EXPECT_EQ(count("<joint name"), count("</joint>"));
    EXPECT_EQ(urdf.find("nan"), std::string::npos);
    EXPECT_EQ(urdf.find("inf"), std::string::npos);
  }
}

}  // namespace
}  // namespace thimble::ros2
