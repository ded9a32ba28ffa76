// Detected links: their keys in the new file, and a twin whose mass is correct where that of a file
// without links is not.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <string>

#include "bringup/identify/constants_table.h"
#include "bringup/identify/link_inertia/link_constants.h"
#include "bringup/identify/link_inertia/link_equations.h"
#include "bringup/identify/output/identified_file.h"
#include "bringup/identify/record_motion.h"
#include "bringup/identify/unidentified_parameters.h"
#include "plant/link_mechanics.h"
#include "read_scene.h"
#include "support/identify/identified_arm.h"
#include "support/linked_arm.h"
#include "support/long_form.h"
#include "support/random.h"
#include "support/refuses.h"
#include "yaml/yaml_reader.h"

namespace thimble::bringup {
namespace {

using support::HiddenArm;
using support::identified;
using support::linked_arm;
using support::long_form;
using support::tip_masses;

const IdentifiedMark kLinksMark{.date = "2026-11-26", .arm = "A 1"};

std::string phantom_text() {
  std::ostringstream content;
  content << std::ifstream(THIMBLE_SOURCE_DIR "/app/arms/vintage_phantom.yaml").rdbuf();
  return content.str();
}

scene::ArmFile file_of(const std::string& text) {
  auto yaml = scene::YamlFile::parse(text, "arm file");
  return scene::read_arm(*yaml).value();
}

/// Returns the exact fit of an arm, in the form in which motion shows it.
LinkFit exact_fit(const HiddenArm& arm) {
  const auto& links = arm.file.simulated.links;
  LinkFit fit;
  fit.arm = std::get<driver::SerialArm>(arm.file.model.geometry);
  const double lb = fit.arm.length_b, lc = fit.arm.length_c, mass = links.coupling / (lb * lc);
  fit.theta[LinkFit::kMass] = arm.file.simulated.plant.mass + mass;
  fit.theta.segment<3>(LinkFit::kInertia) =
      links.inertia - mass * Eigen::Vector3d(0, lb * lb, lc * lc);
  fit.theta[LinkFit::kYawB] = links.yaw_b - mass * lb * lb;
  fit.theta[LinkFit::kYawC] = links.yaw_c - mass * lc * lc;
  fit.theta[LinkFit::kMomentB] = links.moment_b - links.moment_c * lb / lc;
  fit.theta.segment<3>(LinkFit::kWeight) =
      arm.file.simulated.weight_B + links.moment_c / lc * links.gravity_B;
  fit.covariance.diagonal() = (1e-4 * fit.theta).cwiseAbs2();
  fit.links = true;
  return fit;
}

TEST(LinkConstants, ReproduceTheApparentMasses) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    const HiddenArm arm = linked_arm(seed);
    const LinkFit fit = exact_fit(arm);
    const Eigen::Vector3d down_B = arm.file.R_WB.transpose() * Eigen::Vector3d(0, 0, -1);
    const auto found = tip_and_links(fit, down_B);
    ASSERT_TRUE(found.ok()) << found.error().message;
    HiddenArm twin = arm;
    auto& links = twin.file.simulated.links;
    links = settings_of(found->links);
    links.gravity_B = arm.file.simulated.links.gravity_B;
    twin.file.simulated.plant.mass = found->mass.value;
    EXPECT_TRUE(device_sim::check_links(links).ok());
    EXPECT_GE(links.coupling, 0);
    EXPECT_GE(found->mass.value, arm.file.simulated.plant.mass * (1 - 1e-9));
    support::Random random(seed);
    for (int k = 0; k < 5; ++k) {
      const Eigen::Vector3d q(random.uniform(-0.5, 0.5), random.uniform(0.7, 1.7),
                              random.uniform(-0.4, 0.6));
      const Eigen::Matrix3d truth = tip_masses(arm.file, q);
      EXPECT_LT((tip_masses(twin.file, q) - truth).norm(), 1e-6 * truth.norm());
      for (std::size_t i = 0; i < 3; ++i) {
        const auto axis = static_cast<Eigen::Index>(i);
        EXPECT_NEAR(fit.apparent_mass(q)[i].value, truth(axis, axis), 1e-9);
      }
      // Force of gravity at the tip.
      const Eigen::Matrix3d G = fit.arm.jacobian(q).inverse();
      const auto pull = [&](const device_sim::LinkSettings& of, const Eigen::Vector3d& tip) {
        return Eigen::Vector3d(
            tip + G.transpose() *
                      device_sim::LinkMechanics(fit.arm, of).at(q, Eigen::Vector3d::Zero()).torque);
      };
      EXPECT_LT((pull(links, found->weight.value * down_B) -
                 pull(arm.file.simulated.links, arm.file.simulated.weight_B))
                    .norm(),
                1e-9);
    }
    // With slightly less coupling (if there is some) no physical links exist.
    if (links.coupling == 0) continue;
    const double less = 1e-3 * found->mass.value, lb = fit.arm.length_b, lc = fit.arm.length_c;
    links.coupling -= less * lb * lc;
    links.inertia -= less * Eigen::Vector3d(0, lb * lb, lc * lc);
    links.yaw_b -= less * lb * lb;
    links.yaw_c -= less * lc * lc;
    EXPECT_FALSE(links.coupling > 0 && device_sim::check_links(links).ok());
  }
}

TEST(LinkConstants, ImpossibleLinksAreRefused) {
  LinkFit fit = exact_fit(linked_arm(1));
  fit.theta[LinkFit::kInertia] = -1e-3;
  EXPECT_TRUE(support::refuses(tip_and_links(fit, {0, 0, -1}), "negative in some pose"));
  // Unless it does not differ significantly from zero.
  fit.theta[LinkFit::kInertia] = -1e-6;
  fit.covariance(LinkFit::kInertia, LinkFit::kInertia) = 1e-10;
  const auto found = tip_and_links(fit, {0, 0, -1});
  ASSERT_TRUE(found.ok()) << found.error().message;
  EXPECT_EQ(found->links.inertia[0].value, 0);
}

/// Returns the distance (m) that a tip moves in 80 ms under a push along an axis of the world at a
/// place. The arm is simulated with the motors of its file.
double pushed_way(scene::ArmFile file, const Eigen::Vector3d& p_W, int axis) {
  file.simulated.hand = {};
  file.simulated.firmware.wiring.motor_gain.setOnes();
  auto bench = BenchArm::open(file, {}, {}, {{0, p_W}}, 2);
  EXPECT_TRUE(bench.ok());
  const std::atomic<bool> never{false};
  EXPECT_TRUE((*bench)->device().activate().ok());
  const auto rest = [](const driver::DeviceState&) { return Eigen::Vector3d(0, 0, 0); };
  EXPECT_TRUE((*bench)->run(file.limits.soft_start + 0.1, rest, never));
  const double from = (*bench)->device().state().p_WT[axis];
  EXPECT_TRUE((*bench)->run(
      0.08,
      [axis](const driver::DeviceState&) {
        return Eigen::Vector3d(1.5 * Eigen::Vector3d::Unit(axis));
      },
      never));
  return (*bench)->device().state().p_WT[axis] - from;
}

TEST(IdentifiedLinks, ImproveTheTwinAtTheWorkspaceEdge) {
  const std::uint64_t arms = long_form() ? 12 : 1;
  for (std::uint64_t seed = 7201; seed < 7201 + arms; ++seed) {
    SCOPED_TRACE(seed);
    const HiddenArm arm = linked_arm(seed);
    const auto found = identified(arm, {.seconds = long_form() ? 30.0 : 10.0,
                                        .known_mass = support::kKnownMass,
                                        .places = 7,
                                        .place_seconds = long_form() ? 5.0 : 2.0,
                                        .seed = seed});
    ASSERT_TRUE(found.ok()) << found.error().message;
    for (const std::string& sentence : found->against) ADD_FAILURE() << sentence;
    ASSERT_TRUE(found->constants.links);
    const ArmConstants& constants = found->constants;
    EXPECT_TRUE(constants.absolute);
    EXPECT_NEAR(constants.coulomb.value / arm.file.simulated.plant.coulomb, 1, 0.02);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(constants.gain[i].value / arm.gain[i], 1, 0.01);
    }
    EXPECT_NE(constants_table(*found, arm.file).find("Over the part of the workspace"),
              std::string::npos);
    const auto text = identified_text(phantom_text(), constants, kLinksMark);
    ASSERT_TRUE(text.ok()) << text.error().message;
    const scene::ArmFile with = file_of(*text);
    scene::ArmFile without = with;
    without.simulated.links = {};
    // Mass identified from a motion in one place, with the true scale.
    const auto alone = identified(arm, {.seconds = 10, .seed = seed});
    ASSERT_TRUE(alone.ok()) << alone.error().message;
    without.simulated.plant.mass =
        alone->constants.mass.value * std::cbrt(arm.gain[0] * arm.gain[1] * arm.gain[2]);
    const Eigen::Vector3d far(-0.085, 0.07, 0);
    const auto& build = std::get<driver::SerialArm>(arm.file.model.geometry);
    const auto q = build.inverse(arm.file.R_WB.transpose() * (far - arm.file.p_WB));
    ASSERT_TRUE(q && moves_easily(arm.file, far));
    double apart = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double truth = tip_masses(arm.file, *q)(axis, axis);
      const Estimate mass = found->over.fit->apparent_mass(*q)[static_cast<std::size_t>(axis)];
      EXPECT_NEAR(tip_masses(with, *q)(axis, axis), truth, 0.03 * truth);
      EXPECT_NEAR(mass.value, truth, 0.03 * truth);
      const double way = pushed_way(arm.file, far, axis);
      ASSERT_GT(way, 1e-3);
      EXPECT_NEAR(pushed_way(with, far, axis), way, 0.03 * way);
      apart = std::max(apart, std::abs(pushed_way(without, far, axis) / way - 1));
      std::printf(
          "%d axis %d: mass %.4g of %.4g +- %.2g kg, way %.4g mm, twin %.4g, without %.4g\n",
          static_cast<int>(seed), axis, mass.value, truth, mass.plus_minus, 1e3 * way,
          1e3 * pushed_way(with, far, axis), 1e3 * pushed_way(without, far, axis));
    }
    EXPECT_GT(apart, 0.2) << "a twin without links";
  }
}

ArmConstants constants_with_links() {
  ArmConstants found;
  found.mass = {0.05, 0.001};
  found.coulomb = {0.04, 0.001};
  for (Estimate& gain : found.gain) gain = {1, 0.01};
  found.delay = {0.001, 1e-5};
  found.links_sought = true;
  found.links = LinkConstants{.inertia = {Estimate{1e-4, 1e-6}, {2e-4, 2e-6}, {3e-4, 3e-6}},
                              .yaw_b = {4e-4, 1e-6},
                              .yaw_c = {5e-4, 1e-6},
                              .coupling = {1e-4, 1e-6},
                              .moment_b = {-2e-4, 1e-5},
                              .moment_c = {-1e-4, 1e-5}};
  return found;
}

TEST(IdentifiedLinks, AreWrittenWithMarks) {
  ArmConstants found = constants_with_links();
  const auto added = identified_text(phantom_text(), found, kLinksMark);
  ASSERT_TRUE(added.ok()) << added.error().message;
  EXPECT_NE(
      added->find("  links:\n    inertia: [0.0001, 0.0002, 0.0003]  # kg m^2 about A, B and C "
                  "[I 2026-11-26, A 1, +- 1e-06, 2e-06, 3e-06]\n    yaw_b: 0.0004  # kg m^2 "
                  "[I 2026-11-26, A 1, +- 1e-06]\n"),
      std::string::npos)
      << *added;
  const auto links_in = [](const std::string& text) { return file_of(text).simulated.links; };
  EXPECT_EQ(links_in(*added).inertia, Eigen::Vector3d(1e-4, 2e-4, 3e-4));
  EXPECT_EQ(links_in(*added).yaw_c, 5e-4);
  EXPECT_EQ(links_in(*added).coupling, 1e-4);
  EXPECT_EQ(links_in(*added).moment_b, -2e-4);
  EXPECT_EQ(links_in(*added).moment_c, -1e-4);
  // A file that names links gets the measured ones, whatever its form.
  found.links->inertia[0].value = 7e-4;
  const auto again = identified_text(*added, found, kLinksMark);
  ASSERT_TRUE(again.ok()) << again.error().message;
  EXPECT_EQ(links_in(*again).inertia, Eigen::Vector3d(7e-4, 2e-4, 3e-4));
  std::string flow = phantom_text();
  flow.insert(flow.find("  tip:\n"), "  links: {inertia: [1, 1, 1], moment_b: 0.5}\n");
  const auto kept = identified_text(flow, found, kLinksMark);
  ASSERT_TRUE(kept.ok()) << kept.error().message;
  EXPECT_EQ(links_in(*kept).inertia, Eigen::Vector3d(7e-4, 2e-4, 3e-4));
  EXPECT_EQ(links_in(*kept).moment_b, -2e-4);
  EXPECT_NE(kept->find("yaw_b: kg m^2 [I 2026-11-26, A 1, +- 1e-06]"), std::string::npos);
  std::string block = phantom_text();
  block.insert(block.find("  tip:\n"), "  links:\n    moment_b: 0.5\n");
  const auto more = identified_text(block, found, kLinksMark);
  ASSERT_TRUE(more.ok()) << more.error().message;
  EXPECT_EQ(links_in(*more).yaw_b, 4e-4);
  EXPECT_EQ(links_in(*more).moment_b, -2e-4);
}

TEST(IdentifiedLinks, FileWithLinksNeedsAMeasurementOfThem) {
  ArmConstants found = constants_with_links();
  std::string named = phantom_text();
  named.insert(named.find("  tip:\n"), "  links:\n    inertia: [0.0003, 0.0002, 0.0001]\n");
  // Searched for, and none detected.
  found.links.reset();
  const auto none = identified_text(named, found, kLinksMark);
  ASSERT_TRUE(none.ok()) << none.error().message;
  EXPECT_FALSE(file_of(*none).simulated.links.named());
  // Then no section is added to a file without one.
  EXPECT_EQ(identified_text(phantom_text(), found, kLinksMark).value().find("links:"),
            std::string::npos);
  found.links_sought = false;
  EXPECT_TRUE(support::refuses(identified_text(named, found, kLinksMark), "--places"));
}

TEST(IdentifiedLinks, AreNotReportedForAnArmWithoutLinks) {
  for (std::uint64_t seed = 7300; seed < (long_form() ? 7310u : 7301u); ++seed) {
    const HiddenArm arm = support::hidden_arm(seed);
    const auto found =
        identified(arm, {.seconds = 10, .places = 5, .place_seconds = 2, .seed = seed});
    ASSERT_TRUE(found.ok()) << found.error().message;
    EXPECT_TRUE(found->against.empty()) << found->against.front();
    EXPECT_TRUE(found->constants.links_sought);
    EXPECT_FALSE(found->constants.links);
    const auto open = unidentified_parameters(*found);
    EXPECT_TRUE(std::any_of(open.begin(), open.end(), [](const std::string& one) {
      return one.find("Links: none detected; over 6 places") == 0;
    }));
    const double mean = std::cbrt(arm.gain[0] * arm.gain[1] * arm.gain[2]);
    const double mass = arm.file.simulated.plant.mass / mean;
    EXPECT_NEAR(found->constants.mass.value, mass, 0.01 * mass);
  }
}

}  // namespace
}  // namespace thimble::bringup
