#include "plant/linked_tip.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <functional>

#include "plant/drive_train_plant.h"
#include "support/identify/rigid_links.h"
#include "support/random.h"
#include "support/refuses.h"
#include "vintage_simulation.h"

namespace thimble::device_sim {
namespace {

using support::desk_links;
using support::RigidLinks;

constexpr std::int64_t kMillisecond = 1'000'000;
const Eigen::Vector3d kTilted(1.2, -2.1, -9.4);  // gravity for a tilted base, m/s^2

driver::SerialArm geometry() {
  return support::vintage_model().geometry;
}

Eigen::Vector3d some_place(support::Random& random) {
  const auto off = [&] { return random.uniform(-0.05, 0.05); };
  return home_tip() + Eigen::Vector3d(off(), off(), off());
}

LinkedSerialPlant plant_with(const SimulatedArmSettings& settings, const Eigen::Vector3d& p_BT) {
  return LinkedSerialPlant::make(support::vintage_model(), settings, p_BT, p_BT).value();
}

/// A tip without friction, with links.
SimulatedArmSettings linked_arm(const RigidLinks& links) {
  SimulatedArmSettings settings = free_arm();
  settings.links = links.settings();
  return settings;
}

/// The same arm with the tip's mass as an additional body without weight, for its acceleration.
Eigen::Vector3d acceleration(const RigidLinks& links, const SimulatedArmSettings& settings,
                             const Eigen::Vector3d& tau, const Eigen::Vector3d& q,
                             const Eigen::Vector3d& rate) {
  const RigidLinks tip({{.mass = settings.plant.mass,
                         .along_b = geometry().length_b,
                         .along_c = geometry().length_c}},
                       Eigen::Vector3d::Zero());
  const Eigen::Vector3d pull = settings.hand.stiffness * (home_tip() - geometry().forward(q));
  const Eigen::Vector3d all =
      tau + links.torque(q, rate) + tip.torque(q, rate) + geometry().jacobian(q).transpose() * pull;
  return (links.inertia(q) + tip.inertia(q)).inverse() * all;
}

TEST(LinkMechanics, MatchLagrangesEquationsOfTheBodies) {
  support::Random random(3);
  const RigidLinks links = desk_links(geometry(), 1, kTilted);
  const LinkMechanics mechanics(geometry(), links.settings());
  for (int trial = 0; trial < 50; ++trial) {
    const Eigen::Vector3d q = geometry().inverse(some_place(random)).value();
    const Eigen::Vector3d rate(random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-3, 3));
    const LinkMotion found = mechanics.at(q, rate);
    const Eigen::Matrix3d M = links.inertia(q);
    ASSERT_LT((found.inertia - M).norm(), 1e-6 * M.norm());
    const Eigen::Vector3d torque = links.torque(q, rate);
    ASSERT_LT((found.torque - torque).norm(), 1e-6 * torque.norm());
    constexpr double kStep = 1e-4;
    const Eigen::Vector3d turning =
        (geometry().forward(q + kStep * rate) - 2 * geometry().forward(q) +
         geometry().forward(q - kStep * rate)) /
        (kStep * kStep);
    ASSERT_LT((found.turning - turning).norm(), 1e-5 * turning.norm());
  }
}

TEST(LinkedTip, MotionMatchesLagrangeWithRungeKutta) {
  const RigidLinks links = desk_links(geometry(), 1, kTilted);
  SimulatedArmSettings settings = linked_arm(links);
  settings.hand.stiffness = 50;
  LinkedSerialPlant plant = plant_with(settings, home_tip());
  const Eigen::Vector3d amperes(0.1, 0.15, -0.1);
  plant.set_currents(amperes);
  const auto model = support::vintage_model();
  Eigen::Vector3d tau;
  for (int i = 0; i < 3; ++i) {
    const driver::MotorDrive& drive = model.drives[static_cast<std::size_t>(i)];
    tau[i] = drive.sign * drive.ratio * drive.torque_constant * amperes[i];
  }
  Eigen::Vector3d q = support::vintage_home(), rate(0, 0, 0);
  const auto a = [&](const Eigen::Vector3d& at, const Eigen::Vector3d& passed) {
    return acceleration(links, settings, tau, at, passed);
  };
  constexpr double h = 1e-3;
  double way = 0;
  for (int k = 0; k < 300; ++k) {
    plant.step(home_tip(), kMillisecond);
    const Eigen::Vector3d v1 = rate, a1 = a(q, v1);
    const Eigen::Vector3d v2 = rate + 0.5 * h * a1, a2 = a(q + 0.5 * h * v1, v2);
    const Eigen::Vector3d v3 = rate + 0.5 * h * a2, a3 = a(q + 0.5 * h * v2, v3);
    const Eigen::Vector3d v4 = rate + h * a3, a4 = a(q + h * v3, v4);
    q += h / 6 * (v1 + 2 * v2 + 2 * v3 + v4);
    rate += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
    ASSERT_LT((plant.p_BT() - geometry().forward(q)).norm(), 2e-8) << "after " << k << " ms";
    way = std::max(way, (plant.p_BT() - home_tip()).norm());
  }
  EXPECT_GT(way, 0.015);
  EXPECT_EQ(plant.stops(), 0U);
}

/// Returns the tip position 0.2 s after its release, for steps of the given length.
Eigen::Vector3d let_go(std::int64_t dt_ns) {
  SimulatedArmSettings settings = linked_arm(desk_links(geometry(), 1, kTilted));
  settings.hand = {.mass = 0, .stiffness = 100, .damping = 0.5};
  LinkedTip tip = LinkedTip::make(geometry(), settings, home_tip()).value();
  const Eigen::Vector3d p_BH = home_tip() + Eigen::Vector3d(0.02, 0.03, -0.02);
  for (std::int64_t t = 0; t < 200 * kMillisecond; t += dt_ns) {
    const Eigen::Vector3d half = tip.p_BT() + 0.5e-9 * static_cast<double>(dt_ns) * tip.v_BT();
    tip.step(tip_pose(geometry(), half), {0, 0, 0}, p_BH, {0, 0, 0}, dt_ns);
  }
  return tip.p_BT();
}

TEST(LinkedTip, IsOfSecondOrderInItsStep) {
  const Eigen::Vector3d fine = let_go(kMillisecond / 40);
  const double coarse = (let_go(kMillisecond) - fine).norm();
  const double half = (let_go(kMillisecond / 2) - fine).norm();
  EXPECT_LT(coarse, 1e-4);
  EXPECT_NEAR(coarse / half, 4, 0.4);
}

TEST(LinkedTip, ConservesEnergyWithoutFriction) {
  const RigidLinks links = desk_links(geometry(), 1, kTilted);
  SimulatedArmSettings settings = linked_arm(links);
  settings.hand.stiffness = 200;
  const Eigen::Vector3d p_BH = home_tip() + Eigen::Vector3d(0.01, 0.04, -0.02);
  LinkedSerialPlant plant =
      LinkedSerialPlant::make(support::vintage_model(), settings, home_tip(), p_BH).value();
  const auto energy = [&] {
    const Eigen::Vector3d q = geometry().inverse(plant.p_BT()).value();
    const Eigen::Vector3d rate = geometry().jacobian(q).inverse() * plant.v_BT();
    return links.kinetic(q, rate) + links.potential(q) +
           0.5 * settings.plant.mass * plant.v_BT().squaredNorm() +
           0.5 * settings.hand.stiffness * (plant.p_BT() - p_BH).squaredNorm();
  };
  const double at_first = energy();
  const double given = 0.5 * settings.hand.stiffness * (home_tip() - p_BH).squaredNorm();
  for (int k = 0; k < 5000; ++k) {
    plant.step(p_BH, kMillisecond);
    if (k % 100 != 0) continue;
    ASSERT_NEAR(energy() - at_first, 0, 1e-6 * given) << "after " << k << " ms";
  }
  EXPECT_EQ(plant.stops(), 0U);
}

TEST(LinkedTip, ApparentMassMatchesTheLinksInEachPose) {
  support::Random random(5);
  const RigidLinks links = desk_links(geometry(), 1, Eigen::Vector3d::Zero());
  const SimulatedArmSettings settings = linked_arm(links);
  double most = 0, least = 1;
  for (int trial = 0; trial < 30; ++trial) {
    const Eigen::Vector3d p_BT = some_place(random);
    const Eigen::Vector3d q = geometry().inverse(p_BT).value();
    const Eigen::Matrix3d G = geometry().jacobian(q).inverse();
    const Eigen::Matrix3d mass =
        G.transpose() * links.inertia(q) * G + settings.plant.mass * Eigen::Matrix3d::Identity();
    LinkedTip tip = LinkedTip::make(geometry(), settings, p_BT).value();
    const Eigen::Vector3d force(random.uniform(-1, 1), random.uniform(-1, 1),
                                random.uniform(-1, 1));
    tip.step(tip_pose(geometry(), p_BT), force, p_BT, {0, 0, 0}, 1000);
    ASSERT_LT((mass * tip.v_BT() / 1e-6 - force).norm(), 1e-6 * force.norm());
    most = std::max(most, mass(1, 1)), least = std::min(least, mass(1, 1));
  }
  EXPECT_GT(most, 1.2 * least);
}

TEST(LinkedTip, EqualsPointTipForMasslessLinks) {
  SimulatedArmSettings settings = phantom_like();
  settings.weight_B = {0, 0, -0.1};
  SerialDriveTrainPlant point =
      SerialDriveTrainPlant::make(support::vintage_model(), settings, home_tip(), home_tip())
          .value();
  settings.links.inertia.setConstant(1e-15);
  LinkedSerialPlant linked = plant_with(settings, home_tip());
  int held = 0;
  for (int k = 0; k < 1000; ++k) {
    const double t = 1e-3 * k;
    const Eigen::Vector3d p_BH =
        home_tip() + 0.01 * Eigen::Vector3d(std::sin(7 * t), std::sin(11 * t), std::sin(5 * t));
    const Eigen::Vector3d amperes(0.2 * std::sin(30 * t), 0.1, 0.1 * std::cos(20 * t));
    for (Plant* plant : {static_cast<Plant*>(&point), static_cast<Plant*>(&linked)}) {
      plant->set_currents(amperes);
      plant->step(p_BH, kMillisecond);
    }
    held += static_cast<int>((point.v_BT().array() == 0).count());
    // Friction of 0.04 N that acts 25 us too long or too short causes an error of 0.4 um in 40 ms.
    ASSERT_LT((point.p_BT() - linked.p_BT()).norm(), 1e-6) << "after " << k << " ms";
  }
  EXPECT_GT(held, 10);
}

TEST(LinkedTip, FrictionHoldsTheLinksExactly) {
  SimulatedArmSettings settings = linked_arm(desk_links(geometry()));
  const Eigen::Vector3d q = support::vintage_home();
  const Eigen::Vector3d pull = geometry().jacobian(q).transpose().inverse() *
                               desk_links(geometry()).torque(q, Eigen::Vector3d::Zero());
  settings.plant.coulomb = 1.01 * pull.cwiseAbs().maxCoeff();
  LinkedSerialPlant stays = plant_with(settings, home_tip());
  settings.plant.coulomb = 0.9 * pull.cwiseAbs().maxCoeff();
  LinkedSerialPlant falls = plant_with(settings, home_tip());
  for (int k = 0; k < 100; ++k) {
    stays.step(home_tip(), kMillisecond);
    falls.step(home_tip(), kMillisecond);
  }
  EXPECT_EQ(stays.p_BT(), home_tip());
  EXPECT_GT((falls.p_BT() - home_tip()).norm(), 1e-4);
}

TEST(LinkedTip, OscillatesAgainstItsMotorOnACable) {
  // The yaw joint at home: links of 1e-3 kg m^2 and a tip of 0.1 kg at 138 mm, against a motor.
  SimulatedArmSettings settings = free_arm();
  settings.links.inertia = {1e-3, 0, 0};
  settings.drive_train.inertia.setConstant(1e-3);
  settings.drive_train.stiffness.setConstant(200);
  LinkedSerialPlant plant = plant_with(settings, home_tip());
  constexpr double kAmperes = 1e-3, kYawTorque = -9.0 * 0.0234;
  plant.set_currents({kAmperes, 0, 0});
  const double per_inertia = 1 / 1e-3 + 1 / (1e-3 + 0.1 * 0.138 * 0.138);
  const double w = std::sqrt(200 * per_inertia), still = kYawTorque * kAmperes / 1e-3 / (w * w);
  for (int k = 1; k <= 100; ++k) {
    plant.step(home_tip(), kMillisecond);
    const double turned = plant.q()[0] - geometry().inverse(plant.p_BT()).value()[0];
    ASSERT_NEAR(turned, still * (1 - std::cos(w * 1e-3 * k)), 2e-3 * std::abs(still));
  }
}

TEST(LinkedTip, RefusesImpossibleLinks) {
  const auto made_with = [](const std::function<void(LinkSettings&)>& change) {
    SimulatedArmSettings settings = linked_arm(desk_links(geometry()));
    change(settings.links);
    return LinkedSerialPlant::make(support::vintage_model(), settings, home_tip(), home_tip());
  };
  using support::refuses;
  EXPECT_TRUE(made_with([](auto&) {}).ok());
  EXPECT_TRUE(refuses(made_with([](auto& l) { l.moment_b = NAN; }), "finite"));
  EXPECT_TRUE(refuses(made_with([](auto& l) { l.inertia[1] = -1e-4; }), "must not be negative"));
  EXPECT_TRUE(refuses(made_with([](auto& l) { l.coupling = 1; }), "square of coupling"));
  EXPECT_TRUE(refuses(made_with([](auto& l) { l.yaw_b = -0.01; }), "negative in some pose"));
  EXPECT_TRUE(refuses(made_with([](auto& l) {
                        l.inertia = {0, 1e-3, 1e-3};
                        l.yaw_b = l.yaw_c = 5e-4, l.coupling = -8e-4;
                      }),
                      "negative in some pose"));
  // Negative only on an edge: neither upright nor level.
  for (const bool b : {true, false}) {
    EXPECT_TRUE(refuses(made_with([b](auto& l) {
                          l.inertia = {0, 1e-2, 1e-2};
                          l.yaw_b = b ? 1e-4 : 1e-3, l.yaw_c = b ? 1e-3 : 1e-4;
                          l.coupling = 3.5e-4;
                        }),
                        "negative in some pose"));
  }
}

}  // namespace
}  // namespace thimble::device_sim
