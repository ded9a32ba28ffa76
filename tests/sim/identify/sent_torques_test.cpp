#include "bringup/identify/sent_torques.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/identify/identified_arm.h"

namespace thimble::bringup {
namespace {

Eigen::Vector3d per_ampere(const scene::ArmFile& file) {
  Eigen::Vector3d tau;
  for (std::size_t i = 0; i < 3; ++i) {
    const driver::MotorDrive& drive = file.model.drives[i];
    tau[static_cast<Eigen::Index>(i)] = drive.sign * drive.ratio * drive.torque_constant;
  }
  return tau;
}

TEST(SentTorques, AreThoseOfWholeMilliamperes) {
  const scene::ArmFile file = scene::load_arm("woodenhaptics").value();
  const Eigen::Vector3d unit = per_ampere(file);
  const Eigen::Vector3d asked(0.1234, -0.20070, 0.00049), carried(0.123, -0.201, 0);
  const SentTorques torques(file);
  EXPECT_LT((torques.sent(unit.cwiseProduct(asked)) - unit.cwiseProduct(carried)).norm(), 1e-12);
}

TEST(SentTorques, OfMotorsThatTheArmLacksAreZero) {
  const scene::ArmFile file = scene::load_arm("hapkit").value();
  const Eigen::Vector3d tau = SentTorques(file).sent({0.09, 0.1, 0.1});
  EXPECT_NEAR(tau[0], 0.203 * 14.8 * 0.03, 1e-12);  // 202.7 mA
  EXPECT_EQ(tau[1], 0);
  EXPECT_EQ(tau[2], 0);
}

TEST(SentTorques, FollowTheStepsOfADescribedWire) {
  // The messages of the reference firmware have currents of 24 binary digits.
  const scene::ArmFile file = scene::load_arm("reference_five_bar").value();
  const Eigen::Vector3d unit = per_ampere(file), asked(0.1234567891234, -0.2, 0);
  const Eigen::Vector3d tau = SentTorques(file).sent(unit.cwiseProduct(asked));
  for (Eigen::Index i = 0; i < 2; ++i) {
    EXPECT_EQ(tau[i], unit[i] * static_cast<double>(static_cast<float>(asked[i])));
  }
}

TEST(SentTorques, LeaveNoBiasInTheGainOfAPaddle) {
  // The force is at its limit of 1 N in half of the ticks. That is 202.7 mA, and the wire carries
  // 203 mA: the gain was 0.1 % too high.
  support::HiddenArm arm{.file = scene::load_arm("hapkit").value()};
  arm.file.simulated.plant.coulomb = 0.02;
  const auto found =
      support::identified(arm, {.seconds = 10, .known_mass = support::kKnownMass, .max_force = 2});
  ASSERT_TRUE(found.ok()) << found.error().message;
  EXPECT_NEAR(found->constants.gain[0].value, 1, 3e-4);
  EXPECT_TRUE(found->constants.gain[0].holds(1));
}

}  // namespace
}  // namespace thimble::bringup
