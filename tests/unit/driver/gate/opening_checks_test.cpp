// The C++ API refuses to open an arm with impossible or unsafe settings. The error names the
// setting and the remedy.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <string>

#include "support/moved_arm.h"
#include "thimble/driver/device.h"

namespace thimble::driver::opening_checks_test {
namespace {

/// Returns the error for an arm with changed settings; empty if it is opened.
std::string refusal(const std::function<void(DeviceSettings&)>& change) {
  support::Moved moved;
  DeviceSettings settings = support::moved_settings();
  change(settings);
  const auto device = Device::open(std::make_unique<support::MovedArm>(moved), settings, 0);
  return device ? std::string() : device.error().message;
}

bool names(const std::string& message, const char* what) {
  return message.find(what) != std::string::npos;
}

TEST(OpeningChecks, RefuseImpossibleForces) {
  for (const double force : {100.001, 1e4, 1e308}) {
    EXPECT_TRUE(names(refusal([=](auto& s) { s.limits.force_max = force; }), "force_max")) << force;
  }
  EXPECT_EQ(refusal([](auto& s) { s.limits.force_max = 100; }), "");
}

TEST(OpeningChecks, RefuseImpossibleSpeeds) {
  for (const double speed : {20.001, 1e308}) {
    EXPECT_TRUE(names(refusal([=](auto& s) { s.limits.speed_max = speed; }), "speed_max")) << speed;
  }
  EXPECT_EQ(refusal([](auto& s) { s.limits.speed_max = 20; }), "");
}

TEST(OpeningChecks, RefuseInvalidRotations) {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  Eigen::Matrix3d mirror = turn, shear = turn, unknown = turn;
  mirror.col(0) *= -1;
  shear(0, 1) += 1e-3;
  unknown(2, 2) = std::nan("");
  for (const Eigen::Matrix3d& bad :
       {Eigen::Matrix3d(2 * turn), Eigen::Matrix3d(Eigen::Matrix3d::Zero()), mirror, shear,
        unknown}) {
    EXPECT_TRUE(names(refusal([&](auto& s) { s.R_WB = bad; }), "rotation")) << bad;
  }
}

TEST(OpeningChecks, AcceptRotationsWithEightDigits) {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  EXPECT_EQ(refusal([&](auto& s) { s.R_WB = turn; }), "");
  // Rounded to eight digits, as in files.
  EXPECT_EQ(refusal([&](auto& s) { s.R_WB = (1e8 * turn).array().round().matrix() / 1e8; }), "");
}

TEST(OpeningChecks, RefuseInvalidPositions) {
  for (const double x : {11.0, 1e300, static_cast<double>(NAN), HUGE_VAL}) {
    EXPECT_TRUE(names(refusal([=](auto& s) { s.p_WB = {0, x, 0}; }), "p_WB")) << x;
  }
}

TEST(OpeningChecks, RefuseInvalidFilters) {
  for (const double corner : {-1.0, static_cast<double>(NAN), HUGE_VAL}) {
    EXPECT_TRUE(names(refusal([=](auto& s) { s.velocity_corner_frequency = corner; }),
                      "velocity_corner_frequency"))
        << corner;
  }
}

}  // namespace
}  // namespace thimble::driver::opening_checks_test
