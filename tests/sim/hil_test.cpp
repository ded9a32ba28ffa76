#include "hil/hil_suite.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "hil/cable_pull.h"
#include "hil/constants_check.h"
#include "hil/edge_of_wall.h"
#include "hil/wall_check.h"
#include "support/figure_value.h"
#include "support/long_form.h"
#include "support/seed.h"

namespace thimble::hil {
namespace {

using support::figure_value;

/// The user's file, and the arm under test.
struct Bench {
  scene::ArmFile file, arm;
  HilOptions options{};
  bool attended = true;

  explicit Bench(const char* name)
      : file(scene::load_arm(name).value()), arm(scene::load_arm(name).value()) {
    options.soak_minutes = 0.2;
  }

  std::map<std::string, HilResult> results() {
    const std::atomic<bool> never{false};
    std::map<std::string, HilResult> found;
    HilOptions tied = options;
    tied.spring = 200;
    const HilRig rig{.file = file,
                     .open = [&](TipHold hold) { return open_simulated(arm, tied, hold); },
                     .stop = never,
                     .prompt = [](const std::string&) { return true; },
                     .attended = attended};
    for (HilResult& result : run_hil_suite(rig, options, {})) {
      found[result.name] = std::move(result);
    }
    return found;
  }
};

/// Returns the names of the failed checks in alphabetical order.
std::string failed(const std::map<std::string, HilResult>& results) {
  std::string names;
  for (const auto& [name, result] : results) {
    if (result.outcome == HilOutcome::kFailed) names += (names.empty() ? "" : " ") + name;
  }
  return names;
}

TEST(Hil, PassesAnArmThatMatchesItsFile) {
  for (const char* name : {"vintage_phantom", "woodenhaptics_teensy", "polhem"}) {
    SCOPED_TRACE(name);
    Bench bench(name);
    bench.options.spring = 200;
    const auto results = bench.results();
    EXPECT_EQ(results.size(), 11u);
    EXPECT_EQ(failed(results), "");
    for (const char* check : {"reports", "feel_check", "constants", "friction_at_rest",
                              "stiffest_wall", "force_accuracy", "soak"}) {
      EXPECT_EQ(results.at(check).outcome, HilOutcome::kPassed)
          << check << ": " << results.at(check).text;
    }
    const HilResult& wall = results.at("stiffest_wall");
    EXPECT_EQ(figure_value(wall.figures, "wall_over_twin"), 1);
    EXPECT_LE(figure_value(wall.figures, "max_force"), kHilForceMax);
    EXPECT_NEAR(figure_value(results.at("force_accuracy").figures, "force_ratio"), 1, 0.02);
  }
}

/// Returns the stiffness K of the wall at which an oscillation neither grows nor decays, N/m: b + 4
/// c / (pi v) = K L, with the speed v after the first turn of the tip [PHYSICS 1.4]. Until then,
/// dry friction c and the spring take the energy of the kick: m v_0^2 / 2 = K A^2 / 2 + c A, and v
/// = A sqrt(K / m). `law` is the same with the speed v_0 of the kick, and gives the latency L.
/// Edges of one start differ by a tenth (wall_check.cpp).
double edge_after_first_turn(const scene::ArmFile& file, double law) {
  const auto& [m, b, c] = file.simulated.plant;
  const double v_0 = EdgeSearch().speed;
  const auto braked = [&, b = b, c = c](double v) { return b + 4 * c / (std::numbers::pi * v); };
  const double L = braked(v_0) / law;
  double K = law;
  for (int round = 0; round < 50; ++round) {
    const double A = (std::sqrt(c * c + K * m * v_0 * v_0) - c) / K;
    K = braked(A * std::sqrt(K / m)) / L;
  }
  return K;
}

TEST(Hil, PushesAlongAnAxisOfTheArm) {
  for (const char* name : {"hapkit", "five_bar"}) {
    SCOPED_TRACE(name);
    Bench bench(name);
    const bool on_line = bench.file.motors() == 1;
    const auto results = bench.results();
    EXPECT_EQ(failed(results), "");
    EXPECT_EQ(results.at("friction_at_rest").outcome,
              on_line ? HilOutcome::kSkipped : HilOutcome::kPassed)
        << results.at("friction_at_rest").text;
    const HilResult& wall = results.at("stiffest_wall");
    const double law = figure_value(wall.figures, "stiffest_wall_by_law");
    EXPECT_NEAR(
        figure_value(wall.figures, "stiffest_wall") / edge_after_first_turn(bench.file, law), 1,
        0.1)
        << wall.text;
    EXPECT_EQ(results.at("watchdog").text.find("too close"), std::string::npos);
    const auto& gains = results.at("constants").figures;
    EXPECT_EQ(figure_value(gains, on_line ? "gain_2_difference" : "gain_3_difference"), -1);
  }
}

TEST(Hil, CablePullPushesAlongAnAxisOfTheArm) {
  struct Case {
    const char* arm;
    const char* words;
    Eigen::Vector3d direction_W;
  };
  for (const Case& one :
       {Case{"vintage_phantom", "N to your right.", {0, 1, 0}},
        Case{"five_bar", "N to your right.", {0, 1, 0}}, Case{"hapkit", "N up.", {0, 0, 1}}}) {
    SCOPED_TRACE(one.arm);
    const scene::ArmFile file = scene::load_arm(one.arm).value();
    const std::atomic<bool> never{false};
    std::string prompts;
    Eigen::Vector3d pushed(0, 0, 0);
    const HilRig rig{.file = file,
                     .open =
                         [&](TipHold hold) {
                           auto bench = open_simulated(file, {}, hold);
                           if (bench) {
                             (*bench)->watch([&](const driver::TickRecord& record) {
                               pushed += Eigen::Vector3d(record.f_sent_W[0], record.f_sent_W[1],
                                                         record.f_sent_W[2]);
                             });
                           }
                           return bench;
                         },
                     .stop = never,
                     .prompt =
                         [&](const std::string& text) {
                           prompts += text;
                           return true;
                         },
                     .attended = true};
    const HilResult result = check_cable_pull(rig, true);
    EXPECT_EQ(result.outcome, HilOutcome::kFailed) << result.text;  // no person pulls the cable
    EXPECT_NE(prompts.find(one.words), std::string::npos) << prompts;
    EXPECT_GT(pushed.norm(), 0);
    EXPECT_LT((pushed.normalized() - one.direction_W).norm(), 1e-9);
  }
}

TEST(Hil, AccountsForLinksOfTheFile) {
  const auto name_links = [](scene::ArmFile& file, double more) {
    auto& links = file.simulated.links;
    links.inertia = more * Eigen::Vector3d(4e-4, 5e-4, 3e-4);
    links.yaw_b = more * 5e-4, links.yaw_c = more * 3e-4;
  };
  const std::atomic<bool> never{false};
  for (const double more : {1.0, 1.5}) {
    scene::ArmFile file = scene::load_arm("vintage_phantom").value(), arm = file;
    name_links(file, 1);
    name_links(arm, more);
    const HilRig rig{.file = file,
                     .open = [&](TipHold hold) { return open_simulated(arm, {}, hold); },
                     .stop = never,
                     .prompt = [](const std::string&) { return true; },
                     .attended = true};
    const HilResult result = check_constants(rig, {});
    EXPECT_EQ(result.outcome, more == 1 ? HilOutcome::kPassed : HilOutcome::kFailed) << result.text;
    EXPECT_LT(figure_value(result.figures, "dry_friction_difference"), 1) << result.text;
    EXPECT_EQ(figure_value(result.figures, "mass_difference"), -1) << "mass at one place";
    EXPECT_EQ(figure_value(result.figures, "mass_x_difference") <= 1, more == 1);
  }
}

/// Returns the failed checks if the arm differs from its file.
std::string failed_with(const std::function<void(scene::ArmFile&)>& change, double spring = 0) {
  Bench bench("vintage_phantom");
  bench.options.spring = spring;
  change(bench.arm);
  return failed(bench.results());
}

TEST(Hil, NamesTheWrongProperty) {
  EXPECT_EQ(failed_with([](scene::ArmFile& arm) { arm.simulated.wire.delay_out_ns += 1'500'000; }),
            "constants stiffest_wall");
  EXPECT_EQ(failed_with([](scene::ArmFile& arm) { arm.simulated.wire.loss = 0.1; }),
            "constants reports");
  EXPECT_EQ(
      failed_with([](scene::ArmFile& arm) { arm.simulated.firmware.watchdog_ns = 400'000'000; }),
      "feel_check");
  // A motor with four fifths of its torque. Without a scale only the ratio to the other motors is
  // visible; the spring shows the rest.
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

/// Returns the edge of a free simulated arm whose wire has the delay `delay_ms`; sets its ratio to
/// that of the law.
EdgeOfWall edge_with(double delay_ms, const EdgeSearch& search, double& ratio,
                     double coulomb = 0.04) {
  scene::ArmFile arm = scene::load_arm("vintage_phantom").value();
  arm.simulated.plant.coulomb = coulomb;
  arm.simulated.wire = {.delay_in_ns = 0,
                        .delay_out_ns = static_cast<std::int64_t>(delay_ms * 1e6)};
  const auto bench = open_simulated(arm, {}, TipHold::kFree);
  const std::atomic<bool> never{false};
  auto found = find_edge_of_wall(*bench.value(), arm, search, never);
  EXPECT_TRUE(found.ok()) << found.error().message;
  if (!found) return {};
  ratio = found->stiffness.median / edge_by_law(arm, search.speed);
  std::printf("%.1f ms: %.0f N/m (%.0f to %.0f), %.2f of the law's; gave %.3g mJ, %d walls\n",
              delay_ms, found->stiffness.median, found->stiffness.low, found->stiffness.high, ratio,
              1e3 * found->max_energy_given, found->walls);
  return *found;
}

TEST(Hil, FindsTheWallOfTheLaw) {
  const EdgeSearch search{.factor = 1.02, .starts = 9};
  for (const double delay_ms : {0.0, 1.0, 2.0, 4.0}) {
    double ratio = 0;
    const EdgeOfWall edge = edge_with(delay_ms, search, ratio);
    EXPECT_TRUE(edge.grew);
    // The law is that of an oscillation with constant speed. A delayed wall is soft and its
    // oscillation slow; dry friction takes a third of the kick's speed before the wall reverses the
    // tip.
    EXPECT_GT(ratio, 0.9);
    EXPECT_LT(ratio, delay_ms <= 1 ? 1.1 : 1.5);
    EXPECT_LE(edge.max_force, kHilForceMax);
  }
}

TEST(Hil, DetectsGrowthWithLittleEnergy) {
  double ratio = 0;
  const EdgeOfWall edge = edge_with(1, {.first = 30, .starts = 9}, ratio, 0.004);
  EXPECT_TRUE(edge.grew);
  EXPECT_NEAR(ratio, 1, 0.25);
}

TEST(Hil, RemovesAWallThatAddsEnergy) {
  // Ten times the kick's energy, plus the energy of one tick.
  const double kick = 0.5 * 0.075 * 0.03 * 0.03;  // J
  double ratio = 0;
  const EdgeOfWall edge = edge_with(4, {.coarse = 8, .starts = 1}, ratio);
  EXPECT_TRUE(edge.grew);
  EXPECT_GT(edge.max_energy_given, kick);
  EXPECT_LT(edge.max_energy_given, 20 * kick);
}

/// Returns an arm of the file whose tip begins up to 3 mm away, at other positions between encoder
/// steps. Its delay to the motors, or its friction, makes the stiffest wall by the law `times` that
/// of the file.
scene::ArmFile arm_of_wall(const scene::ArmFile& file, int seed, double times, bool by_friction) {
  scene::ArmFile arm = file;
  std::mt19937 draw(static_cast<unsigned>(seed));
  for (int i = 0; i < 3; ++i) {
    const double beside = 6e-3 * (static_cast<double>(draw()) / 4294967296.0 - 0.5);  // m
    arm.workspace.min_W[i] += beside;
    arm.workspace.max_W[i] += beside;
  }
  const double speed = EdgeSearch{}.speed;
  const auto& plant = file.simulated.plant;
  if (by_friction) {
    arm.simulated.plant.viscous *= times;
    arm.simulated.plant.coulomb *= times;
    EXPECT_NEAR(edge_by_law(arm, speed) / edge_by_law(file, speed), times, 1e-3);
    return arm;
  }
  const double latency = (plant.viscous + 4 * plant.coulomb / (std::numbers::pi * speed)) /
                         edge_by_law(file, speed);  // s
  arm.simulated.wire.delay_out_ns += std::llround(1e9 * latency * (1 / times - 1));
  EXPECT_NEAR(edge_by_law(arm, speed) / edge_by_law(file, speed), times, 1e-3);
  return arm;
}

/// Runs only the check of the stiffest wall.
HilResult wall_of(const scene::ArmFile& file, const scene::ArmFile& arm, bool full) {
  const std::atomic<bool> never{false};
  return check_stiffest_wall({.file = file,
                              .open = [&](TipHold hold) { return open_simulated(arm, {}, hold); },
                              .stop = never,
                              .prompt = {}},
                             full);
}

TEST(Hil, JudgesTheStiffestWallToATenth) {
  const bool all = support::long_form();
  std::vector<const char*> names{"vintage_phantom"};
  if (all) names.insert(names.end(), {"woodenhaptics_teensy", "polhem"});
  const auto judge = [all](const char* name, int seed, double times, bool by_friction) {
    const auto file = scene::load_arm(name).value();
    const HilResult wall =
        wall_of(file, arm_of_wall(file, seed, times, by_friction), all && seed % 2 == 0);
    EXPECT_EQ(wall.outcome, times == 1 ? HilOutcome::kPassed : HilOutcome::kFailed)
        << name << " " << seed << ", " << times << (by_friction ? " by friction" : " by delay")
        << ": " << wall.text;
    const double low = figure_value(wall.figures, "wall_over_twin_low"),
                 middle = figure_value(wall.figures, "wall_over_twin"),
                 high = figure_value(wall.figures, "wall_over_twin_high");
    std::printf("%s %2d, %.3f times by law of %s: %.3f (%.3f to %.3f)\n", name, seed, times,
                by_friction ? "friction" : "delay", middle, low, high);
    EXPECT_LE(low, middle);
    EXPECT_GE(high, middle);
    EXPECT_LE(figure_value(wall.figures, "max_force"), kHilForceMax);
  };
  for (const char* name : names) {
    for (int seed = 0; seed < (all ? 20 : 2); ++seed) {
      judge(name, seed, 1, false);
      for (const double times : {0.85, 1 / 0.85}) {
        for (const bool by_friction : {false, true}) {
          if (all || by_friction == (seed == 1)) judge(name, seed, times, by_friction);
        }
      }
    }
  }
}

TEST(Hil, IntervalsContainTheTrueMedian) {
  std::mt19937 draw(static_cast<std::uint32_t>(support::seed_of(5)));
  for (const int count : {kMedianMin, 9, 33, 65}) {
    const int tries = 4000;
    int held = 0;
    for (int i = 0; i < tries; ++i) {
      std::vector<double> values;  // a skew distribution with the median ln 2
      for (int k = 0; k < count; ++k) {
        values.push_back(-std::log((static_cast<double>(draw()) + 0.5) / 4294967296.0));
      }
      const MedianInterval found = median_interval(values);
      held += found.low <= std::numbers::ln2 && std::numbers::ln2 <= found.high ? 1 : 0;
    }
    // Four standard deviations of 4,000 draws are 1.4 %. By the binomial distribution the intervals
    // contain the median in 96.9, 96.1, 96.5 and 95.4 %, and in less than 93 % if they were one
    // rank narrower.
    EXPECT_GT(held, 0.95 * tries) << count;
    EXPECT_LT(held, 0.985 * tries) << count;
  }
  EXPECT_EQ(median_interval({3, 1, 2, 9}).median, 2.5);
  EXPECT_EQ(median_interval({3, 1, 2}).low, 1);
  EXPECT_EQ(median_interval({3, 1, 2}).high, 3);
}

TEST(Hil, MeasuresTheWatchdogOfAFreeArm) {
  for (const std::int64_t time_ms : {60, 100, 120, 160, 300}) {
    SCOPED_TRACE(time_ms);
    Bench bench("vintage_phantom");
    bench.attended = false;
    bench.options.checked = true;
    bench.options.only = {"watchdog"};
    bench.arm.simulated.firmware.watchdog_ns = time_ms * 1'000'000;
    const HilResult watchdog = bench.results().at("watchdog");
    if (time_ms <= 120) {
      EXPECT_EQ(watchdog.outcome, HilOutcome::kPassed) << watchdog.text;
      EXPECT_NEAR(figure_value(watchdog.figures, "watchdog_time"), static_cast<double>(time_ms), 5);
    } else if (time_ms == 300) {
      // The tip has moved 15 mm long before, and is released.
      EXPECT_EQ(watchdog.outcome, HilOutcome::kFailed) << watchdog.text;
      EXPECT_EQ(figure_value(watchdog.figures, "watchdog_seen"), 0);
    }
  }
}

TEST(Hil, AppliesNoForceBeforeTheFeelCheck) {
  Bench bench("vintage_phantom");
  bench.attended = false;
  bench.options.checked = false;
  const auto results = bench.results();
  EXPECT_EQ(failed(results), "feel_check");
  for (const char* check :
       {"constants", "watchdog", "friction_at_rest", "stiffest_wall", "force_accuracy", "soak"}) {
    EXPECT_EQ(results.at(check).outcome, HilOutcome::kNotRun) << check;
  }
}

TEST(Hil, StopsPushingAgainstAReversedMotor) {
  for (int motor = 0; motor < 3; ++motor) {
    Bench bench("vintage_phantom");
    bench.attended = false;
    bench.options.checked = true;  // the wire was reversed after the feel check
    bench.arm.simulated.firmware.wiring.motor_gain[motor] = -1;
    const auto results = bench.results();
    EXPECT_EQ(failed(results), "constants") << motor;
    EXPECT_TRUE(results.at("constants").unsafe);
    EXPECT_EQ(results.at("stiffest_wall").outcome, HilOutcome::kNotRun);
    EXPECT_EQ(results.at("soak").outcome, HilOutcome::kNotRun);
  }
}

}  // namespace
}  // namespace thimble::hil
