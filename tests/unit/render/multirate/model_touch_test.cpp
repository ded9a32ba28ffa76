#include "thimble/render/multirate/model_touch.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <thread>

#include "support/heap_guard.h"
#include "support/random.h"
#include "support/seed.h"
#include "support/slow_surface.h"

namespace thimble::render {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using support::SlowSide;
using support::SlowSurface;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

LocalModel plane(double stiffness = 800, std::int64_t time_ns = 0) {
  LocalModel model;
  model.stiffness = stiffness * Vector3d::UnitZ() * Vector3d::UnitZ().transpose();
  model.time_ns = time_ns;
  return model;
}

/// Moves a tip tick by tick and sums up the work, as true springs would give it.
struct Tip {
  explicit Tip(const ModelTouchSettings& settings = {.stiffness_max = 2000}) {
    auto made = ModelTouch::make(slot, settings);
    EXPECT_TRUE(made);
    touch = std::move(made).value();
  }

  const driver::ForceCommand& to(const Vector3d& p_W) {
    state.dt = begun ? 1e-3 : 0;
    state.time_ns += begun ? 1'000'000 : 0;
    const Vector3d way = begun ? Vector3d(p_W - state.p_WT) : Vector3d::Zero();
    state.p_WT = p_W;
    const Vector3d before = felt.f_T_W;
    felt = touch->update(state);
    // Work of the force on the hand along this path, with the mean of both ends: exact for springs.
    given += 0.5 * (before + felt.f_T_W).dot(way);
    max_given = std::max(max_given, given);
    change = (felt.f_T_W - before).norm();
    begun = true;
    return felt;
  }
  /// Advances `ticks` ticks at the same place.
  const driver::ForceCommand& stay(int ticks) {
    for (int i = 0; i < ticks; ++i) to(state.p_WT);
    return felt;
  }

  ModelSlot slot;
  std::unique_ptr<ModelTouch> touch;
  driver::DeviceState state;
  driver::ForceCommand felt;
  double given = 0, max_given = 0, change = 0;
  bool begun = false;
};

Vector3d at_depth(double depth) {
  return {0, 0, -depth};
}

TEST(ModelTouch, PlaneFeelsLikeItsSpring) {
  Tip tip;
  ASSERT_TRUE(tip.slot.publish(plane()));
  EXPECT_EQ(tip.to(at_depth(-0.001)).f_T_W, Vector3d::Zero());
  EXPECT_FALSE(tip.felt.touch.in_contact);
  for (const double depth : {0.0002, 0.001, 0.003, 0.002, 0.0001}) {
    tip.to(at_depth(depth) + Vector3d(depth, 0, 0));
    EXPECT_NEAR(tip.felt.f_T_W.z(), 800 * depth, 1e-9);
    EXPECT_NEAR(tip.felt.f_T_W.head<2>().norm(), 0, 1e-12);
    EXPECT_TRUE(tip.felt.touch.in_contact);
    EXPECT_NEAR(tip.felt.touch.depth, depth, 1e-12);
  }
  EXPECT_EQ(tip.to(at_depth(-0.0001)).f_T_W, Vector3d::Zero());
  EXPECT_FALSE(tip.felt.touch.in_contact);
}

TEST(ModelTouch, DampsEntryOnly) {
  Tip tip;
  LocalModel model = plane();
  model.damping = 2;
  ASSERT_TRUE(tip.slot.publish(model));
  tip.to(at_depth(-0.001));
  tip.state.v_WT = {0, 0, -0.1};
  EXPECT_NEAR(tip.to(at_depth(0.001)).f_T_W.z(), 0.8 + 0.2, 1e-9);
  tip.state.v_WT = {0.1, 0, 0};  // along the plane: no force
  EXPECT_NEAR(tip.to(at_depth(0.001)).f_T_W.z(), 0.8, 1e-9);
  tip.state.v_WT = {0, 0, 1};
  EXPECT_EQ(tip.to(at_depth(0.001)).f_T_W, Vector3d::Zero());
}

/// Returns a random model near a place: one to three springs of any strength and direction.
LocalModel any_model(support::Random& random, const Vector3d& near_W, std::int64_t time_ns) {
  const auto direction = [&random] {
    return Vector3d{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)}
        .normalized();
  };
  LocalModel model;
  model.n_W = direction();
  model.stiffness = random.uniform(10, 2000) * model.n_W * model.n_W.transpose();
  for (int i = 0; i < 2; ++i) {
    const Vector3d other = direction();
    if (random.uniform(0, 1) < 0.5) {
      model.stiffness += random.uniform(0, 1000) * other * other.transpose();
    }
  }
  model.stiffness = 0.5 * (model.stiffness + model.stiffness.transpose()).eval();
  model.p_WR = near_W + 0.002 * direction();
  model.f_T_W = random.uniform(0, 3) * (model.n_W + 0.3 * direction());
  model.time_ns = time_ns;
  return model;
}

TEST(ModelTouch, ForceChangeIsBoundedForAnyModels) {
  // The tip rests, so that all changes are due to new models, which may be unrelated. The begin and
  // end of a touch are not jumps either.
  support::Random random(1);
  Tip tip({.stiffness_max = 2000, .power = 1});
  for (int k = 0; k < 20'000; ++k) {
    if (k % 17 == 0) {
      ASSERT_TRUE(tip.slot.publish(any_model(random, {0, 0, 0}, tip.state.time_ns)));
    }
    const double before = tip.felt.f_T_W.norm();
    tip.to({0, 0, 0});
    EXPECT_LE(tip.change, 0.0401 * before + 0.00301) << k;  // to the model, and to the account
  }
  EXPECT_GT(tip.touch->counters().taken, 1000u);
}

TEST(ModelTouch, GivesNoEnergyForAnyModels) {
  // Around closed paths through unrelated models: each is a valid spring, but together they would
  // generate energy without limit if there were no account.
  double most = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    support::Random random(support::seed_of(seed));
    Tip tip({.stiffness_max = 2000, .power = 0, .reserve = 0.001});
    const double a = random.uniform(5, 60), b = random.uniform(5, 60);
    for (int k = 0; k < 5000; ++k) {
      const double t = 1e-3 * k;
      if (k % 17 == 0) {
        ASSERT_TRUE(tip.slot.publish(any_model(random, tip.state.p_WT, tip.state.time_ns)));
      }
      tip.to(0.002 * Vector3d(std::sin(a * t), std::sin(b * t), std::cos(a * t)));
    }
    most = std::max(most, tip.max_given);
  }
  EXPECT_LE(most, 1e-6);
}

TEST(ModelTouch, ReturnsNoMoreEnergyThanItTook) {
  // In and out of surfaces at many speeds and phases: the work returned is at most the work put in.
  double min_share = 1;
  for (const auto feel :
       {SlowSurface::Feel::kEven, SlowSurface::Feel::kStiffening, SlowSurface::Feel::kSoftening}) {
    for (const double speed : {0.01, 0.05, 0.2, 1.0}) {
      for (int phase = 0; phase < 8; ++phase) {
        SlowSide slow({.feel = feel}, phase / 8.0);
        auto touch = ModelTouch::make(slow.slot, {.stiffness_max = 2000, .power = 0});
        ASSERT_TRUE(touch);
        driver::DeviceState state;
        state.dt = 1e-3;
        double given = 0, taken = 0;
        Vector3d before(0, 0, 0);
        const int half = static_cast<int>(0.003 / speed * 1e3);
        for (int k = -60; k < 2 * half + 60; ++k) {
          state.time_ns += 1'000'000;
          const double depth = 0.003 - std::min(0.006, speed * 1e-3 * std::abs(k - half));
          const Vector3d way = at_depth(depth) - state.p_WT;
          state.p_WT = at_depth(depth);
          slow.tick(state);
          const Vector3d force = (*touch)->update(state).f_T_W;
          const double work = k > -60 ? 0.5 * (before + force).dot(way) : 0;
          given += work;
          taken = std::max(taken, -given);
          before = force;
        }
        // This test's sum has an error of one tick when a model arrives.
        EXPECT_LE(given, 0.003 * taken) << static_cast<int>(feel) << " " << speed << " " << phase;
        min_share = std::min(min_share, 1 + given / taken);
      }
    }
  }
  EXPECT_GT(min_share, 0.8);  // and lateness causes no additional loss
}

TEST(ModelTouch, SurfaceBehindTheTipBeginsAtTheTip) {
  Tip tip({.stiffness_max = 2000, .power = 0});
  tip.to(at_depth(0.002));
  ASSERT_TRUE(tip.slot.publish(plane()));
  // A hand that does nothing receives no force at any time.
  EXPECT_EQ(tip.stay(100).f_T_W, Vector3d::Zero());
  // A tip that presses on is pushed back from there. A tip that moves out is followed, and then
  // pushed from the outermost place.
  EXPECT_NEAR(tip.to(at_depth(0.0025)).f_T_W.z(), 800 * 0.0005, 1e-6);
  EXPECT_EQ(tip.to(at_depth(0.001)).f_T_W, Vector3d::Zero());
  EXPECT_NEAR(tip.to(at_depth(0.002)).f_T_W.z(), 800 * 0.001, 1e-6);
  // With a small power it returns to the model's surface over time.
  Tip helped({.stiffness_max = 2000, .power = 0.001});
  helped.to(at_depth(0.002));
  for (int k = 0; k < 4000; ++k) {
    if (k % 17 == 0) {
      ASSERT_TRUE(helped.slot.publish(plane(800, helped.state.time_ns)));
    }
    helped.to(at_depth(0.002));
  }
  EXPECT_NEAR(helped.felt.f_T_W.z(), 1.6, 0.01);
}

TEST(ModelTouch, HoldsThenFadesAModelAndReportsIt) {
  Tip tip;
  EXPECT_EQ(tip.touch->age(), ModelAge::kNothing);
  ASSERT_TRUE(tip.slot.publish(plane()));
  tip.to(at_depth(-0.001));
  tip.to(at_depth(0.002));
  EXPECT_EQ(tip.touch->age(), ModelAge::kFollowed);
  tip.stay(200);  // a frame drop of 200 ms
  EXPECT_EQ(tip.touch->age(), ModelAge::kHeld);
  EXPECT_NEAR(tip.felt.f_T_W.z(), 1.6, 1e-9);
  EXPECT_NEAR(tip.to(at_depth(0.003)).f_T_W.z(), 2.4, 1e-9);  // the plane is held, not the force
  double before = tip.stay(47).f_T_W.z();
  EXPECT_NEAR(before, 2.4, 1e-9);
  for (int k = 0; k < 251; ++k) {
    const double now = tip.stay(1).f_T_W.z();
    EXPECT_LE(now, before);
    EXPECT_LE(before - now, 2.4 * 0.0041);
    before = now;
  }
  EXPECT_EQ(tip.touch->age(), ModelAge::kSilent);
  EXPECT_EQ(tip.felt.f_T_W, Vector3d::Zero());
  EXPECT_EQ(tip.touch->counters().faded, 1u);
  EXPECT_EQ(name(tip.touch->age()), "silent");
  EXPECT_EQ(tip.to(at_depth(0.005)).f_T_W, Vector3d::Zero());
  // Models arrive again: the tip is not thrown out.
  ASSERT_TRUE(tip.slot.publish(plane(800, tip.state.time_ns)));
  EXPECT_LE(tip.stay(1).f_T_W.z(), 0.0031);
  EXPECT_EQ(tip.touch->age(), ModelAge::kFollowed);
}

TEST(ModelTouch, LimitsAModelThatIsTooStiff) {
  Tip tip({.stiffness_max = 500});
  LocalModel model = plane(5000);
  model.p_WR = at_depth(0.001);
  model.f_T_W = {0, 0, 5};
  ASSERT_TRUE(tip.slot.publish(model));
  EXPECT_EQ(tip.to(at_depth(-0.0001)).f_T_W, Vector3d::Zero());
  EXPECT_NEAR(tip.to(at_depth(0.002)).f_T_W.z(), 500 * 0.002, 1e-9);
  EXPECT_EQ(tip.touch->counters().softened, 1u);
}

TEST(ModelTouch, RefusesInvalidModelsWithAReason) {
  struct Case {
    ModelFlaw flaw;
    const char* word;
    LocalModel model;
  };
  std::vector<Case> cases;
  const auto add = [&cases](ModelFlaw flaw, const char* word, auto spoil) {
    cases.push_back({flaw, word, plane()});
    spoil(cases.back().model);
  };
  add(ModelFlaw::kNotFinite, "NaN", [](LocalModel& m) { m.f_T_W.x() = kNan; });
  add(ModelFlaw::kNotFinite, "NaN", [](LocalModel& m) { m.stiffness(1, 2) = kNan; });
  add(ModelFlaw::kNotFinite, "NaN", [](LocalModel& m) { m.damping = kNan; });
  add(ModelFlaw::kNormal, "unit", [](LocalModel& m) { m.n_W *= 2; });
  add(ModelFlaw::kNotSymmetric, "symmetric", [](LocalModel& m) { m.stiffness(0, 1) = 100; });
  add(ModelFlaw::kNegativeStiffness, "eigenvalue", [](LocalModel& m) { m.stiffness(0, 0) = -1; });
  add(ModelFlaw::kNegativeDamping, "damping", [](LocalModel& m) { m.damping = -1; });
  add(ModelFlaw::kNoSurface, "n_W", [](LocalModel& m) { m.n_W = Vector3d::UnitX(); });
  add(ModelFlaw::kNoSurface, "n_W", [](LocalModel& m) {
    m.stiffness.setZero();
    m.f_T_W.z() = 1;
  });
  ModelSlot slot;
  for (const Case& one : cases) {
    EXPECT_EQ(flaw_of(one.model), one.flaw);
    const auto published = slot.publish(one.model);
    ASSERT_FALSE(published);
    EXPECT_NE(published.error().message.find(one.word), std::string::npos)
        << published.error().message;
  }
  EXPECT_EQ(slot.count(), 0u);
  EXPECT_TRUE(slot.publish(plane()));
  LocalModel nothing;  // nothing is near: also a model
  EXPECT_TRUE(slot.publish(nothing));
}

TEST(ModelTouch, RefusesFutureAndPastTimes) {
  Tip tip;
  tip.to(at_depth(-0.001));
  tip.stay(100);
  ASSERT_TRUE(tip.slot.publish(plane(800, 500'000'000)));
  tip.to(at_depth(0.001));
  EXPECT_EQ(tip.touch->counters().refused, 1u);
  EXPECT_EQ(tip.felt.f_T_W, Vector3d::Zero());
  ASSERT_TRUE(tip.slot.publish(plane(800, 50'000'000)));
  tip.to(at_depth(-0.001));
  tip.to(at_depth(0.001));
  EXPECT_EQ(tip.touch->counters().taken, 1u);
  ASSERT_TRUE(tip.slot.publish(plane(100, 40'000'000)));  // superseded by a newer one
  EXPECT_NEAR(tip.to(at_depth(0.002)).f_T_W.z(), 1.6, 1e-9);
  EXPECT_EQ(tip.touch->counters().refused, 2u);
}

TEST(ModelTouch, KeepsItsStateOverAnInvalidTip) {
  Tip tip;
  ASSERT_TRUE(tip.slot.publish(plane()));
  tip.to(at_depth(-0.001));
  tip.to(at_depth(0.001));
  driver::DeviceState lost = tip.state;
  lost.p_WT.y() = kNan;
  EXPECT_EQ(tip.touch->update(lost).f_T_W, Vector3d::Zero());
  lost = tip.state;
  lost.v_WT.y() = kNan;
  EXPECT_EQ(tip.touch->update(lost).f_T_W, Vector3d::Zero());
  EXPECT_NEAR(tip.to(at_depth(0.0015)).f_T_W.z(), 1.2, 1e-9);
}

TEST(ModelTouch, RefusesInvalidSettings) {
  ModelSlot slot;
  const auto refused = [&slot](ModelTouchSettings settings, const std::string& word) {
    const auto made = ModelTouch::make(slot, settings);
    ASSERT_FALSE(made) << word;
    EXPECT_NE(made.error().message.find("::" + word + " "), std::string::npos)
        << made.error().message;
  };
  refused({}, "stiffness_max");
  refused({.stiffness_max = kNan}, "stiffness_max");
  refused({.stiffness_max = 1000, .jump = 0}, "jump");
  refused({.stiffness_max = 1000, .min_jump = 0}, "min_jump");
  refused({.stiffness_max = 1000, .late = 1}, "late");
  refused({.stiffness_max = 1000, .hold = kNan}, "hold");
  refused({.stiffness_max = 1000, .fade = 0}, "fade");
  refused({.stiffness_max = 1000, .power = -1}, "power");
  refused({.stiffness_max = 1000, .reserve = -1}, "reserve");
}

TEST(ModelTouch, DoesNotAllocate) {
  Tip tip;
  support::Random random(3);
  int calls = 0;
  for (int k = 0; k < 500; ++k) {
    if (k % 17 == 0) {
      ASSERT_TRUE(tip.slot.publish(any_model(random, tip.state.p_WT, tip.state.time_ns)));
    }
    const Vector3d p_W = 0.002 * Vector3d(std::sin(0.02 * k), std::cos(0.03 * k), 0);
    calls += support::heap_calls_of([&] { tip.to(p_W); });
  }
  EXPECT_EQ(calls, 0);
}

TEST(ModelTouch, ModelsOfAnotherThreadAreNeverTorn) {
  // The writer's models are planes whose force and stiffness match: a mixture of two would have
  // another surface.
  ModelSlot slot;
  std::atomic<bool> over{false};
  std::thread writer([&] {
    for (std::int64_t k = 1; k <= 3000; ++k) {
      LocalModel model = plane(static_cast<double>(100 + k % 100), k);
      model.p_WR = at_depth(0.001 * static_cast<double>(k % 7));
      model.f_T_W.z() = model.stiffness(2, 2) * -model.p_WR.z();
      EXPECT_TRUE(slot.publish(model));
    }
    over = true;
  });
  LocalModel seen;
  std::int64_t last = 0;
  while (true) {
    const bool ends = over;
    if (slot.newest(seen)) {
      EXPECT_EQ(seen.f_T_W.z(), seen.stiffness(2, 2) * -seen.p_WR.z());
      EXPECT_GE(seen.time_ns, last);
      last = seen.time_ns;
    }
    if (ends) break;
  }
  writer.join();
  EXPECT_EQ(last, 3000);
}

TEST(LocalModel, WhatPushesAwayIsTakenOutOfAStiffness) {
  support::Random random(4);
  for (int i = 0; i < 100; ++i) {
    Matrix3d K;
    for (int k = 0; k < 9; ++k) K(k) = random.uniform(-1000, 1000);
    LocalModel model = plane();
    model.stiffness = without_negative(K) + plane().stiffness;
    EXPECT_EQ(flaw_of(model), ModelFlaw::kNone);
    const Matrix3d good = K * K.transpose() / 1000;
    EXPECT_LE((without_negative(good) - good).norm(), 1e-9 * good.norm());
  }
}

}  // namespace
}  // namespace thimble::render
