// Gravity compensation by the motors, as an arm file specifies it.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <type_traits>

#include "gravity_terms.h"
#include "support/refuses.h"
#include "support/scratch.h"
#include "thimble/scene/arm_file.h"
#include "thimble/session/run_figures.h"
#include "thimble/session/session.h"

namespace thimble {
namespace {

constexpr double kWeight = 0.06;  // N, above the dry friction of 0.04 N
// First moments of links, kg m, that pull on the tip with more than friction holds.
constexpr double kMomentB = 0.0009, kMomentC = 0.0012;

void replace(std::string& text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  ASSERT_NE(at, std::string::npos) << from;
  text.replace(at, from.size(), to);
}

/// Returns a folder with a scene without contact. Its arm has the weight kWeight, no hand, and
/// motors that carry `carried` (N). With `links` the links have the weight, and `carried` is the
/// carried share of their moments.
std::filesystem::path files(double carried, bool links = false,
                            const std::string& at = "[0, 0, 0]") {
  const auto folder = support::scratch_folder() / "carried_weight";
  std::filesystem::create_directories(folder);
  std::ostringstream arm;
  arm << std::ifstream(std::filesystem::path(THIMBLE_SOURCE_DIR) / "app/arms/vintage_phantom.yaml")
             .rdbuf();
  std::string text = arm.str();
  replace(text, "energy: passivity", "energy: none");
  if (!links) replace(text, "coulomb: 0.04", "weight: 0.06\n    coulomb: 0.04");
  replace(text, "mass: 0.025 ", "mass: 0 ");
  replace(text, "stiffness: 300 ", "stiffness: 0 ");
  replace(text, "damping: 3 ", "damping: 0 ");
  const std::string named = links ? "moment_b: " + std::to_string(carried * kMomentB) +
                                        ", moment_c: " + std::to_string(carried * kMomentC)
                                  : "weight: " + std::to_string(carried);
  if (carried > 0) {
    replace(text, "simulation:\n", "gravity_compensation: {" + named + "}\nsimulation:\n");
  }
  if (links) {
    replace(text, "simulation:\n",
            "simulation:\n  links: {inertia: [1e-4, 1e-4, 1e-4], moment_b: " +
                std::to_string(kMomentB) + ", moment_c: " + std::to_string(kMomentC) + "}\n");
  }
  std::ofstream(folder / "arm.yaml") << text;
  std::ofstream(folder / "scene.yaml")
      << "name: carried\narm: arm.yaml\nrate: 1000\nduration: 0.6\n"
         "objects:\n  - {name: ball, sphere: {radius: 0.01}, position: [0, 0, 0.09], stiffness: "
         "500}\nhand:\n  path:\n    - {t: 0, at: "
      << at << "}\n";
  return folder;
}

/// Motion of the tip and its forces in a run.
class Seen final : public session::TickObserver {
 public:
  void take(const driver::TickRecord& record) noexcept override {
    lowest = std::min(lowest, record.p_WT[2]);
    const auto& v = record.v_WT;
    fastest = std::max(fastest, std::hypot(v[0], v[1], v[2]));
    highest = std::max(highest, record.p_WT[2]);
    const auto& f = record.f_sent_W;
    most = std::max(most, std::hypot(f[0], f[1], f[2]));
    wanted = std::max(wanted, record.f_wanted_W[2]);
    if (!first) first = record;
    last = record;
  }
  /// Returns the distance from the first to the last position of the tip, m.
  double way() const {
    return std::hypot(last.p_WT[0] - first->p_WT[0], last.p_WT[1] - first->p_WT[1],
                      last.p_WT[2] - first->p_WT[2]);
  }

  double lowest = 1, highest = -1;  // m
  double fastest = 0;               // m/s
  double most = 0, wanted = 0;      // N
  std::optional<driver::TickRecord> first;
  driver::TickRecord last;
};

struct WholeRun {
  Seen seen;
  session::RunFigures figures;
};

/// Runs the scene of a folder, with the force law `law` instead of the scene's if one is given.
template <class Law = std::nullptr_t>
WholeRun run_in(const std::filesystem::path& folder, Law law = {}) {
  WholeRun result;
  auto opened = session::Session::open(folder / "scene.yaml", {});
  if (!opened) {
    ADD_FAILURE() << opened.error().message;
    return result;
  }
  if constexpr (!std::is_null_pointer_v<Law>) {
    EXPECT_TRUE((*opened)->set_law(driver::ForceLaw(law)));
  }
  EXPECT_TRUE((*opened)->add_observer(result.seen));
  const std::atomic<bool> stop{false};
  (*opened)->run(stop);
  result.figures = (*opened)->figures();
  return result;
}

template <class Law = std::nullptr_t>
WholeRun run(double carried, Law law = {}) {
  return run_in(files(carried), law);
}

TEST(CarriedWeight, KeepsAHeavyTipInPlace) {
  const WholeRun falls = run(0), floats = run(kWeight);
  EXPECT_LT(falls.seen.lowest, -0.03);
  // It sinks until the soft start passes the part of the weight that friction does not hold.
  EXPECT_GT(floats.seen.lowest, -0.002);
  EXPECT_LT(floats.seen.highest, 1e-4);
  EXPECT_NEAR(floats.seen.last.v_WT[2], 0, 1e-4);
  EXPECT_NEAR(floats.seen.last.f_sent_W[2], kWeight, 0.01);
  EXPECT_EQ(falls.seen.most, 0);
  EXPECT_EQ(falls.figures.carried_weight, 0);
  EXPECT_DOUBLE_EQ(floats.figures.carried_weight, kWeight);
  EXPECT_NE(session::summary(floats.figures).find("carried 0.06 N of the arm"), std::string::npos);
  EXPECT_EQ(session::summary(falls.figures).find("of the arm"), std::string::npos);
}

TEST(CarriedWeight, KeepsHeavyLinksInPlaceInEachPose) {
  double least = 1, most = 0;  // N
  for (const char* at : {"[0, 0, 0]", "[0.04, 0.03, 0.05]", "[-0.03, -0.05, 0.04]"}) {
    const WholeRun falls = run_in(files(0, true, at)), floats = run_in(files(1, true, at));
    EXPECT_GT(falls.seen.way(), 0.02) << at;
    // It sinks until the soft start passes the part of the weight that friction does not hold.
    EXPECT_LT(floats.seen.way(), 0.1 * falls.seen.way()) << at;
    const auto& last = floats.seen.last;
    EXPECT_EQ(
        Eigen::Vector3d(last.v_WT[0], last.v_WT[1], last.v_WT[2]).cwiseAbs().maxCoeff() < 1e-3,
        true)
        << at;
    const double force = std::hypot(last.f_sent_W[0], last.f_sent_W[1], last.f_sent_W[2]);
    least = std::min(least, force), most = std::max(most, force);
    EXPECT_TRUE(floats.figures.carried_by_pose);
    EXPECT_LE(force, floats.figures.carried_weight + 0.01);
    EXPECT_NE(session::summary(floats.figures).find("carried up to"), std::string::npos);
  }
  EXPECT_GT(most, 1.1 * least);
}

TEST(CarriedWeight, LinksTakeAtMostAThirdOfTheGateForce) {
  const auto arm = scene::load_arm(files(1, true) / "arm.yaml");
  ASSERT_TRUE(arm.ok()) << arm.error().message;
  scene::LinkGravity links = scene::link_gravity(*arm);
  links.moments.length_b *= 1000, links.moments.length_c *= 1000;
  const Eigen::Vector3d q(0.2, 1.4, 0.1);
  EXPECT_NEAR(links.carried(q).norm(), arm->limits.force_max / 3, 1e-12);
  EXPECT_EQ(links.carried({NAN, 0, 0}), Eigen::Vector3d(0, 0, 0));
  EXPECT_TRUE(support::refuses(scene::load_arm(files(30, true) / "arm.yaml"),
                               "in the middle of the workspace"));
}

TEST(CarriedWeight, CountsTowardsTheForceLimit) {
  const auto up = [](const driver::DeviceState&) noexcept {
    return driver::ForceCommand{.f_T_W = {0, 0, 5}, .touch = {}};
  };
  const WholeRun pushed = run(kWeight, up);
  EXPECT_DOUBLE_EQ(pushed.seen.wanted, 5 + kWeight);
  EXPECT_LE(pushed.seen.most, pushed.figures.force_limit + 0.01);  // currents are rounded
  EXPECT_GT(pushed.figures.gate.limited, 0U);
}

TEST(CarriedWeight, WrongValueDoesNotMakeAFreeTipRunAway) {
  // Twenty times the arm's weight; without the check the tip would reach 3 m/s over 0.3 m.
  const WholeRun wrong = run(20 * kWeight);
  EXPECT_LT(wrong.seen.highest, 0.11);
  EXPECT_LT(wrong.seen.fastest, 1.0);
}

TEST(CarriedWeight, IsGoneWithEveryOtherForceAfterAFault) {
  const auto broken = [](const driver::DeviceState& state) noexcept {
    return driver::ForceCommand{.f_T_W = {0, 0, state.tick < 400 ? 0 : NAN}, .touch = {}};
  };
  const WholeRun run_broken = run(kWeight, broken);
  EXPECT_EQ(run_broken.figures.fault, driver::Fault::kForceNotFinite);
  EXPECT_EQ(run_broken.seen.last.f_sent_W[2], 0);
}

TEST(CarriedWeight, IsAtMostAThirdOfTheGateForce) {
  EXPECT_TRUE(support::refuses(scene::load_arm(files(2) / "arm.yaml"), "a third of the gate's"));
  EXPECT_TRUE(scene::load_arm(files(1.6) / "arm.yaml").ok());
  EXPECT_EQ(scene::load_arm("polhem").value().carried_weight, 0);
}

}  // namespace
}  // namespace thimble
