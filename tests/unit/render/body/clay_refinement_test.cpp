// Clay that splits the triangles under a print: the mesh, the print, and the force meanwhile.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

#include "body/shape/body_shape.h"
#include "mesh/contact_mesh.h"
#include "support/heap_guard.h"
#include "support/meshes/shapes.h"
#include "support/random.h"
#include "thimble/render/build_object_touch.h"
#include "thimble/render/mesh/check_mesh.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

constexpr double kTick = 1e-3;
constexpr double kStiffness = 800;

std::unique_ptr<ObjectTouch> clay_of(const TriangleMesh& mesh, const ClayChoice& clay,
                                     TrackerChoice tracker = TrackerChoice::kGodObject) {
  ContactChoice contact;
  contact.tracker = tracker;
  const SurfaceChoice surface{.spring = {.stiffness = kStiffness, .damping = 0},
                              .shape = {.clay = clay, .snap = {}}};
  auto built = build_object_touch(mesh, contact, surface);
  EXPECT_TRUE(built) << (built ? "" : built.error().message);
  return std::move(built).value();
}

TriangleMesh now(const ObjectTouch& object) {
  TriangleMesh mesh;
  for (std::int32_t t = 0; t < object.mesh()->triangle_count(); ++t) {
    mesh.triangles.push_back(object.mesh()->corners(t));
  }
  mesh.vertices.resize(static_cast<std::size_t>(object.mesh()->vertex_count()));
  object.mesh_now(mesh.vertices, mesh.triangles);
  return mesh;
}

/// Moves the tip to a place for one tick.
class Tip {
 public:
  explicit Tip(ObjectTouch& object) : object_(object) {}
  driver::ForceCommand at(const Vector3d& p) {
    state_.v_WT = tick_ > 0 ? Vector3d((p - state_.p_WT) / kTick) : Vector3d::Zero();
    state_.dt = kTick;
    state_.p_WT = p;
    state_.tick = tick_++;
    return object_.update(state_);
  }

 private:
  ObjectTouch& object_;
  driver::DeviceState state_;
  std::uint64_t tick_ = 0;
};

/// Presses a plate of `cells` x `cells` squares of 10 mm in its middle. Returns the deviation of
/// its top from the requested print, as a fraction of its depth: maximum and RMS.
struct PrintError {
  double most = 0, mean = 0;
  std::int32_t triangles = 0;
};

PrintError print_error(double radius, double edge, const Vector3d& aside) {
  constexpr double kSide = 0.1, kThick = 0.04;
  auto object = clay_of(support::plate(kSide, kThick, 10),
                        {.yield_force = 0.5, .radius = radius, .edge = edge});
  Tip tip(*object);
  const double top = kThick / 2;
  const Vector3d place = aside + Vector3d(0, 0, top);
  tip.at(place + Vector3d(0, 0, 1e-3));
  const double depth = 0.2 * radius + 0.5 / kStiffness;
  // The finger first rests for a moment, so that all triangles are split before anything flows.
  for (int i = 0; i < 600; ++i) tip.at(place - Vector3d(0, 0, 0.45 / kStiffness));
  constexpr int kTicks = 500;
  for (int i = 0; i <= kTicks; ++i) {
    tip.at(place - Vector3d(0, 0, 0.45 / kStiffness + (depth - 0.45 / kStiffness) * i / kTicks));
  }
  for (int i = 0; i < 200 || !object->shape()->settled(); ++i) {
    tip.at(place - Vector3d(0, 0, depth));
  }
  const double set = depth - 0.5 / kStiffness;
  const TriangleMesh mesh = now(*object);
  PrintError error{.triangles = object->mesh()->triangle_count()};
  double squares = 0, count = 0;
  for (const auto& corners : mesh.triangles) {
    const auto p = [&](std::size_t k) {
      return mesh.vertices[static_cast<std::size_t>(corners[k])];
    };
    // Pressed vertices move straight down, so their horizontal position is the original one.
    const double side =
        std::max({(p(1) - p(0)).norm(), (p(2) - p(1)).norm(), (p(0) - p(2)).norm()});
    const int fine = std::clamp(static_cast<int>(30 * side / radius), 2, 30);
    for (int n = 0; n < (fine + 1) * (fine + 2) / 2; ++n) {
      // Places in rows over the triangle, including its corners and edges.
      int row = 0, left = n;
      while (left > row) left -= ++row;
      const Vector3d w = Vector3d(fine - row, row - left, left) / fine;
      const Vector3d at = w[0] * p(0) + w[1] * p(1) + w[2] * p(2);
      if (at.z() < 0) continue;
      const double s = (at - place).head<2>().squaredNorm() / (radius * radius);
      if (s > 1.5) continue;
      const double asked = s < 1 ? set * (1 - s) * (1 - s) : 0;
      const double off = std::abs(at.z() - (top - asked)) / set;
      error.most = std::max(error.most, off);
      squares += off * off;
      ++count;
    }
  }
  error.mean = std::sqrt(squares / count);
  return error;
}

// Triangles of 10 mm, prints 1, 2, 3 and 5 times as wide, at two places.
TEST(ClayRefinement, MakesTheRequestedPrintOnAnyMesh) {
  for (const double widths : {1.0, 2.0, 3.0, 5.0}) {
    const double radius = widths * 0.01 / 2;
    for (const Vector3d& aside : {Vector3d(0.0033, 0.0017, 0), Vector3d(1e-4, 2e-4, 0)}) {
      const PrintError coarse = print_error(radius, 0, aside);
      const PrintError medium = print_error(radius, radius / 8, aside);
      const PrintError fine = print_error(radius, radius / 16, aside);
      std::printf(
          "%.0f triangles wide: %.1f %% at most, mean %.2f %%; r / 8: %.2f, %.3f (%d "
          "triangles); r / 16: %.3f, %.3f (%d)\n",
          widths, 100 * coarse.most, 100 * coarse.mean, 100 * medium.most, 100 * medium.mean,
          medium.triangles, 100 * fine.most, 100 * fine.mean, fine.triangles);
      EXPECT_LT(fine.most, 0.005);
      EXPECT_LT(medium.mean, 0.0025);
      EXPECT_LT(medium.most, 1. / 64);
      EXPECT_LT(fine.most, 0.5 * medium.most);
    }
  }
}

// A furrow as deep as it is wide, drawn back and forth: its walls are steep, and unlimited
// splitting would use up all triangles.
TEST(ClayRefinement, SplitsWallsNoFinerThanTheFloor) {
  constexpr double kEdge = 0.7e-3, kTop = 0.02;
  auto object = clay_of(support::plate(0.1, 0.04, 10),
                        {.yield_force = 0.5, .radius = 4e-3, .edge = kEdge, .triangles = 100000});
  Tip tip(*object);
  for (int i = -200; i < 400; ++i) tip.at({-0.01, 0.002, kTop - std::max(i, -20) * 1e-5});
  for (int i = 0; i < 4000; ++i) {
    const double x = 0.01 * std::cos(std::numbers::pi * (1 + i / 1000.0));
    tip.at({x, 0.002 + 0.1 * x, kTop - 4e-3});
  }
  const TriangleMesh mesh = now(*object);
  double lowest = kTop, shortest = 1, longest = 0, steepest = 0;
  for (const auto& corners : mesh.triangles) {
    const auto p = [&](std::size_t k) -> const Vector3d& {
      return mesh.vertices[static_cast<std::size_t>(corners[k % 3])];
    };
    const Vector3d middle = (p(0) + p(1) + p(2)) / 3;
    if (middle.z() < 0 || middle.head<2>().cwiseAbs().maxCoeff() > 0.045) continue;
    lowest = std::min(lowest, middle.z());
    for (std::size_t k = 0; k < 3; ++k) {
      // Pressed vertices move straight down: seen from above, the mesh is unchanged.
      const Vector3d side = p(k + 1) - p(k);
      shortest = std::min(shortest, side.head<2>().norm());
      steepest = std::max(steepest, std::abs(side.z()) / side.head<2>().norm());
      if (std::abs(middle.x()) < 0.01 && std::abs(middle.y() - 0.002) < 0.004) {
        longest = std::max(longest, side.head<2>().norm());
      }
    }
  }
  std::printf("%.1f mm deep, slope %.1f at most: %zu triangles, edges of %.2f to %.2f mm\n",
              1e3 * (kTop - lowest), steepest, mesh.triangles.size(), 1e3 * shortest,
              1e3 * longest);
  EXPECT_LT(lowest, kTop - 3e-3);
  EXPECT_GT(steepest, 2);
  EXPECT_LE(longest, kEdge);
  EXPECT_GT(shortest, 0.4 * kEdge);
  EXPECT_LT(mesh.triangles.size(), 9000U);
}

struct Difference {
  double most = 0;                  // difference of a force from that of the unsplit mesh, N
  double step = 0, step_whole = 0;  // largest changes of the forces in a tick, N
  std::int32_t split = 0;
};

// A stroke that presses with less than the yield force, so that splitting is the only change.
template <class Path>
Difference felt_by_splitting(const TriangleMesh& mesh, Path path) {
  const ClayChoice plain{.yield_force = 3, .radius = 0.006};
  ClayChoice split = plain;
  split.edge = plain.radius / 8;
  auto object = clay_of(mesh, split);
  auto whole = clay_of(mesh, plain);
  Tip tip(*object), other(*whole);
  Difference difference;
  Vector3d before(0, 0, 0), before_whole(0, 0, 0);
  for (int i = 0; i < 4000; ++i) {
    const Vector3d f = tip.at(path(i)).f_T_W, f_whole = other.at(path(i)).f_T_W;
    difference.most = std::max(difference.most, (f - f_whole).norm());
    difference.step = std::max(difference.step, (f - before).norm());
    difference.step_whole = std::max(difference.step_whole, (f_whole - before_whole).norm());
    before = f;
    before_whole = f_whole;
  }
  EXPECT_EQ(object->lost_contacts(), 0u);
  EXPECT_EQ(object->shape()->clay()->dissipated(), 0);
  difference.split = object->mesh()->triangle_count() - whole->mesh()->triangle_count();
  EXPECT_GT(difference.split, 100);
  return difference;
}

// 2.4 mm deep, at up to 80 mm/s, over a face of a box and over faces and edges of a ball.
TEST(ClayRefinement, ChangesNoForceByItself) {
  const Difference box = felt_by_splitting(support::box({0.03, 0.025, 0.02}), [](int i) {
    const double deep = std::min(i * 1e-5 - 5e-4, 2.4e-3);
    return Vector3d(0.025 * std::cos(2e-3 * i), 0.02 * std::sin(3e-3 * i), 0.02 - deep);
  });
  std::printf("box: %d more triangles, %.1e N\n", box.split, box.most);
  EXPECT_LT(box.most, 1e-9);
  for (const int level : {2, 3}) {
    const Difference ball = felt_by_splitting(support::icosphere(level, 0.03), [](int i) {
      const double turn = 1.3e-3 * i;
      const double radius = std::max(0.0305 - i * 1e-5, 0.0268);
      return Vector3d(radius *
                      Vector3d(std::cos(turn), std::sin(turn), std::sin(3 * turn)).normalized());
    });
    std::printf("ball: %d more triangles, %.1e N; largest step %.3f N, whole %.3f\n", ball.split,
                ball.most, ball.step, ball.step_whole);
    EXPECT_LT(ball.step, 1.05 * ball.step_whole);
    // If several places of the surface are the nearest in their surroundings, the path to a place
    // decides.
    if (level == 2) {
      EXPECT_LT(ball.most, 1e-9);
    }
  }
}

TEST(ClayVolume, IsKeptOnRequest) {
  for (const double edge : {0.0, 0.0008}) {
    const TriangleMesh mesh =
        edge > 0 ? support::plate(0.1, 0.04, 10) : support::icosphere(4, 0.03);
    const double top = edge > 0 ? 0.02 : 0.03;
    ClayChoice kept{.yield_force = 0.5, .radius = 0.006, .edge = edge, .keeps_volume = true};
    ClayChoice lost = kept;
    lost.keeps_volume = false;
    const double first = check_mesh(mesh).volume;
    const auto after = [&](const ClayChoice& clay) {
      auto object = clay_of(mesh, clay);
      Tip tip(*object);
      for (int i = -100; i < 400; ++i) tip.at({0.001, 0.0005, top - 1e-5 * i});
      // A groove from there.
      for (int i = 0; i < 400; ++i) {
        const double x = 0.001 + 2e-5 * i;
        tip.at({x, 0.0005, (edge > 0 ? top : std::sqrt(top * top - x * x)) - 4e-3});
      }
      for (int i = 0; i < 3000; ++i) tip.at({0, 0, 0.05});
      EXPECT_TRUE(object->shape()->settled());
      const double change = check_mesh(now(*object)).volume - first;
      if (clay.keeps_volume) {
        EXPECT_NEAR(object->shape()->volume()->change(), change, 1e-9 * first);
        double highest = 0;
        for (const Vector3d& p : now(*object).vertices) {
          highest = std::max(highest, (edge > 0 ? p.z() : p.norm()) - top);
        }
        std::printf("rim of %.2f mm, ", 1e3 * highest);
        EXPECT_GT(highest, 0.2e-3);
      }
      EXPECT_TRUE(check_mesh(now(*object)).touchable());
      return change;
    };
    const double without = after(lost), with = after(kept);
    std::printf("volume pressed away %.1f mm^3, left when kept %.1e of it\n", -1e9 * without,
                with / without);
    EXPECT_LT(without, -1e-8);
    EXPECT_LT(std::abs(with), 1e-6 * std::abs(without));
  }
}

/// Presses at random places, moves sideways and out again.
void press_at_random(Tip& tip, support::Random& random, double size, Vector3d& p_before) {
  const Vector3d from = 1.3 * size * random.direction();
  const Vector3d to =
      (from + random.in_box(0.7 * size)).normalized() * random.uniform(0.7, 0.95) * size;
  const int ticks = 20 + static_cast<int>(random.bits() % 60);
  const Vector3d start = p_before.normalized() * 1.5 * size;
  for (int k = 0; k <= 40; ++k) tip.at((start * (40 - k) + from * k).normalized() * 1.5 * size);
  for (int k = 1; k <= ticks; ++k) tip.at(from + (to - from) * k / ticks);
  const Vector3d aside = (to + random.in_box(0.3 * size)).normalized() * to.norm();
  for (int k = 1; k <= ticks; ++k) tip.at(to + (aside - to) * k / ticks);
  for (int k = 1; k <= ticks; ++k) tip.at(aside * (1 + 0.9 * k / ticks));
  p_before = 1.9 * aside;
}

// Random strokes with a fixed seed: checks the mesh at their end, and that no tick allocates.
TEST(ClayRefinement, ThousandPrintsKeepTheMeshClosed) {
  struct Case {
    TriangleMesh mesh;
    int triangles;
    int prints;
  };
  const Case cases[] = {{support::icosphere(1, 0.03), 20000, 1000},
                        {support::bumpy_sphere(2, 0.03, 0.1, 4), 20000, 200},
                        {support::icosphere(2, 0.03), 500, 200}};
  for (const Case& one : cases) {
    const ClayChoice clay{.yield_force = 0.3,
                          .movement_limit = 0.006,
                          .radius = 5e-3,
                          .edge = 1e-3,
                          .triangles = one.triangles};
    auto object = clay_of(one.mesh, clay);
    auto again = clay_of(one.mesh, clay);
    Tip tip(*object), tip_again(*again);
    support::Random random(7), random_again(7);
    Vector3d before(0, 0, 0.05), before_again = before;
    EXPECT_EQ(support::heap_calls_of([&] {
                for (int i = 0; i < one.prints; ++i) press_at_random(tip, random, 0.03, before);
              }),
              0);
    const TriangleMesh mesh = now(*object);
    const MeshFindings findings = check_mesh(mesh);
    EXPECT_TRUE(findings.faults.empty())
        << (findings.faults.empty() ? "" : describe(findings.faults.front()));
    EXPECT_GT(findings.volume, 0);
    EXPECT_TRUE(ContactMesh::build(mesh));
    EXPECT_LE(mesh.triangles.size(), static_cast<std::size_t>(one.triangles));
    EXPECT_GT(mesh.triangles.size(), one.triangles < 1000 ? 490u : 5000u);
    EXPECT_EQ(object->lost_contacts(), 0u);
    std::printf("%d prints: %zu triangles, heat %.2f J\n", one.prints, mesh.triangles.size(),
                object->shape()->clay()->dissipated());
    // A repetition is bit-identical.
    for (int i = 0; i < 100; ++i) press_at_random(tip_again, random_again, 0.03, before_again);
    auto third = clay_of(one.mesh, clay);
    Tip tip_third(*third);
    support::Random random_third(7);
    Vector3d before_third(0, 0, 0.05);
    for (int i = 0; i < 100; ++i) press_at_random(tip_third, random_third, 0.03, before_third);
    EXPECT_EQ(now(*again).vertices, now(*third).vertices);
    EXPECT_EQ(now(*again).triangles, now(*third).triangles);
  }
}

TEST(ClayRefinement, RefusesIncompatibleSettings) {
  const TriangleMesh mesh = support::icosphere(3, 0.03);
  const auto refused = [&](ClayChoice clay, bool dent, bool snap) {
    SurfaceChoice surface{.spring = {.stiffness = kStiffness}, .shape = {.clay = clay, .snap = {}}};
    if (dent) surface.dent = DentSettings{};
    if (snap) surface.shape.snap = SnapChoice{};
    ContactChoice contact;
    contact.tracker = TrackerChoice::kGodObject;
    auto built = build_object_touch(mesh, contact, surface);
    return built ? std::string() : built.error().message;
  };
  const ClayChoice good{.radius = 5e-3, .edge = 1e-3};
  EXPECT_EQ(refused(good, false, false), "");
  EXPECT_NE(refused(good, true, false).find("dent"), std::string::npos);
  EXPECT_NE(refused(good, false, true).find("snaps"), std::string::npos);
  for (const double edge : {-1.0, 2e-4, std::numeric_limits<double>::quiet_NaN(),
                            std::numeric_limits<double>::infinity()}) {
    ClayChoice bad = good;
    bad.edge = edge;
    EXPECT_NE(refused(bad, false, false), "") << edge;
  }
  const SurfaceChoice surface{.spring = {.stiffness = kStiffness},
                              .shape = {.clay = good, .snap = {}}};
  for (const auto tracker : {TrackerChoice::kOffset, TrackerChoice::kEdgePlanes}) {
    ContactChoice contact;
    contact.tracker = tracker;
    const auto built = build_object_touch(mesh, contact, surface);
    ASSERT_FALSE(built);
    EXPECT_NE(built.error().message.find("god_object"), std::string::npos);
  }
  ClayChoice small = good;
  small.triangles = 1000;
  EXPECT_NE(refused(small, false, false).find("already has 1280 triangles"), std::string::npos);
}

}  // namespace
}  // namespace thimble::render
