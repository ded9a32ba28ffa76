#include "track/packed_contact_in_memory.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <numbers>
#include <vector>

#include "support/heap_guard.h"
#include "support/long_form.h"
#include "support/meshes/bench_meshes.h"
#include "support/meshes/shapes.h"
#include "support/random.h"
#include "support/seed.h"
#include "thimble/render/mesh/mesh_file.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

int scaled(int full, int brief) {
  return support::long_form() ? full : brief;
}

const ContactState& move(InMemoryContact& contact, const Vector3d& p_WT) {
  driver::DeviceState state;
  state.p_WT = p_WT;
  return contact.update(state);
}

// Moves the tip from outside along `n` to `p`. A tip that jumps there through the body is followed
// over a bounded number of triangles per tick, and released when it is found to be outside.
void enter(InMemoryContact& contact, const Vector3d& p, const Vector3d& n, double reach) {
  for (int tick = 0; tick < 10 && move(contact, p + reach * n).touching; ++tick) continue;
  move(contact, p);
}

// Moves randomly over directions in steps of an angle.
class Wanderer {
 public:
  Wanderer(std::uint64_t seed, double step) : random_(seed), step_(step) {}
  const Vector3d& next() {
    way_ = (way_ + 0.1 * random_.direction()).normalized();
    at_ = (at_ + step_ * at_.cross(way_).normalized()).normalized();
    return at_;
  }
  const Vector3d& at() const { return at_; }

 private:
  support::Random random_;
  double step_;
  Vector3d at_{0.3, 0.5, 0.81};
  Vector3d way_{0.1, -0.9, 0.2};
};

TEST(InMemoryContact, MeasuresCoarseSpheresExactly) {
  for (int level = 2; level <= 5; ++level) {
    InMemoryContact contact = InMemoryContact::build(support::icosphere(level, 0.03)).value();
    Wanderer tip(support::seed_of(static_cast<std::uint64_t>(level)), 0.01);
    enter(contact, 0.029 * tip.at(), tip.at(), 0.01);
    for (int i = 0; i < 20000; ++i) {
      const Vector3d& u = tip.next();
      const ContactState& state = move(contact, 0.029 * u);
      ASSERT_TRUE(state.touching);
      // Less than a tenth of the sagitta remains: averages of faces are not exactly radial.
      ASSERT_NEAR(state.depth, 0.001, 3e-5 * std::pow(0.25, level - 2) + 3e-7) << "level " << level;
      ASSERT_LT(std::acos(std::min(1.0, state.n_W.dot(u))), 0.025 * std::pow(0.5, level - 2));
      ASSERT_LT((state.p_WP - (0.029 * u + state.depth * state.n_W)).norm(), 1e-15);
    }
  }
}

TEST(InMemoryContact, BulgeBeginsAndEndsWithoutAJump) {
  const InMemoryContact untouched = InMemoryContact::build(support::icosphere(2, 0.03)).value();
  ASSERT_GT(untouched.surface().rise(), 2e-4);
  support::Random random(17);
  for (int press = 0; press < 200; ++press) {
    const Vector3d u = random.direction();
    InMemoryContact contact = untouched;
    double before = 0;
    constexpr double kStep = 2e-6;  // m
    // Down from 0.1 mm above the ball to 0.6 mm below it and up again.
    for (int i = -50; i <= 650; ++i) {
      const double below = kStep * (i <= 300 ? i : 600 - i);
      const ContactState& state = move(contact, (0.03 - below) * u);
      const double depth = state.touching ? state.depth : 0;
      ASSERT_LT(std::abs(depth - before), 1.1 * kStep) << press << " at " << below;
      ASSERT_NEAR(depth, std::max(below, 0.0), 4e-5) << press;
      before = depth;
    }
    ASSERT_FALSE(contact.state().touching);
  }
}

// A scene may name no smoothing, so even the edges of 20 triangles are not creases.
TEST(InMemoryContact, BallOf20TrianglesIsFeltOutside) {
  constexpr double kBall = 0.05;
  const TriangleMesh ball = support::icosphere(0, kBall);
  InMemoryContact contact = InMemoryContact::build(ball).value();
  const auto corner = [&](std::size_t k) {
    return ball.vertices[static_cast<std::size_t>(ball.triangles[0][k])];
  };
  const Vector3d middle = (corner(0) + corner(1) + corner(2)) / 3;
  const Vector3d out = middle.normalized();
  double height = 0.02;
  while (height > -0.001 && !move(contact, middle + height * out).touching) height -= 1e-5;
  std::printf("felt %.2f mm above the triangle, of a radius of 50 mm\n", 1e3 * height);
  EXPECT_NEAR(height, kBall - middle.norm(), 0.05 * kBall);
}

TEST(InMemoryContact, BulgeReachedFromInsideIsNotContact) {
  InMemoryContact contact = InMemoryContact::build(support::icosphere(2, 0.03)).value();
  const Vector3d u = (contact.surface().position(0, 0) + contact.surface().position(0, 1) +
                      contact.surface().position(0, 2))
                         .normalized();
  for (int i = 0; i <= 1000; ++i) {
    ASSERT_FALSE(move(contact, (0.029 + 1.2e-6 * i) * u).touching) << i;
  }
  EXPECT_TRUE(move(contact, 0.0299 * u).touching);
}

TEST(InMemoryContact, TorusErrorFallsWithTheSquaredEdge) {
  const support::Ring ring;
  std::vector<double> errors;
  for (const std::size_t triangles : {1000u, 4000u, 16000u, 64000u}) {
    InMemoryContact contact = InMemoryContact::build(support::bench_ring(ring, triangles)).value();
    double sum = 0;
    constexpr int kSteps = 20000;
    for (int i = -1; i < kSteps; ++i) {
      const double around = 0.0031 * i;
      const double across = 0.0052 * i;
      const Vector3d n = ring.normal(around, across);
      const Vector3d p = ring.at(around, across) - 0.5e-3 * n;
      if (i < 0) enter(contact, p, n, 0.01);
      const ContactState& state = move(contact, p);
      ASSERT_TRUE(state.touching) << i;
      sum += std::abs(state.depth - 0.5e-3);
    }
    errors.push_back(sum / kSteps);
  }
  for (std::size_t i = 1; i < errors.size(); ++i) {
    EXPECT_GE(std::log2(errors[i - 1] / errors[i]), 1.8) << errors[i - 1] << " to " << errors[i];
  }
  EXPECT_LT(errors.back(), 1e-6);
}

TEST(InMemoryContact, IsContinuousOverEdgesAndVertices) {
  InMemoryContact contact = InMemoryContact::build(support::bumpy_sphere(3, 0.05, 0.2, 4)).value();
  // By the numbers of the input, so that the places do not depend on the order of the packed
  // triangles.
  std::vector<std::int32_t> record_of(contact.surface().triangles().size());
  for (std::int32_t t = 0; t < contact.surface().triangle_count(); ++t) {
    record_of[static_cast<std::size_t>(contact.surface().source(t))] = t;
  }
  // Through the midpoints and the corners of triangles, in steps of 1e-7 of the size.
  support::Random random(21);
  int hops = 0;
  for (int stroke = 0; stroke < scaled(2000, 200); ++stroke) {
    const std::int32_t t = record_of[random.bits() % record_of.size()];
    const std::size_t k = static_cast<std::size_t>(stroke) % 3;
    const std::size_t j = stroke % 2 == 0 ? k : (k + 1) % 3;
    const auto& packed = contact.surface().triangle(t).normals;
    const Vector3d n = (unpack_normal(packed[k]) + unpack_normal(packed[j])) / 2;
    const Vector3d way = n.cross(random.direction()).normalized();
    const Vector3d middle =
        (contact.surface().position(t, k) + contact.surface().position(t, j)) / 2 - 1e-3 * n;
    enter(contact, middle - 1e-5 * way, n, 0.002);
    ASSERT_TRUE(contact.state().touching);
    ContactState before = contact.state();
    for (int i = -999; i <= 1000; ++i) {
      constexpr double kStep = 1e-8;  // m
      const ContactState& now = move(contact, middle + i * kStep * way);
      ASSERT_TRUE(now.touching);
      // The surface is at most 1.5 times as steep as the stroke, and turns by 1 rad in 2 mm.
      ASSERT_LT(std::abs(now.depth - before.depth), 1.5 * kStep);
      ASSERT_LT((now.n_W - before.n_W).norm(), kStep / 2e-3);
      hops += now.hops;
      before = now;
    }
  }
  EXPECT_GE(hops, scaled(2000, 200));
}

TEST(InMemoryContact, NeverLosesContactOnRandomWalks) {
  for (const double step : {3e-5, 3e-4, 2e-3}) {
    InMemoryContact ball = InMemoryContact::build(support::bench_ball({}, 20000)).value();
    const support::BumpyBall truth;
    Wanderer tip(support::seed_of(31), step / truth.radius);
    enter(ball, truth.at(tip.at()) - 5e-4 * truth.normal(tip.at()), tip.at(), 0.02);
    for (int i = 0; i < scaled(1000000, 50000); ++i) {
      const Vector3d& u = tip.next();
      const ContactState& state = move(ball, truth.at(u) - 5e-4 * truth.normal(u));
      ASSERT_TRUE(state.touching) << i;
      ASSERT_NEAR(state.depth, 5e-4, 2e-5);
    }
    EXPECT_EQ(ball.counters().found_near + ball.counters().found_far, 0u);
  }
}

TEST(InMemoryContact, NeverLosesContactOnAScannedMesh) {
  const auto file = std::filesystem::path(THIMBLE_MESHES) / "elephant.off";
  if (!std::filesystem::exists(file)) {
    GTEST_SKIP() << "Needs the scanned meshes: run app/fetch_meshes.sh (it downloads them)";
  }
  InMemoryContact contact = InMemoryContact::build(load_mesh(file).value()).value();
  const PackedSurface& surface = contact.surface();
  const double size = 2 * kLatticeHalf * surface.step();
  // From triangle to triangle, a thousandth of the size deep.
  support::Random random(33);
  std::int32_t t = 0;
  int contacts = 0;
  for (int i = 0; i < scaled(100000, 20000); ++i) {
    const std::int32_t next = surface.triangle(t).neighbours[random.bits() % 3];
    const auto below = [&](std::int32_t triangle) -> Vector3d {
      const Vector3d a = surface.position(triangle, 0);
      const Vector3d b = surface.position(triangle, 1);
      const Vector3d c = surface.position(triangle, 2);
      return (a + b + c) / 3 - 1e-3 * size * (b - a).cross(c - a).normalized();
    };
    const Vector3d from = below(t);
    const Vector3d to = below(next);
    for (int part = 1; part <= 5; ++part) {
      const Vector3d p = from + part / 5.0 * (to - from);
      const bool was_touching = contact.state().touching;
      const ContactState& state = move(contact, p);
      if (was_touching && contact.search().inside(p)) {
        ASSERT_TRUE(state.touching) << i;
      }
      if (!state.touching) continue;
      ++contacts;
      ASSERT_TRUE(std::isfinite(state.depth));
      ASSERT_GE(state.depth, 0);
      ASSERT_NEAR(state.n_W.norm(), 1, 1e-12);
    }
    t = next;
  }
  EXPECT_GT(contacts, 10000);
}

TEST(InMemoryContact, GivesTheSameAnswersAtEveryScale) {
  const support::BumpyBall truth;
  const TriangleMesh base = support::bench_ball(truth, 2000);
  for (const double scale : {1e-6, 1e-3, 1e3}) {
    InMemoryContact reference = InMemoryContact::build(base).value();
    InMemoryContact variant =
        InMemoryContact::build(placed(base, scale, Eigen::Matrix3d::Identity(), Vector3d::Zero()))
            .value();
    Wanderer tip(support::seed_of(41), 0.02);
    support::Random random(42);
    int touched = 0;
    for (int i = 0; i < 20000; ++i) {
      const Vector3d p = random.uniform(0.96, 1.02) * truth.at(tip.next());
      const ContactState& wanted = move(reference, p);
      const ContactState& found = move(variant, scale * p);
      ASSERT_EQ(found.touching, wanted.touching) << i;
      ASSERT_NEAR(found.depth / scale, wanted.depth, 1e-9 * 0.1) << i;
      touched += found.touching;
    }
    EXPECT_GT(touched, 3000);
  }
}

TEST(InMemoryContact, KeepsBoxFacesExactAndTurnsAtTheirCrease) {
  InMemoryContact contact = InMemoryContact::build(support::box({0.05, 0.05, 0.05})).value();
  enter(contact, {0.03, 0.01, 0.049}, {0, 0, 1}, 0.01);
  double depth = contact.state().depth;
  for (int i = 0; i <= 4000; ++i) {
    // Along the top, then down the side; the tip stays 1 mm below both.
    const double along = 1e-5 * i;
    const bool on_top = along < 0.019;
    const Vector3d p = on_top ? Vector3d(0.03 + along, 0.01, 0.049)
                              : Vector3d(0.049, 0.01, 0.049 - (along - 0.019));
    const ContactState& state = move(contact, p);
    ASSERT_TRUE(state.touching);
    ASSERT_NEAR(state.depth, 1e-3, 1e-10) << i;
    ASSERT_LT(std::abs(state.depth - depth), 2e-10);
    if (along < 0.01899) {
      ASSERT_EQ(state.n_W, Vector3d::UnitZ());
    }
    if (along > 0.01902) {
      ASSERT_EQ(state.n_W, Vector3d::UnitX()) << i;
    }
    depth = state.depth;
  }
}

TEST(InMemoryContact, BeginsWithAnySpeedAndEndsOutside) {
  InMemoryContact contact = InMemoryContact::build(support::plate(0.1, 0.001, 10)).value();
  support::Random random(51);
  for (int i = 0; i < scaled(10000, 2000); ++i) {
    const Vector3d at{random.uniform(-0.04, 0.04), random.uniform(-0.04, 0.04), 0};
    const double above = random.uniform(1e-4, 2e-3);  // 2 m/s at 1 kHz
    move(contact, at + Vector3d(0, 0, 0.0005 + above));
    const ContactState& state = move(contact, at + Vector3d(0, 0, 0.0005 + above - 0.0025));
    ASSERT_TRUE(state.touching);
    ASSERT_NEAR(state.depth, 0.0025 - above, 1e-9);
    ASSERT_FALSE(move(contact, at + Vector3d(0, 0, 0.01)).touching);
  }
}

TEST(InMemoryContact, StartInsideOrNaNIsNotContact) {
  InMemoryContact contact = InMemoryContact::build(support::box({1, 1, 1})).value();
  EXPECT_FALSE(move(contact, {0, 0.1, 0.9}).touching);
  EXPECT_FALSE(move(contact, {0, 0.1, 1.1}).touching);
  EXPECT_TRUE(move(contact, {0, 0.1, 0.9}).touching);
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e300}) {
    EXPECT_FALSE(move(contact, {0.1, bad, 0.9}).touching);
    EXPECT_FALSE(move(contact, {0, 0.1, 0.9}).touching);
    EXPECT_FALSE(move(contact, {0, 0.1, 1.1}).touching);
    // A tip that was outside before an invalid position is not known to have entered.
    EXPECT_FALSE(move(contact, {0.1, bad, 0.9}).touching);
    EXPECT_FALSE(move(contact, {0, 0.1, 0.9}).touching);
    EXPECT_FALSE(move(contact, {0, 0.1, 1.1}).touching);
    EXPECT_TRUE(move(contact, {0, 0.1, 0.9}).touching);
  }
}

// The tick that stays in its triangle checks only by the depth that the position is within range.
TEST(InMemoryContact, EveryPositionBeyondRangeEndsContact) {
  InMemoryContact contact = InMemoryContact::build(support::icosphere(4, 0.05)).value();
  support::Random random(21);
  for (int i = 0; i < 3000; ++i) {
    const Vector3d n = random.direction();
    enter(contact, 0.049 * n, n, 0.01);
    // Some ticks at the same place, so that the contact is steady there.
    for (int k = 0; k < 3; ++k) ASSERT_TRUE(move(contact, 0.049 * n).touching);
    Vector3d far = 0.049 * n;
    const double value = i % 3 == 0   ? std::numeric_limits<double>::quiet_NaN()
                         : i % 3 == 1 ? std::numeric_limits<double>::infinity()
                                      : 2 * kPositionMax;
    if (i % 2 == 0) {
      far[i / 2 % 3] = i % 4 == 0 ? value : -value;
    } else {
      far = (i % 4 == 1 ? value : -value) * n;
    }
    ASSERT_FALSE(move(contact, far).touching) << far.transpose();
    ASSERT_FALSE(move(contact, 0.049 * n).touching) << "the next tick is a first one";
    move(contact, 0.06 * n);
  }
}

TEST(InMemoryContact, DoesNotAllocate) {
  InMemoryContact contact = InMemoryContact::build(support::bumpy_sphere(3, 0.05, 0.3, 6)).value();
  support::Random random(71);
  int touched = 0;
  const int calls = support::heap_calls_of([&] {
    for (int i = 0; i < 20000; ++i) touched += move(contact, random.in_box(0.06)).touching;
  });
  EXPECT_EQ(calls, 0);
  EXPECT_GT(touched, 1000);
  EXPECT_GT(contact.counters().found_near, 0u);
}

TEST(InMemoryContact, HopsAreBoundedAroundANeedleAndInAPlate) {
  for (const TriangleMesh& mesh : {support::needle(64, 0.08, 0.01), support::plate(0.1, 0.0002, 20),
                                   support::wedge(5 * std::numbers::pi / 180, 0.1, 0.05)}) {
    InMemoryContact contact = InMemoryContact::build(mesh).value();
    support::Random random(61);
    Vector3d p(0, 0, 0.1);
    int touched = 0, given_up = 0;
    for (int i = 0; i < scaled(200000, 20000); ++i) {
      const Vector3d target(0, 0, 0.02);
      p += 0.02 * (target - p) + random.in_box(0.004);
      const bool was_touching = contact.state().touching;
      const ContactState& state = move(contact, p);
      ASSERT_LE(state.hops, kHopsMax);
      if (state.hops == kHopsMax &&
          state.touching) {  // an abandoned walk: the closest point is searched again
        const double nearest = contact.search().closest(p, 1).distance;
        ASSERT_LE((state.p_WP - p).norm(), nearest + 1e-12) << i;
        ++given_up;
      }
      if (was_touching && contact.search().inside(p)) {
        ASSERT_TRUE(state.touching);
      }
      if (!state.touching) continue;
      ++touched;
      ASSERT_TRUE(std::isfinite(state.depth) && state.n_W.allFinite() && state.p_WP.allFinite());
    }
    EXPECT_GT(touched, 100);
    EXPECT_LT(given_up, touched / 100);
  }
}

}  // namespace
}  // namespace thimble::render
