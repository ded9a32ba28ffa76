#include "hil/hil_suite.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <functional>
#include <map>
#include <string>

#include "hil/edge_of_wall.h"

namespace thimble::app {
namespace {

/// What is tried: the file that the user has, and the arm that stands on the desk.
struct Bench {
  scene::ArmFile file, arm;
  HilOptions options{};
  bool told = true;

  explicit Bench(const char* name)
      : file(scene::load_arm(name).value()), arm(scene::load_arm(name).value()) {
    options.soak_minutes = 0.2;
  }

  std::map<std::string, HilResult> results() {
    const std::atomic<bool> never{false};
    std::map<std::string, HilResult> found;
    const HilRig rig{.file = file,
                     .open = [this](TipHold hold) { return open_simulated(arm, 200, hold); },
                     .stop = never,
                     .prompt = [](const std::string&) { return true; },
                     .told = told};
    for (HilResult& result : run_hil_suite(rig, options, [](const HilResult&) {})) {
      found[result.name] = std::move(result);
    }
    return found;
  }
};

/// The names of the checks that failed, in order of the alphabet.
std::string failed(const std::map<std::string, HilResult>& results) {
  std::string names;
  for (const auto& [name, result] : results) {
    if (result.outcome == HilOutcome::kFailed) names += (names.empty() ? "" : " ") + name;
  }
  return names;
}

double figure(const HilResult& result, const std::string& name) {
  const auto found = std::find_if(result.figures.begin(), result.figures.end(),
                                  [&](const Figure& one) { return one.name == name; });
  return found == result.figures.end() ? -1 : found->value;
}

TEST(Hil, PassesAnArmThatIsAsItsFileSays) {
  for (const char* name : {"vintage_phantom", "woodenhaptics_teensy", "polhem"}) {
    SCOPED_TRACE(name);
    Bench bench(name);
    bench.options.spring = 200;
    const auto results = bench.results();
    EXPECT_EQ(results.size(), 9u);
    EXPECT_EQ(failed(results), "");
    for (const char* check : {"reports", "feel_check", "constants", "friction_at_rest",
                              "stiffest_wall", "force_accuracy", "soak"}) {
      EXPECT_EQ(results.at(check).outcome, HilOutcome::kPassed)
          << check << ": " << results.at(check).text;
    }
    const HilResult& wall = results.at("stiffest_wall");
    EXPECT_EQ(figure(wall, "wall_over_twin"), 1);
    EXPECT_LE(figure(wall, "force_most"), kHilForceMax);
    EXPECT_NEAR(figure(results.at("force_accuracy"), "force_ratio"), 1, 0.02);
  }
}

/// What fails when the arm on the desk is another than its file's.
std::string failed_with(const std::function<void(scene::ArmFile&)>& change, double spring = 0) {
  Bench bench("vintage_phantom");
  bench.options.spring = spring;
  change(bench.arm);
  return failed(bench.results());
}

TEST(Hil, NamesWhatIsWrongWithAnArm) {
  EXPECT_EQ(failed_with([](scene::ArmFile& arm) { arm.simulated.wire.delay_out_ns += 1'500'000; }),
            "constants stiffest_wall");
  EXPECT_EQ(failed_with([](scene::ArmFile& arm) { arm.simulated.wire.loss = 0.1; }),
            "constants reports");
  EXPECT_EQ(
      failed_with([](scene::ArmFile& arm) { arm.simulated.firmware.watchdog_ns = 400'000'000; }),
      "feel_check");
  // A motor that pulls four fifths: without a scale all but the others' share is seen by its
  // spring.
  EXPECT_EQ(
      failed_with(
          [](scene::ArmFile& arm) { arm.simulated.firmware.wiring.motor_gain.setConstant(0.8); },
          200),
      "constants force_accuracy stiffest_wall");
  EXPECT_EQ(failed_with([](scene::ArmFile& arm) {
              arm.simulated.weight_B = arm.R_WB.transpose() * Eigen::Vector3d(0, 0, -3);
            }),
            "constants");
}

/// The edge of a free simulated arm whose wire takes `delay_ms`; `ratio`: to that of the law.
EdgeOfWall edge_with(double delay_ms, const EdgeSearch& search, double& ratio,
                     double coulomb = 0.04) {
  scene::ArmFile arm = scene::load_arm("vintage_phantom").value();
  arm.simulated.plant.coulomb = coulomb;
  arm.simulated.wire = {.delay_in_ns = 0,
                        .delay_out_ns = static_cast<std::int64_t>(delay_ms * 1e6)};
  const auto bench = open_simulated(arm, 0, TipHold::kFree);
  const std::atomic<bool> never{false};
  auto found = find_edge_of_wall(*bench.value(), arm, search, never);
  EXPECT_TRUE(found.ok()) << found.error().message;
  if (!found) return {};
  ratio = found->stiffness / edge_by_law(arm, search.speed);
  std::printf("%.1f ms: %.0f N/m, %.2f of the law's; gave %.3g mJ\n", delay_ms, found->stiffness,
              ratio, 1e3 * found->given_most);
  return *found;
}

TEST(Hil, FindsTheWallThatTheLawSays) {
  const EdgeSearch search{.factor = 1.02};
  for (const double delay_ms : {0.0, 1.0, 2.0, 4.0}) {
    double ratio = 0;
    const EdgeOfWall edge = edge_with(delay_ms, search, ratio);
    EXPECT_TRUE(edge.grew);
    // The law is that of an oscillation of constant speed. A late wall is soft, its oscillation
    // slow, and dry friction takes a third of the kick's speed before the wall turns it round.
    EXPECT_GT(ratio, 0.9);
    EXPECT_LT(ratio, delay_ms <= 1 ? 1.1 : 1.5);
    EXPECT_LE(edge.force_most, kHilForceMax);
  }
}

TEST(Hil, SeesASwingGrowThatGivesLittleEnergy) {
  double ratio = 0;
  const EdgeOfWall edge = edge_with(1, {.first = 30, .factor = 1.05}, ratio, 0.004);
  EXPECT_TRUE(edge.grew);
  EXPECT_NEAR(ratio, 1, 0.25);
}

TEST(Hil, TakesAWallOffThatGivesEnergy) {
  // Ten times the kick's energy, and what one tick adds to it.
  const double kick = 0.5 * 0.075 * 0.03 * 0.03;  // J
  double ratio = 0;
  const EdgeOfWall edge = edge_with(4, {.factor = 8}, ratio);
  EXPECT_TRUE(edge.grew);
  EXPECT_GT(edge.given_most, kick);
  EXPECT_LT(edge.given_most, 20 * kick);
}

TEST(Hil, MeasuresTheWatchdogOfAFreeArm) {
  for (const std::int64_t time_ms : {60, 100, 120, 160, 300}) {
    SCOPED_TRACE(time_ms);
    Bench bench("vintage_phantom");
    bench.told = false;
    bench.options.checked = true;
    bench.arm.simulated.firmware.watchdog_ns = time_ms * 1'000'000;
    const HilResult watchdog = bench.results().at("watchdog");
    if (time_ms <= 120) {
      EXPECT_EQ(watchdog.outcome, HilOutcome::kPassed) << watchdog.text;
      EXPECT_NEAR(figure(watchdog, "watchdog_time"), static_cast<double>(time_ms), 5);
    } else if (time_ms == 300) {
      // The tip has gone 15 mm long before, and is let go.
      EXPECT_EQ(watchdog.outcome, HilOutcome::kFailed) << watchdog.text;
      EXPECT_EQ(figure(watchdog, "watchdog_seen"), 0);
    }
  }
}

TEST(Hil, PushesNothingBeforeTheFeelCheckIsPassed) {
  Bench bench("vintage_phantom");
  bench.told = false;
  bench.options.checked = false;
  const auto results = bench.results();
  EXPECT_EQ(failed(results), "feel_check");
  for (const char* check :
       {"constants", "watchdog", "friction_at_rest", "stiffest_wall", "force_accuracy", "soak"}) {
    EXPECT_EQ(results.at(check).outcome, HilOutcome::kSkipped) << check;
  }
}

TEST(Hil, PushesNoFurtherAgainstAMotorThatIsTurnedRound) {
  for (int motor = 0; motor < 3; ++motor) {
    Bench bench("vintage_phantom");
    bench.told = false;
    bench.options.checked = true;  // the wire was turned round since
    bench.arm.simulated.firmware.wiring.motor_gain[motor] = -1;
    const auto results = bench.results();
    EXPECT_EQ(failed(results), "constants") << motor;
    EXPECT_TRUE(results.at("constants").unsafe);
    EXPECT_EQ(results.at("stiffest_wall").outcome, HilOutcome::kSkipped);
    EXPECT_EQ(results.at("soak").outcome, HilOutcome::kSkipped);
  }
}

}  // namespace
}  // namespace thimble::app
