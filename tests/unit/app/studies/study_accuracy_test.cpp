#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mesh/surface_weights.h"
#include "studies/accuracy/accuracy_axis.h"
#include "studies/accuracy/axis_words.h"
#include "studies/accuracy/free_spin.h"
#include "studies/accuracy/gating/gating.h"
#include "studies/accuracy/guarded_wall.h"
#include "studies/accuracy/held_motion.h"
#include "studies/accuracy/measure_axis.h"
#include "studies/accuracy/stiffest_wall.h"
#include "studies/accuracy/straight_walk.h"
#include "studies/accuracy/velocity_estimates.h"
#include "studies/rate_bench.h"
#include "support/covered.h"
#include "support/meshes/shapes.h"
#include "support/shipped_scenes.h"
#include "thimble/session/histogram.h"

namespace thimble::studies {
namespace {

// Cases that take long in a debug build are tested once, in their shortest form.
bool is_costly(const AccuracyAxis& axis) {
  return axis.name == "search" || axis.name == "float" || axis.name == "effects" ||
         axis.name == "tracking";
}

TEST(AccuracyAxes, HaveAllTextsOfThePage) {
  std::set<std::string> names, titles;
  for (const AxisMaker& maker : accuracy_axes()) {
    const AccuracyAxis axis = maker.make();
    EXPECT_EQ(axis.name, maker.name);
    EXPECT_TRUE(names.insert(axis.name).second) << axis.name;
    EXPECT_TRUE(titles.insert(axis.title).second) << axis.title;
    for (const std::string* text :
         {&axis.title, &axis.metric, &axis.unit, &axis.truth, &axis.left_out}) {
      EXPECT_FALSE(text->empty()) << axis.name;
    }
    EXPECT_TRUE(axis.threshold || !axis.felt_words.empty()) << axis.name;
    int defaults = 0;
    std::set<std::string> points;
    for (const AccuracyLine& line : axis.lines) {
      EXPECT_GE(line.points.size(), 5U) << axis.name << ' ' << line.name;
      for (const AccuracyPoint& point : line.points) {
        const std::string name = line.name + '/' + point.name;
        EXPECT_TRUE(points.insert(name).second) << axis.name << ' ' << name;
        EXPECT_EQ(name.find_first_of(" '"), std::string::npos) << name;
        defaults += point.is_default ? 1 : 0;
      }
    }
    EXPECT_LE(defaults, 1) << axis.name;
    // The page gives a reason if the default is not on the Pareto front or if there is no default.
    const bool simulator = axis.name.rfind("simulator", 0) == 0;
    EXPECT_TRUE(simulator || !axis.default_words.empty()) << axis.name;
  }
}

TEST(AccuracyAxes, ShowOrderOfEachMethodAndRoundingOfExactOnes) {
  int orders = 0;
  int exact = 0;
  for (const AxisMaker& maker : accuracy_axes()) {
    const AccuracyAxis axis = maker.make();
    for (const AccuracyLine& line : axis.lines) {
      if (is_costly(axis) && !line.order) continue;
      std::vector<MeasuredPoint> points;
      for (const AccuracyPoint& point : line.points) {
        if (line.exact) {
          EXPECT_LT(point.error(), 1e-8) << axis.name << ' ' << line.name << ' ' << point.name;
          ++exact;
        } else if (line.order && point.fits) {
          MeasuredPoint measured;
          measured.point = &point;
          measured.error = point.error();
          points.push_back(measured);
        }
      }
      if (!line.order) continue;
      const auto slope = slope_of(points);
      ASSERT_TRUE(slope) << axis.name << ' ' << line.name;
      EXPECT_NEAR(*slope, *line.order, 0.2) << axis.name << ' ' << line.name;
      ++orders;
    }
  }
  EXPECT_GE(orders, 25);
  EXPECT_GE(exact, 20);
}

TEST(AccuracyAxes, AgreeWithThePublishedLaws) {
  int looked_at = 0;
  for (const AxisMaker& maker : accuracy_axes()) {
    const AccuracyAxis axis = maker.make();
    for (const AccuracyLine& line : axis.lines) {
      for (const AccuracyPoint& point : line.points) {
        if (!point.law) continue;
        const bool bounce = axis.name == "loop_rate" || axis.name == "latency";
        // The law of a bounce holds if an oscillation lasts for many ticks [PHYSICS 1.5].
        if (bounce && *point.law > 15) continue;
        const double error = point.error();
        const std::string where = axis.name + ' ' + line.name + ' ' + point.name;
        if (bounce) {
          EXPECT_NEAR((100 + error) / (100 + *point.law), 1, 0.01) << where;
        } else {
          // Long ticks are random: their share in 4 s differs from its mean by some percent.
          EXPECT_NEAR(error / *point.law, 1, line.name == "gaps" ? 0.07 : 0.03) << where;
        }
        ++looked_at;
      }
    }
  }
  EXPECT_GE(looked_at, 55);
}

TEST(AccuracyAxes, ErrorsAreBitIdenticalAndPreparedStrokesRun) {
  for (const AxisMaker& maker : accuracy_axes()) {
    const AccuracyAxis axis = maker.make();
    if (is_costly(axis)) continue;
    const AccuracyPoint& point = axis.lines.front().points.front();
    const double first = point.error();
    const double again = maker.make().lines.front().points.front().error();
    EXPECT_TRUE(first == again || (std::isnan(first) && std::isnan(again))) << axis.name;
    EXPECT_TRUE(std::isfinite(point.prepare()())) << axis.name;
  }
}

TEST(StiffestWall, EqualsTableForDampersWithLowPass) {
  // [PHYSICS 1.1]: B = 2 N s/m with the PHANTOM-like arm, confirmed there by a simulation.
  struct Row {
    double corner, stiffness;
  };
  for (const Row& row : {Row{0, 3902}, Row{100, 3412}, Row{50, 2692}, Row{30, 2016}}) {
    RestedWall wall{.mass = 0.075, .viscous = 0.005, .damping = 2};
    wall.duration = 4;
    wall.estimate = [&row] { return product_estimate(row.corner, 1e-3); };
    EXPECT_NEAR(stiffest(wall) / row.stiffness, 1, 0.02) << row.corner << " Hz";
  }
}

// Returns the largest damping on which a coupling may count without adding speed in a bounce.
double max_counted_on(double stiffness) {
  double gives = 1, none = GuardedArm::kViscous / 2;
  while (gives > 1.02 * none) {
    const double middle = std::sqrt(gives * none);
    double max = 0;
    for (int phase = 0; phase < 20; ++phase) {
      GuardedWall wall({.counted_on = middle}, stiffness);
      LineMotion now{-0.2 * GuardedArm::kTick * (1 + phase / 20.0), 0.2};
      for (int i = 0; i < 20000 && !(now.x < 0 && now.v < 0); ++i) {
        now = moved_by_held_force(now, GuardedArm::kMass, GuardedArm::kViscous, -wall.force(now.x),
                                  GuardedArm::kTick);
      }
      max = std::max(max, -now.v / 0.2);
    }
    (max > 1 ? gives : none) = middle;
  }
  return none;
}

const AccuracyLine& line_named(const AccuracyAxis& axis, const std::string& name) {
  return *std::find_if(axis.lines.begin(), axis.lines.end(),
                       [&](const AccuracyLine& line) { return line.name == name; });
}

AccuracyAxis axis_named(std::string_view name) {
  return std::find_if(accuracy_axes().begin(), accuracy_axes().end(),
                      [&](const AxisMaker& maker) { return maker.name == name; })
      ->make();
}

TEST(AccuracyAxes, IncludeCompactTrackerWhereverTrackersDiffer) {
  for (const char* name :
       {"tessellation", "tessellation_direction", "tessellation_jump", "tracking", "float"}) {
    const AccuracyAxis axis = axis_named(name);
    EXPECT_EQ(line_named(axis, "compact").points.size(), axis.lines.front().points.size()) << name;
  }
  // At the default size, the force of flat triangles is off by a fifth, that of compact by a
  // hundredth.
  const AccuracyAxis force = axis_named("tessellation");
  const auto error = [&](const char* line) { return line_named(force, line).points[4].error(); };
  EXPECT_GT(error("flat"), 10);
  EXPECT_LT(error("compact"), 1.5);
}

TEST(AccuracyAxes, DiagramsOfOneMetricHaveOneThreshold) {
  std::map<std::string, double> limits;
  int shared = 0;
  for (const AxisMaker& maker : accuracy_axes()) {
    const AccuracyAxis axis = maker.make();
    if (!axis.threshold) continue;
    const auto [at, fresh] = limits.try_emplace(axis.metric + axis.unit, *axis.threshold);
    shared += fresh ? 0 : 1;
    EXPECT_EQ(at->second, *axis.threshold) << axis.name;
  }
  EXPECT_GE(shared, 5);
}

TEST(AccuracyAxes, DentErrorsFollowTheClosedForm) {
  const AccuracyAxis axis = axis_named("dent_speed");
  for (const char* name : {"implicit", "implicit_20k"}) {
    const AccuracyPoint& slowest = line_named(axis, name).points.back();
    ASSERT_EQ(slowest.knob, 0.001);
    // Implicit Euler loses w h / 2 of the amplitude per radian; half a period has pi radians.
    EXPECT_NEAR(slowest.error(), 100 * M_PI * slowest.knob / 2, 0.01) << name;
  }
  for (const char* name : {"trapezoid", "trapezoid_20k"}) {
    EXPECT_LT(line_named(axis, name).points.back().error(), 1e-3) << name;
  }
}

TEST(AccuracyAxes, ParametersOfSceneOrArmAreMarkedAsGiven) {
  for (const AxisMaker& maker : accuracy_axes()) {
    const AccuracyAxis axis = maker.make();
    const bool given = axis.name.starts_with("encoder") || axis.name.starts_with("latency") ||
                       axis.name == "dent_speed";
    EXPECT_EQ(axis.given, given) << axis.name;
  }
  AccuracyAxis axis = axis_named("encoder");
  axis.lines.resize(1);
  const MeasuredAxis measured = measure_axis(std::move(axis), {.rounds = 0, .count = false});
  for (const MeasuredPoint& point : measured.lines[0].points) EXPECT_FALSE(point.on_front);
  AccuracyAxis product = axis_named("encoder");
  const MeasuredAxis whole = measure_axis(std::move(product), {.rounds = 0, .count = false});
  EXPECT_EQ(default_sentence(whole).rfind("The arm determines this value: the encoders", 0), 0U);
  for (const session::Figure& figure : figures_of(whole)) {
    EXPECT_EQ(figure.name.find("default"), std::string::npos) << figure.name;
  }
}

TEST(AccuracyAxes, SafetyStagesAreComparedAtTheTwentiethBounce) {
  const AccuracyAxis axis = axis_named("safety");
  for (std::size_t i = 1; i < 4; ++i) {  // 500 to 2,000 N/m
    // With limits only, the speed grows forever; the observer permits some growth in the first
    // bounces only.
    EXPECT_GT(line_named(axis, "none").points[i].error(), 2);
    EXPECT_LT(line_named(axis, "passivity").points[i].error(),
              line_named(axis, "none").points[i].error() / 4)
        << i;
  }
}

TEST(AccuracyAxes, OnlySmoothProfileHasContinuousTurningRate) {
  const AccuracyAxis axis = axis_named("profile_rate");
  const auto at = [&](const char* line, std::size_t i) {
    return line_named(axis, line).points[i].error();
  };
  // Steps of 1 um and of 30 um: a discontinuous rate keeps its jump.
  EXPECT_NEAR(at("linear", 0) / at("linear", 3), 1, 0.3);
  EXPECT_LT(at("smooth", 0), at("linear", 0) / 25);
  EXPECT_LT(at("smooth", 0), at("smooth", 3) / 20);
}

TEST(StraightWalk, RoundABlockReturnsToItsStart) {
  const auto mesh = render::ContactMesh::build(support::box({0.005, 0.005, 0.005})).value();
  for (std::int32_t t = 0; t < mesh.triangle_count(); ++t) {
    const Eigen::Vector3d& n = mesh.cell(t).face.n;
    for (const Eigen::Vector3d& direction :
         {Eigen::Vector3d(n.y(), n.z(), n.x()), Eigen::Vector3d(-n.z(), -n.x(), -n.y())}) {
      StraightWalk walk(mesh, t, direction);
      const Eigen::Vector3d begin = render::point_at(mesh, t, walk.weights());
      for (int side = 1; side <= 4; ++side) {
        for (int step = 0; step < 10; ++step) {
          walk.advance(0.001);
          ASSERT_GE(walk.weights().minCoeff(), 0);
        }
        const Eigen::Vector3d here = render::point_at(mesh, walk.triangle(), walk.weights());
        // Half-way round it is opposite, on the other side of the block's centre.
        if (side == 2) {
          EXPECT_NEAR((begin - here).dot(n), 0.01, 1e-12) << t;
        }
        if (side == 4) {
          EXPECT_LT((here - begin).norm(), 1e-12) << t;
        }
      }
    }
  }
}

TEST(VirtualCoupling, AddsNoSpeedUpToItsDesignLimit) {
  for (const double stiffness : {250.0, 1000.0, 4000.0, 1e6}) {
    // Counting on the arm's own damping adds no speed; the limit is less than twice as large.
    const double counted_on = max_counted_on(stiffness);
    EXPECT_GE(counted_on, GuardedArm::kViscous) << stiffness;
    EXPECT_LE(counted_on, 2 * GuardedArm::kViscous) << stiffness;
  }
}

TEST(Tracking, SearchesAreExactAndEdgePlanesAlmostAlways) {
  for (const AxisMaker& maker : accuracy_axes()) {
    if (maker.name != "tracking") continue;
    const AccuracyAxis axis = maker.make();
    for (const AccuracyLine& line : axis.lines) {
      const AccuracyPoint& fast = line.points[3];
      const double wrong = fast.error();
      if (line.name == "tree" || line.name == "linear" || line.name == "hops_ring") {
        EXPECT_EQ(wrong, 0) << line.name;
      } else if (line.name == "edge_planes") {
        EXPECT_LE(wrong, 0.5);
        EXPECT_EQ(wrong, fast.error());
      } else {
        EXPECT_LE(wrong, 10) << line.name;
      }
    }
  }
}

TEST(FreeSpin, SolvesEulerEquationsNearIntermediateAxis) {
  for (const Eigen::Vector3d& start : {Eigen::Vector3d(0.2, 12, 0.5), Eigen::Vector3d(3, 5, -1),
                                       Eigen::Vector3d(-2, -7, 1), Eigen::Vector3d(0.3, 1, -4)}) {
    FreeSpin spin;
    spin.omega = start;
    EXPECT_LT((true_rate(spin, 0) - start).norm(), 1e-9);
    for (const double t : {0.1, 0.7, 2.3}) {
      const double h = 1e-5;
      const Eigen::Vector3d rate = (true_rate(spin, t + h) - true_rate(spin, t - h)) / (2 * h);
      const Eigen::Vector3d w = true_rate(spin, t);
      const Eigen::Vector3d turn = spin.inertia.cwiseProduct(w).cross(w);
      EXPECT_LT((rate - turn.cwiseQuotient(spin.inertia)).norm(), 1e-4) << start.transpose();
    }
  }
}

// Makes an axis of two methods with given costs and errors, without timing.
MeasuredAxis measured_by_hand() {
  AccuracyAxis axis;
  axis.name = "by_hand";
  axis.unit = "mN";
  axis.threshold = 20;
  axis.default_words = "because.";
  AccuracyLine line{.name = "a", .title = "method a"};
  for (const double knob : {1.0, 2.0, 4.0, 8.0}) {
    AccuracyPoint point{.name = std::to_string(static_cast<int>(knob)),
                        .knob = knob,
                        .error = [knob] { return 10 * knob * knob; },
                        .prepare = [] { return Stroke([] { return 0.0; }); }};
    point.is_default = knob == 4;
    point.fits = true;
    line.points.push_back(point);
  }
  axis.lines.push_back(line);
  return measure_axis(axis, {.rounds = 0, .count = false});
}

TEST(MeasuredAxis, IsRestoredFromItsNumbers) {
  const MeasuredAxis measured = measured_by_hand();
  const MeasuredAxis again = with_numbers(measured.axis, numbers_of(measured));
  EXPECT_TRUE(again.complete);
  EXPECT_EQ(again.lines[0].slope, measured.lines[0].slope);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(again.lines[0].points[i].error, measured.lines[0].points[i].error);
    EXPECT_EQ(again.lines[0].points[i].on_front, measured.lines[0].points[i].on_front);
    EXPECT_FALSE(again.lines[0].points[i].instructions);
  }
}

TEST(MeasuredAxis, TooFewNumbersAreIncomplete) {
  const MeasuredAxis measured = measured_by_hand();
  std::vector<double> numbers = numbers_of(measured);
  numbers.pop_back();
  EXPECT_FALSE(with_numbers(measured.axis, numbers).complete);
}

TEST(MeasuredAxis, IsStoppedBetweenTwoPoints) {
  AccuracyAxis axis = measured_by_hand().axis;
  std::atomic<bool> stop{false};
  int errors = 0, steps = 0;
  for (AccuracyPoint& point : axis.lines[0].points) {
    point.error = [&] {
      stop = ++errors == 2;
      return 1.0;
    };
  }
  const MeasuredAxis measured = measure_axis(
      std::move(axis),
      {.rounds = 5, .count = true, .stop = &stop, .advance = [&](int done) { steps += done; }});
  EXPECT_FALSE(measured.complete);
  EXPECT_EQ(errors, 2);
  EXPECT_EQ(steps, 2);
}

TEST(MeasuredAxis, ReportsTheAnnouncedNumberOfSteps) {
  AccuracyAxis axis = measured_by_hand().axis;
  int steps = 0;
  MeasureOptions options{.rounds = 5, .count = false, .advance = [&](int done) { steps += done; }};
  const int announced = steps_of(axis, options);
  measure_axis(std::move(axis), options);
  EXPECT_EQ(steps, announced);
}

TEST(MeasuredAxis, FindsSlopeDefaultAndFeltLimit) {
  const MeasuredAxis axis = measured_by_hand();
  ASSERT_TRUE(axis.lines[0].slope);
  EXPECT_NEAR(*axis.lines[0].slope, 2, 1e-12);
  ASSERT_NE(axis.enough(), nullptr);
  EXPECT_EQ(axis.enough()->error, 10);
  ASSERT_NE(axis.default_point(), nullptr);
  // All have the same cost, so only the one with the smallest error is on the front.
  EXPECT_TRUE(axis.lines[0].points[0].on_front);
  EXPECT_FALSE(axis.default_point()->on_front);
  EXPECT_NE(default_sentence(axis).find("because."), std::string::npos);
  EXPECT_NE(felt_sentence(axis).find("method a at 1"), std::string::npos);
}

TEST(MeasuredAxis, RunsSubtractedWorkAsOftenAsThePoint) {
  AccuracyAxis axis;
  axis.name = "by_hand";
  int with = 0, baseline = 0;
  AccuracyLine line{.name = "a", .title = "method a"};
  line.points.push_back({.name = "1",
                         .knob = 1,
                         .error = [] { return 0.0; },
                         .prepare = [&] { return Stroke([&] { return 1.0 * ++with; }); },
                         .baseline = [&] { return Stroke([&] { return 1.0 * ++baseline; }); }});
  axis.lines.push_back(line);
  measure_axis(std::move(axis), {.rounds = 7, .count = false});
  EXPECT_EQ(with, 8);  // one more, to fill the caches
  EXPECT_EQ(baseline, 8);
}

TEST(RateBench, VerdictUsesLateTicksAndJitter) {
  RateBench bench;
  bench.rate = 1000;
  bench.priority = true;
  for (int i = 0; i < 10000; ++i) {
    bench.period.add(1'000'000);
    bench.lateness.add(20'000);
    bench.work.add(10'000);
  }
  EXPECT_TRUE(verdict_of(bench).enough);
  EXPECT_NEAR(verdict_of(bench).headroom, 0.97, 0.01);
  EXPECT_EQ(verdict_of(bench).sentence.rfind("Enough", 0), 0U);

  // One tick in a hundred takes 10 ms: 44 % of the stiffness is lost [PHYSICS 1.1].
  session::Histogram gaps;
  for (int i = 0; i < 9900; ++i) gaps.add(1'000'000);
  for (int i = 0; i < 100; ++i) gaps.add(10'000'000);
  const double mean = 1.09;
  EXPECT_NEAR(stiffness_lost(gaps), 1 - mean * mean / 1.99, 0.02);
  RateBench uneven = bench;
  uneven.period = gaps;
  EXPECT_FALSE(verdict_of(uneven).enough);
  EXPECT_NE(verdict_of(uneven).sentence.find("uneven ticks"), std::string::npos);

  RateBench slow = bench;
  for (int i = 0; i < 100; ++i) slow.work.add(2'000'000);
  EXPECT_NE(verdict_of(slow).sentence.find("the computation takes"), std::string::npos);
}

class GatingOfScene : public ::testing::TestWithParam<std::string> {};

TEST_P(GatingOfScene, IsCheckedAgainstTheFullModel) {
  if (GetParam() == "elephant" && !std::filesystem::exists(THIMBLE_MESHES "/elephant.off")) {
    GTEST_SKIP() << "needs its scanned mesh";
  }
  const auto report = decide_gating(support::scene_file(GetParam()), false);
  ASSERT_TRUE(report.ok()) << report.error().message;
  bool any_left_out = false;
  for (const GateDecision& one : report->decisions) {
    EXPECT_FALSE(one.rule.empty());
    EXPECT_EQ(one.change.has_value(), one.changes) << one.effect;
    any_left_out = any_left_out || (one.left_out && one.changes);
    if (one.left_out && one.change) {
      std::printf("  %s without %s: %.3g of the force\n", GetParam().c_str(), one.name.c_str(),
                  *one.change);
      EXPECT_LT(*one.change, 0.01) << one.effect;
    }
  }
  EXPECT_GT(report->force, 0);
  EXPECT_LT(report->change, 0.01);
  // With no effect left out, the run is bit-identical.
  if (!any_left_out) {
    EXPECT_EQ(report->change, 0);
  }
  EXPECT_NE(gating_text(*report).find("Without all"), std::string::npos);
  support::Covered("scenes").add(GetParam());
}

INSTANTIATE_TEST_SUITE_P(ByName, GatingOfScene, ::testing::ValuesIn(support::scenes_of_one_arm()),
                         [](const auto& scene) { return scene.param; });

}  // namespace
}  // namespace thimble::studies
