// Maps where they step: at seams of texture coordinates, and where the surface point jumps.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <vector>

#include "support/random.h"
#include "thimble/render/build_object_touch.h"
#include "unit/render/surface/mapped_slab.h"

namespace thimble::render {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using namespace mapped_slab;

ContactChoice by(TrackerChoice tracker) {
  ContactChoice contact;
  contact.tracker = tracker;
  return contact;
}

// Largest change of the force along a path, as a share of K times the path (no_jumps.md).
struct Change {
  double share = 0;
  double s = 0;  // where on the path
  double tick = 0;
};

template <class Way>
Change change_along(ObjectTouch& touch, const Way& way, int steps) {
  Change most;
  Vector3d before = touch.update(at(way(0.0))).f_T_W;
  for (int i = 1; i <= steps; ++i) {
    const double path = (way(double(i) / steps) - way(double(i - 1) / steps)).norm();
    const Vector3d f_W = touch.update(at(way(double(i) / steps))).f_T_W;
    const double share = (f_W - before).norm() / (kStiffness * path);
    if (share > most.share) most = {share, double(i) / steps, (f_W - before).norm()};
    before = f_W;
  }
  return most;
}

// The bound of the guide (guarantees_contact.md).
constexpr double kBound = 5;

// A block of 12 triangles, 80 x 60 x 20 mm, whose upper side is at z = 0. Red grows from 0 on the
// left to 1 on the right.
Slab block() {
  Slab done;
  const Vector3d half(0.04, 0.03, 0.01);
  for (int i = 0; i < 8; ++i) {
    const Vector3d side(i & 1 ? 1 : -1, i >> 1 & 1 ? 1 : -1, i >> 2 ? 1 : -1);
    done.mesh.vertices.emplace_back(side.cwiseProduct(half) - Vector3d(0, 0, 0.01));
  }
  done.mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                         {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  for (const auto& corners : done.mesh.triangles) {
    done.attributes.uv.emplace_back();
    done.attributes.colours.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3d& p = done.mesh.vertices[static_cast<std::size_t>(corners[k])];
      done.attributes.uv.back()[k] = {p.x() / 0.08 + 0.5, p.y() / 0.06 + 0.5};
      done.attributes.colours.back()[k] = {p.x() / 0.08 + 0.5, 0, 0.5};
    }
  }
  return done;
}

TEST(MapSeams, EdgePlanesReadTheMapBelowTheProxy) {
  const Slab on = block();
  ContactChoice bands = by(TrackerChoice::kEdgePlanes);
  bands.blending = BlendingChoice::kFixedBand;
  bands.band = 0.0005;
  for (const ContactChoice& contact : {by(TrackerChoice::kEdgePlanes), bands}) {
    auto touch = build(on, stiff_by_colour(on, 0.25), contact);
    for (const Vector2d& p : {Vector2d(0.0188, 0.00995), {-0.033, 0.02}, {0.004, -0.021}}) {
      const double k = kStiffness * (0.25 + 0.75 * (p.x() / 0.08 + 0.5));
      EXPECT_NEAR(press(*touch, p.x(), p.y(), 0.0025).z(), k * 0.0025, 1e-9) << p.transpose();
    }
  }
}

// A picture that steps from 0.2 to 0.8 in the middle; with sharp lines in its upper rows if
// `steep`.
std::shared_ptr<const HeightImage> step_picture(bool steep) {
  constexpr int kSide = 64;
  std::vector<float> values;
  for (int row = 0; row < kSide; ++row) {
    for (int column = 0; column < kSide; ++column) {
      const float line = steep && row > 56 && column % 8 < 4 ? 1.0F : 0.0F;
      values.push_back(std::max(line, column < kSide / 2 ? 0.2F : 0.8F));
    }
  }
  return std::make_shared<const HeightImage>(kSide, kSide, values);
}

// Two places of the picture, each of one value but for its upper rows, meet at x = 0. The last 5 mm
// in y have it five times: with the lines of a steep picture, a very steep place.
Vector2d two_values(std::size_t side, const Vector3d& p) {
  const double turns = p.y() > 0.9 * kHalf ? 5 : 0;
  return {(side == 0 ? 0.25 : 0.75) + p.x() / 0.2,
          0.1 + 0.8 * (p.y() + kHalf) / (2 * kHalf) + turns};
}

SurfaceChoice stiff_by_picture(const Slab& on, const std::shared_ptr<const HeightImage>& image) {
  SurfaceChoice surface = stiff_by_colour(on, 0.1);
  surface.stiffness_map->image = image;
  return surface;
}

TEST(MapSeams, SteepPlaceElsewhereHidesNoStep) {
  const Slab on = slab(two_values);
  for (const bool steep : {false, true}) {
    auto touch =
        build(on, stiff_by_picture(on, step_picture(steep)), by(TrackerChoice::kGodObject));
    touch->update(at({-0.01, -0.005, 0.01}));
    const auto across = [](double s) { return Vector3d(-0.01 + 0.02 * s, -0.005, -0.006); };
    const Change most = change_along(*touch, across, 1000);
    std::printf("steep %d: %.2f K times the path, %.3f N in a tick\n", steep, most.share,
                most.tick);
    EXPECT_LE(most.share, kBound);
    EXPECT_GT(most.share, 0.01);
  }
}

TEST(MapSeams, SteepPlaceElsewhereLeavesNoWork) {
  const Slab on = slab(two_values);
  auto touch = build(on, stiff_by_picture(on, step_picture(true)), by(TrackerChoice::kGodObject));
  touch->update(at({-0.012, -0.005, 0.01}));
  // Over the seam while deep, and back while not.
  const auto around = [](double s) {
    return Vector3d(-0.012 * std::cos(kTurn * s), -0.005, -0.004 - 0.003 * std::sin(kTurn * s));
  };
  work_along(*touch, around, 4000);
  const Work work = work_along(*touch, around, 4000);
  std::printf("%.2e of the work in and out\n", work.net / work.gross);
  EXPECT_LT(std::abs(work.net), 1e-3 * work.gross);
}

// Two values of a picture that meet at x = 0, 23 um apart with the height 0.3 mm.
std::shared_ptr<const HeightImage> small_step() {
  std::vector<float> values;
  for (int i = 0; i < 64; ++i) values.push_back(i % 8 < 4 ? 0.5F : 0.5F + 0.023F / 0.3F);
  return std::make_shared<const HeightImage>(8, 8, values);
}

TEST(MapSeams, SmallStepOfHeightIsNoStepOfForce) {
  // Inside the halves, where the picture is even.
  const Slab on = slab([](std::size_t side, const Vector3d& p) {
    return Vector2d((side == 0 ? 0.25 : 0.75) + p.x(), 0.5 + p.y());
  });
  for (const double depth : {0.002, 0.01}) {
    for (const double path : {2e-6, 2e-5, 1e-4}) {
      auto touch = build(on, textured(on, small_step()), by(TrackerChoice::kGodObject));
      touch->update(at({-0.004, 0.001, 0.01}));
      touch->update(at({-0.004, 0.001, 1e-5}));
      const auto across = [&](double s) { return Vector3d(-0.004 + 0.008 * s, 0.001, -depth); };
      touch->update(at(across(0)));
      const Change most = change_along(*touch, across, int(0.008 / path));
      EXPECT_LE(most.share, kBound) << depth << " " << path << " " << most.tick << " N";
    }
  }
}

TEST(MapSeams, EndOfASlopeIsNoStepOfForce) {
  // The picture ends at x = 0 with a slope of 0.25, in the middle of its height.
  const Slab on = slab([](std::size_t side, const Vector3d& p) -> Vector2d {
    if (side == 1) return {0.5, 0.5};
    return {p.x() / 0.02, 0.5 + p.y()};
  });
  auto touch = build(on, textured(on, sine(32), 0.002), by(TrackerChoice::kGodObject));
  touch->update(at({-0.004, 0.001, 0.01}));
  const auto across = [](double s) { return Vector3d(-0.004 + 0.008 * s, 0.001, -0.005); };
  const Change most = change_along(*touch, across, 800);
  EXPECT_LE(most.share, kBound) << most.tick << " N";
}

// A cube whose sides are six pictures next to each other, as a program unwraps it.
Slab unwrapped_cube() {
  Slab cube = block();
  for (Vector3d& p : cube.mesh.vertices) {
    p = Vector3d(p.x() / 0.04, p.y() / 0.03, (p.z() + 0.01) / 0.01) * 0.015;
  }
  for (std::size_t t = 0; t < 12; ++t) {
    const auto& corners = cube.mesh.triangles[t];
    const auto corner = [&](std::size_t k) -> const Vector3d& {
      return cube.mesh.vertices[static_cast<std::size_t>(corners[k])];
    };
    Eigen::Index side = 0;
    const Vector3d n = (corner(1) - corner(0)).cross(corner(2) - corner(0)).cwiseAbs();
    n.maxCoeff(&side);
    for (std::size_t k = 0; k < 3; ++k) {
      const double a = corner(k)[(side + 1) % 3] / 0.03 + 0.5;
      const double b = corner(k)[(side + 2) % 3] / 0.03 + 0.5;
      cube.attributes.uv[t][k] = {(double(t / 2 % 3) + 0.05 + 0.9 * a) / 3,
                                  (double(t / 6) + 0.05 + 0.9 * b) / 2};
    }
  }
  return cube;
}

// Around three edges of the cube at a depth of 3 mm, slowly.
Vector3d around_cube(double s) {
  const double angle = kTurn * s;
  const Vector3d way = Vector3d(std::cos(angle), 0.2 + 0.3 * std::sin(2 * angle), std::sin(angle));
  return way * (0.012 / way.cwiseAbs().maxCoeff());
}

TEST(MapSeams, ForceOverEdgesOfAnUnwrappedCubeIsBounded) {
  const Slab on = unwrapped_cube();
  SurfaceChoice height = textured(on, step_picture(false), 1e-4);
  SurfaceChoice stiff = stiff_by_picture(on, step_picture(false));
  for (const TrackerChoice tracker : {TrackerChoice::kEdgePlanes, TrackerChoice::kPacked,
                                      TrackerChoice::kOffset, TrackerChoice::kGodObject}) {
    for (const SurfaceChoice* surface : {&height, &stiff}) {
      auto touch = build(on, *surface, by(tracker));
      touch->update(at({0.03, 0.003, 0}));
      const Change most = change_along(*touch, around_cube, 4000);
      std::printf("tracker %d %s: %.2f K times the path, %.3f N in a tick at %.3f\n", int(tracker),
                  surface == &stiff ? "stiffness" : "height", most.share, most.tick, most.s);
      EXPECT_LE(most.share, kBound);
    }
  }
}

TEST(MapSeams, StepEndsOnAPathAlongTheSeam) {
  const Slab on = slab(two_values);
  auto touch = build(on, stiff_by_picture(on, step_picture(false)), by(TrackerChoice::kGodObject));
  touch->update(at({-0.004, -0.015, 0.01}));
  for (int i = 0; i <= 400; ++i) touch->update(at({-0.004 + 1.5e-5 * i, -0.015, -0.004}));
  // 2 mm behind the seam.
  double k = 0;
  for (int i = 0; i <= 2000; ++i) {
    k = touch->update(at({0.002, -0.015 + 1.2e-5 * i, -0.004})).f_T_W.z() / 0.004;
  }
  EXPECT_NEAR(k, kStiffness * (0.1 + 0.9 * 0.8), 1e-4);
}

TEST(MapSeams, StepEndsWhereTheTipMovesToAndFro) {
  const Slab on = slab(two_values);
  auto touch = build(on, stiff_by_picture(on, step_picture(false)), by(TrackerChoice::kGodObject));
  touch->update(at({-0.004, -0.015, 0.01}));
  for (int i = 0; i <= 400; ++i) touch->update(at({-0.004 + 1.5e-5 * i, -0.015, -0.004}));
  double k = 0;
  for (int i = 0; i <= 40000; ++i) {
    const double s = kTurn * i / 1000;
    k = touch
            ->update(
                at({0.002 + 0.0007 * (std::cos(s) - 1), -0.015 + 0.0007 * std::sin(s), -0.004}))
            .f_T_W.z() /
        0.004;
  }
  EXPECT_NEAR(k, kStiffness * (0.1 + 0.9 * 0.8), 1e-4);
}

TEST(MapSeams, RandomClosedPathsOverASeamDoNoWork) {
  const Slab on = slab(two_values);
  support::Random random(10);
  for (int round = 0; round < 10; ++round) {
    auto touch = build(on, stiff_by_picture(on, step_picture(true)), by(TrackerChoice::kGodObject));
    std::array<double, 6> a{};
    for (double& one : a) one = random.uniform(-1, 1);
    const auto way = [&](double s) {
      return Vector3d(0.006 * (a[0] * std::sin(kTurn * s) + a[1] * std::cos(2 * kTurn * s)),
                      0.004 * (a[2] * std::sin(kTurn * s) + a[3] * std::cos(kTurn * s)) - 0.005,
                      -0.004 + 0.0015 * (a[4] * std::sin(kTurn * s) + a[5] * std::cos(kTurn * s)));
    };
    touch->update(at(way(0) + Vector3d(0, 0, 0.02)));
    // From the second round on, the felt value at its start and end is the same.
    for (int i = 0; i < 4; ++i) work_along(*touch, way, 20000);
    const Work work = work_along(*touch, way, 20000);
    EXPECT_LT(std::abs(work.net), 2e-3 * work.gross) << round;
  }
}

}  // namespace
}  // namespace thimble::render
