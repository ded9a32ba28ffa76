#include "track/god_object.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <numbers>

#include "god_object_shapes.h"
#include "support/heap_guard.h"
#include "support/seed.h"
#include "thimble/render/mesh/mesh_file.h"
#include "thimble/render/object_touch.h"
#include "thimble/render/surface/spring_damper.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;
using support::move;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// Splits triangles at points very close to one of their edges: slivers of 1e-11 of their length.
TriangleMesh with_slivers(TriangleMesh mesh) {
  const std::size_t count = mesh.triangles.size();
  for (std::size_t t = 0; t < count; t += 3) {
    const auto [a, b, c] = mesh.triangles[t];
    const auto at = [&mesh](std::int32_t v) { return mesh.vertices[static_cast<std::size_t>(v)]; };
    const Vector3d p = 0.4 * at(a) + 0.6 * at(b) + 1e-11 * (at(c) - at(a));
    const std::int32_t v = support::add_vertex(mesh, p);
    mesh.triangles[t] = {a, b, v};
    mesh.triangles.push_back({b, c, v});
    mesh.triangles.push_back({c, a, v});
  }
  return mesh;
}

// Walks at random and checks in each tick that contact is kept while the tip is inside, that the
// proxy is outside by the exact test, and that a tip at rest changes nothing.
void expect_sound_walk(const TriangleMesh& mesh, std::uint64_t seed) {
  auto contact = GodObjectContact::build(mesh).value();
  support::RandomTip tip(support::seed_of(seed), mesh);
  const double size = tip.size();
  int touched = 0;
  const int ticks = support::length_of_run(100000, 1000000);
  for (int i = 0; i < ticks; ++i) {
    const Vector3d p_WT = tip.next();
    const ContactState state = move(contact, p_WT);
    if (contact.search().inside(p_WT)) {
      ASSERT_TRUE(state.touching) << "fell through in tick " << i;
    }
    if (!state.touching) continue;
    ++touched;
    ASSERT_FALSE(contact.search().inside(state.p_WP)) << "proxy inside in tick " << i;
    ASSERT_TRUE(state.p_WP.allFinite() && state.n_W.allFinite());
    ASSERT_GE(state.depth, -1e-12 * size);
    ASSERT_NEAR(state.n_W.norm(), 1, 1e-12);
    if (i % 8 != 0) continue;
    const auto slides = contact.counters().long_walks;
    const ContactState again = move(contact, p_WT);
    if (contact.counters().long_walks != slides || state.depth < 1e-12 * size) continue;
    ASSERT_TRUE(again.touching) << i;
    ASSERT_EQ(again.p_WP, state.p_WP) << "not settled in tick " << i;
  }
  EXPECT_GT(touched, ticks / 10);
  EXPECT_EQ(contact.counters().held, 0U);
}

TEST(GodObject, StaysOutsideAndKeepsContactOnASphere) {
  expect_sound_walk(support::icosphere(3, 0.05), 1);
}

TEST(GodObject, StaysOutsideAndKeepsContactOnATorus) {
  expect_sound_walk(support::torus(0.05, 0.02, 24, 12), 2);
}

TEST(GodObject, StaysOutsideAndKeepsContactOnBumpsAndDents) {
  expect_sound_walk(support::bumpy_sphere(4, 0.05, 0.35, 7), 3);
}

TEST(GodObject, StaysOutsideAndKeepsContactOnSlivers) {
  expect_sound_walk(with_slivers(support::bumpy_sphere(2, 0.05, 0.35, 7)), 4);
}

TEST(GodObject, StaysOutsideAndKeepsContactOnANeedleAndAWedge) {
  expect_sound_walk(support::needle(64, 0.1, 0.004), 5);
  expect_sound_walk(support::wedge(5 * std::numbers::pi / 180, 0.1, 0.04), 6);
}

TEST(GodObject, StaysOutsideAndKeepsContactOnTheElephant) {
  const auto file = std::filesystem::path(THIMBLE_MESHES) / "elephant.off";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "Needs the scanned meshes";
  const TriangleMesh elephant = load_mesh(file).value();
  expect_sound_walk(elephant, 7);
}

TEST(GodObject, RestsAtALocallyClosestPoint) {
  // Reference for the triangles that hold the proxy: a slow search; the path to the tip must begin
  // in the material.
  const TriangleMesh mesh = support::bumpy_sphere(2, 0.05, 0.35, 7);
  auto contact = GodObjectContact::build(mesh).value();
  support::RandomTip tip(support::seed_of(12), mesh);
  int asked = 0;
  for (int i = 0; i < 6000; ++i) {
    const Vector3d p_WT = tip.next();
    const ContactState& state = move(contact, p_WT);
    if (!state.touching || state.depth < 1e-4) continue;
    ++asked;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const Vector3d& a = support::corner(mesh, t, 0);
      const Vector3d& b = support::corner(mesh, t, 1);
      const Vector3d& c = support::corner(mesh, t, 2);
      if ((support::nearest_on_triangle(state.p_WP, a, b, c) - state.p_WP).norm() > 1e-12) continue;
      const double nearest = (support::nearest_on_triangle(p_WT, a, b, c) - p_WT).norm();
      ASSERT_GE(nearest, state.depth - 1e-11) << i;
    }
    ASSERT_TRUE(support::is_inside(mesh, state.p_WP - 1e-6 * state.n_W)) << i;
  }
  EXPECT_GT(asked, 1000);
}

TEST(GodObject, NeverPopsThroughAThinPlate) {
  // 0.2 mm thick, pressed to 5 mm with 0.3 mm of tremor, from both sides and up to 0.4 mm from the
  // rim.
  const double half = 0.05;
  for (const double side : {1.0, -1.0}) {
    auto contact = GodObjectContact::build(support::plate(2 * half, 0.0002, 10)).value();
    support::Random random(20);
    const int presses = support::length_of_run(300, 3000);
    for (int press = 0; press < presses; ++press) {
      const double edge =
          press % 2 == 0 ? half - 0.0008 : random.uniform(-0.9 * half, half - 0.0008);
      const double along = random.uniform(-0.9 * half, 0.9 * half);
      const Vector3d place = press % 4 < 2 ? Vector3d(edge, along, 0) : Vector3d(along, edge, 0);
      move(contact, place + Vector3d(0, 0, side * 0.002));
      for (int i = 0; i <= 200; ++i) {
        const double depth = 0.005 * std::sin(std::numbers::pi * i / 200);
        Vector3d p_WT = place + 0.0003 * random.direction();
        p_WT.x() = std::min(p_WT.x(), half - 0.0004);
        p_WT.y() = std::min(p_WT.y(), half - 0.0004);
        p_WT.z() -= side * depth;
        const ContactState& state = move(contact, p_WT);
        const double below = 0.0001 - side * p_WT.z();
        if (!(below > 1e-9)) continue;
        ASSERT_TRUE(state.touching) << "press " << press << " tick " << i;
        ASSERT_LT((state.n_W - Vector3d(0, 0, side)).norm(), 1e-9) << "press " << press;
        ASSERT_NEAR(state.depth, below, 1e-12);
        ASSERT_LT((state.p_WP - Vector3d(p_WT.x(), p_WT.y(), side * 0.0001)).norm(), 1e-12);
      }
      move(contact, place + Vector3d(0, 0, side * 0.002));
      ASSERT_FALSE(contact.state().touching);
    }
  }
}

TEST(GodObject, GoesRoundTheRimOfAPlateOnlyWithTheTip) {
  auto contact = GodObjectContact::build(support::plate(0.1, 0.0002, 10)).value();
  move(contact, {0.049, 0.001, 0.001});
  ASSERT_TRUE(move(contact, {0.049, 0.001, -0.004}).touching);
  ASSERT_TRUE(move(contact, {0.04999, 0.001, -0.004}).touching);
  EXPECT_FALSE(move(contact, {0.0501, 0.001, -0.004}).touching);
  EXPECT_FALSE(move(contact, {0.049, 0.001, -0.004}).touching);
}

TEST(GodObject, CatchesAFastTipInAThinPlateAtEveryPhase) {
  // 2 m/s at 1 kHz: 2 mm per tick through 1 mm.
  auto contact = GodObjectContact::build(support::plate(0.1, 0.001, 8)).value();
  for (int phase = 0; phase < 10000; ++phase) {
    move(contact, {kNaN, 0, 0});
    const double start = 0.01 + 0.002 * phase / 10000;
    for (int tick = 0; tick < 12; ++tick) {
      const double z = start - 0.002 * tick;
      const ContactState& state = move(contact, {0.003, 0.002, z});
      ASSERT_EQ(state.touching, z < 0.0005) << "phase " << phase << " z " << z;
      if (!state.touching) continue;
      ASSERT_EQ(state.n_W, Vector3d(0, 0, 1)) << "phase " << phase << " z " << z;
    }
  }
}

TEST(GodObject, DirectionTurnsWithTheFacesOfASphere) {
  const TriangleMesh sphere = support::icosphere(4, 0.05);
  auto contact = GodObjectContact::build(sphere).value();
  double bend = 0;
  for (std::int32_t t = 0; t < contact.mesh().triangle_count(); ++t) {
    for (const std::int32_t other : contact.mesh().cell(t).neighbours) {
      bend = std::max(bend, (support::outward_normal(sphere, static_cast<std::size_t>(t)) -
                             support::outward_normal(sphere, static_cast<std::size_t>(other)))
                                .norm());
    }
  }
  move(contact, {0.06, 0, 0});
  Vector3d n_before(0, 0, 0);
  int hops = 0;
  for (int i = 0; i < 20000; ++i) {
    const double u = 3e-3 * i, v = 0.4 * std::sin(7e-4 * i);
    const Vector3d p_WT =
        0.0485 * Vector3d(std::cos(u) * std::cos(v), std::sin(u) * std::cos(v), std::sin(v));
    const ContactState& state = move(contact, p_WT);
    ASSERT_TRUE(state.touching) << i;
    // A hop over a vertex turns by at most two bends.
    if (i > 0) {
      ASSERT_LE((state.n_W - n_before).norm(), 2 * state.hops * bend + 1e-9) << i;
    }
    n_before = state.n_W;
    hops += state.hops;
  }
  EXPECT_GT(hops, 1000);
}

TEST(GodObject, LongSlideContinuesInLaterTicks) {
  // A proxy that is pushed past the middle of a fine sphere in one tick slips around to the far
  // side.
  auto contact = GodObjectContact::build(support::icosphere(7, 0.05)).value();
  const Vector3d p_WT(-0.04, 1e-4, 2e-4);
  move(contact, {0.06, 1e-4, 2e-4});
  double distance = 1;
  for (int tick = 0; tick < 10; ++tick) {
    const ContactState& state = move(contact, p_WT);
    ASSERT_TRUE(state.touching);
    ASSERT_FALSE(contact.search().inside(state.p_WP));
    ASSERT_LE(state.depth, distance);
    distance = state.depth;
  }
  EXPECT_GT(contact.counters().long_walks, 0U);
  EXPECT_NEAR(distance, 0.01, 1e-5);
}

// Strokes a mesh and its scaled and moved copy along the same path and compares every tick.
void expect_same_answers(const TriangleMesh& base, double scale, double offset) {
  const double size = 0.1;
  const Vector3d shift(offset, -offset, offset);
  auto reference = GodObjectContact::build(base).value();
  auto copy =
      GodObjectContact::build(placed(base, scale, Eigen::Matrix3d::Identity(), shift)).value();
  // Fixed seed: near an edge, rounding of a place may decide where a proxy goes.
  support::Random random(std::uint64_t{9});
  Vector3d p(0.08, 0, 0);
  int touched = 0;
  for (int i = 0; i < 20000; ++i) {
    p = 0.99 * p + random.in_box(0.006);
    const ContactState& wanted = move(reference, p);
    const ContactState& found = move(copy, scale * p + shift);
    ASSERT_EQ(found.touching, wanted.touching) << "tick " << i << " scale " << scale;
    if (!wanted.touching) continue;
    ASSERT_NEAR(found.depth / scale, wanted.depth, 1e-9 * size) << "tick " << i;
    ASSERT_LT(((found.p_WP - shift) / scale - wanted.p_WP).norm(), 1e-9 * size) << "tick " << i;
    ++touched;
  }
  EXPECT_GT(touched, 1000);
}

TEST(GodObject, GivesTheSameAnswersAtEveryScale) {
  for (const double scale : {1e-6, 1e3}) {
    expect_same_answers(support::bumpy_sphere(3, 0.05, 0.3, 6), scale, 0);
    expect_same_answers(support::block_around(support::box({0.03, 0.03, 0.03}), 0.05), scale, 0);
    expect_same_answers(with_slivers(support::bumpy_sphere(2, 0.05, 0.3, 6)), scale, 0);
  }
}

TEST(GodObject, GivesTheSameAnswersFarFromTheOrigin) {
  // Vertices are rounded to 2e-12 m there: thinner slivers would be other shapes.
  expect_same_answers(support::bumpy_sphere(3, 0.05, 0.3, 6), 1, 1e4);
  expect_same_answers(support::block_around(support::box({0.03, 0.03, 0.03}), 0.05), 1, 1e4);
}

TEST(GodObject, StartInsideIsNotContact) {
  auto contact = GodObjectContact::build(support::box({1, 1, 1})).value();
  EXPECT_FALSE(move(contact, {0, 0.1, 0.2}).touching);
  EXPECT_FALSE(move(contact, {0, 0.1, 0.9}).touching);
  EXPECT_FALSE(move(contact, {0, 0.1, 1.1}).touching);
  EXPECT_TRUE(move(contact, {0, 0.1, 0.9}).touching);
}

TEST(GodObject, EndsContactForAPositionThatIsNaN) {
  auto contact = GodObjectContact::build(support::box({1, 1, 1})).value();
  move(contact, {0.1, 0.2, 1.1});
  EXPECT_TRUE(move(contact, {0.1, 0.2, 0.9}).touching);
  EXPECT_FALSE(move(contact, {0.1, kNaN, 0.9}).touching);
  EXPECT_FALSE(move(contact, {0.1, 0.2, 0.9}).touching);
  move(contact, {0.1, 0.2, 1.1});
  EXPECT_TRUE(move(contact, {0.1, 0.2, 0.9}).touching);
}

TEST(GodObject, DoesNotAllocate) {
  const TriangleMesh mesh = support::bumpy_sphere(3, 0.05, 0.35, 7);
  auto contact = GodObjectContact::build(mesh).value();
  support::RandomTip tip(support::seed_of(40), mesh);
  const int calls = support::heap_calls_of([&] {
    for (int i = 0; i < 20000; ++i) move(contact, tip.next());
  });
  EXPECT_EQ(calls, 0);
}

TEST(GodObject, TakesTheContactStageOfTouch) {
  ContactForceLaw<GodObjectContact, SpringDamper> touch(
      GodObjectContact::build(support::box({1, 1, 1})).value(), {.stiffness = 500, .damping = 0});
  driver::DeviceState state;
  state.p_WT = {0.1, 0.2, 1.1};
  EXPECT_EQ(touch(state).f_T_W, Vector3d(0, 0, 0));
  state.p_WT = {0.1, 0.2, 0.99};
  const driver::ForceCommand command = touch(state);
  EXPECT_TRUE(command.touch.in_contact);
  EXPECT_LT((command.f_T_W - Vector3d(0, 0, 5)).norm(), 1e-9);
}

}  // namespace
}  // namespace thimble::render
