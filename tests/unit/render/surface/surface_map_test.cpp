// Heights, stiffness and friction over the surface of a mesh, by texture coordinates and colours.
#include "surface/map/surface_map.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "body/motion/move_object.h"
#include "support/heap_guard.h"
#include "surface/friction/bristle.h"
#include "surface/texture/height_map.h"
#include "thimble/render/build_object_touch.h"
#include "unit/render/surface/mapped_slab.h"

namespace thimble::render {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using namespace mapped_slab;

TEST(SurfaceMap, RampIsFeltInClosedForm) {
  const Slab on = slab(once);
  for (const ContactChoice& contact : all_contacts()) {
    auto touch = build(on, textured(on, ramp()), contact);
    // Offsets of compact are in steps of a lattice.
    const double within =
        contact.tracker == TrackerChoice::kPacked && contact.tip_radius == 0 ? 1e-6 : 1e-9;
    const double slope = kHeight / (2 * kHalf);
    for (const double x : {-0.0101, -0.003, 0.0047, 0.0123}) {
      // The first pixel's middle is half a pixel from the edge.
      const double height = kHeight * (((x + kHalf) / (2 * kHalf) * 32 - 0.5) / 32 - 1);
      const double depth = 0.001;
      const Vector3d f_W = press(*touch, contact, x, 0.0061, depth);
      const double load = kStiffness * (depth + height);
      EXPECT_NEAR(f_W.z(), load, within) << int(contact.tracker) << " " << contact.tip_radius;
      EXPECT_NEAR(f_W.x(), -load * slope, within);
      EXPECT_NEAR(f_W.y(), 0, within);
    }
  }
}

TEST(SurfaceMap, CheckerIsFeltInClosedForm) {
  // Two by two pixels of 1 mm, repeated: in the middle of a pixel the spline has 4/6 of it and 1/6
  // of each neighbour, in both directions.
  const auto checker = std::make_shared<const HeightImage>(2, 2, std::vector<float>{1, 0, 0, 1});
  const Slab on =
      slab([](std::size_t, const Vector3d& p) -> Vector2d { return p.head<2>() / 0.002; });
  auto touch = build(on, textured(on, checker, 1e-4));
  const double white = (16.0 + 4 * 1) / 36, black = 16.0 / 36;
  for (int i = -5; i < 5; ++i) {
    for (int j = -5; j < 5; ++j) {
      const double value = (i + j) % 2 == 0 ? white : black;
      const Vector3d f_W = press(*touch, 0.001 * i + 0.0005, 0.001 * j + 0.0005, 0.001);
      EXPECT_NEAR(f_W.z(), kStiffness * (0.001 + 1e-4 * (value - 1)), 1e-9) << i << " " << j;
      EXPECT_NEAR(f_W.head<2>().norm(), 0, 1e-9);
    }
  }
}

TEST(SurfaceMap, TurnedCoordinatesTurnTheSlope) {
  const double angle = 0.5, per_metre = 10;
  const Slab on = slab([&](std::size_t, const Vector3d& p) -> Vector2d {
    return per_metre * Eigen::Rotation2Dd(angle).toRotationMatrix() * p.head<2>() +
           Vector2d(0.5, 0.5);
  });
  auto touch = build(on, textured(on, ramp()));
  const Vector3d f_W = press(*touch, 0.004, -0.007, 0.001);
  const double u = per_metre * (std::cos(angle) * 0.004 + std::sin(angle) * 0.007) + 0.5;
  const double load = kStiffness * (0.001 + kHeight * (u - 0.5 / 32 - 1));
  EXPECT_NEAR(f_W.z(), load, 1e-9);
  EXPECT_NEAR(f_W.x(), -load * kHeight * per_metre * std::cos(angle), 1e-9);
  EXPECT_NEAR(f_W.y(), load * kHeight * per_metre * std::sin(angle), 1e-9);
}

TEST(SurfaceMap, CoordinatesWithoutAreaAreSmooth) {
  const Slab on = slab([](std::size_t side, const Vector3d& p) {
    return side == 0 ? Vector2d(once(side, p).x(), 0.3) : once(side, p);
  });
  auto touch = build(on, textured(on, ramp()));
  EXPECT_NEAR(press(*touch, -0.01, 0, 0.001).z(), kStiffness * 0.001, 1e-12);
  EXPECT_LT(press(*touch, 0.01, 0, 0.001).z(), kStiffness * 0.00099);
}

TEST(SurfaceMap, OnePixelIsAnEvenHeight) {
  const Slab on = slab(once);
  const auto grey = std::make_shared<const HeightImage>(1, 1, std::vector<float>{0.25F});
  auto touch = build(on, textured(on, grey));
  const Vector3d f_W = press(*touch, 0.004, 0.002, 0.001);
  EXPECT_NEAR((f_W - Vector3d(0, 0, kStiffness * (0.001 - 0.75 * kHeight))).norm(), 0, 1e-12);
}

TEST(SurfaceMap, SeamIsFeltAsASlope) {
  const Slab on = slab(torn);
  auto touch = build(on, textured(on, ramp(), 0.0005));
  constexpr double kStep = 1e-5, kDepth = 0.002;
  for (const double way : {1.0, -1.0}) {
    Vector3d before = press(*touch, -0.003 * way, 0.001, kDepth);
    double most = 0, most_aside = 0;
    for (int i = 1; i <= 600; ++i) {
      const Vector3d f_W = touch->update(at({way * (-0.003 + i * kStep), 0.001, -kDepth})).f_T_W;
      most = std::max(most, std::abs(f_W.z() - before.z()));
      most_aside = std::max(most_aside, std::abs(f_W.x()));
      before = f_W;
    }
    std::printf("dfz %.3g of K ds, aside %.3g of the normal force\n", most / (kStiffness * kStep),
                most_aside / (kStiffness * kDepth));
    // The step of 0.15 mm alone would be 0.12 N, 15 K ds.
    EXPECT_LE(most, 1.02 * kTextureSlopeMax * kStiffness * kStep);
    EXPECT_LE(most_aside, 1.02 * kTextureSlopeMax * kStiffness * kDepth);
    // Behind it the picture is felt as it is.
    auto other = build(on, textured(on, ramp(), 0.0005));
    const Vector3d alone = press(*other, way * 0.003, 0.001, kDepth);
    EXPECT_NEAR((before - alone).norm(), 0, 1e-12);
  }
}

// Across the seam and back, deeper on the way back, ending at its start.
Vector3d around_seam(double s) {
  return {-0.006 * std::cos(kTurn * s), 0.004 * std::sin(kTurn * s),
          -0.002 - 0.0007 * std::sin(kTurn * s)};
}

TEST(SurfaceMap, ClosedPathOverASeamDoesNoWork) {
  const Slab on = slab(torn);
  auto touch = build(on, textured(on, ramp(), 0.0005));
  touch->update(at({-0.006, 0, 0.01}));
  const Work work = work_along(*touch, around_seam, 200000);
  std::printf("seam: %.2e of the work in and out\n", work.net / work.gross);
  EXPECT_GT(work.gross, 1e-4);
  EXPECT_LT(std::abs(work.net), 1e-4 * work.gross);
}

TEST(SurfaceMap, StiffnessFollowsAColourInClosedForm) {
  const Slab on = slab(once);
  for (const ContactChoice& contact : all_contacts()) {
    auto touch = build(on, stiff_by_colour(on, 0.25), contact);
    const double within =
        contact.tracker == TrackerChoice::kPacked && contact.tip_radius == 0 ? 1e-6 : 1e-9;
    for (const double x : {-0.0131, 0.0022, 0.0137}) {
      const double k = kStiffness * (0.25 + 0.75 * (x + kHalf) / (2 * kHalf));
      const double per_metre = kStiffness * 0.75 / (2 * kHalf);
      const Vector3d f_W = press(*touch, contact, x, -0.0041, 0.001);
      EXPECT_NEAR(f_W.z(), k * 0.001, within) << int(contact.tracker) << " " << contact.tip_radius;
      EXPECT_NEAR(f_W.x(), -1e-6 / 2 * per_metre, within);
    }
  }
}

TEST(SurfaceMap, StiffnessFollowsAPicture) {
  const Slab on = slab(once);
  SurfaceChoice surface = stiff_by_colour(on, 0.25);
  // The sides of the slab have one value each.
  surface.stiffness_map->image = ramp();
  auto touch = build(on, surface);
  const double x = 0.005;
  const double share = 0.25 + 0.75 * ((x + kHalf) / (2 * kHalf) - 0.5 / 32);
  EXPECT_NEAR(press(*touch, x, 0.001, 0.001).z(), kStiffness * share * 0.001, 1e-9);
}

// A path in length, width and depth over the upper face.
Vector3d around_top(double s) {
  return {0.008 * std::cos(kTurn * s), 0.006 * std::sin(kTurn * s),
          -0.002 - 0.001 * std::sin(kTurn * s + 1)};
}

TEST(SurfaceMap, ClosedPathOverVaryingStiffnessDoesNoWork) {
  const Slab on = slab(once);
  SurfaceChoice surface = stiff_by_colour(on, 0.25);
  surface.stiffness_map->image = sine(32);
  auto touch = build(on, surface);
  touch->update(at({0.008, 0, 0.01}));
  const Work work = work_along(*touch, around_top, 100000);
  std::printf("varying stiffness: %.2e of the work in and out\n", work.net / work.gross);
  EXPECT_GT(work.gross, 1e-4);
  EXPECT_LT(std::abs(work.net), 1e-7 * work.gross);
}

TEST(SurfaceMap, ClosedPathOverASharpBorderDoesNoWork) {
  // From a quarter of the stiffness to the whole within a pixel of 1.25 mm, 2 to 3 mm deep.
  const Slab on = slab(once);
  SurfaceChoice surface = stiff_by_colour(on, 0.1);
  surface.stiffness_map->image = halves();
  auto touch = build(on, surface);
  touch->update(at({0.008, 0, 0.01}));
  double aside = 0;
  for (int i = 0; i <= 100000; ++i) {
    const Vector3d f_W = touch->update(at(around_top(i / 1e5))).f_T_W;
    if (f_W.z() > 0) aside = std::max(aside, std::abs(f_W.x()) / f_W.z());
  }
  const Work work = work_along(*touch, around_top, 400000);
  std::printf("sharp border: %.2e of the work in and out, aside %.3f of the normal force\n",
              work.net / work.gross, aside);
  EXPECT_LE(aside, 1 + 1e-9);
  EXPECT_LT(std::abs(work.net), 1e-3 * work.gross);
}

TEST(SurfaceMap, FrictionFollowsAColour) {
  const Slab on = slab(once);
  SurfaceChoice surface = plain();
  surface.maps = make_surface_maps(on.mesh, on.attributes).value();
  surface.friction_map = MapChoice{.channel = 0, .black = 0, .white = 2};
  BristleFriction::Settings settings;
  settings.coulomb = {.sliding = 0.3, .holding = 0.3};
  surface.effects.push_back(effect<BristleFriction>(settings));
  auto touch = build(on, surface);
  for (const double x : {-0.0135, -0.002, 0.013}) {
    press(*touch, x, -0.01, 0.001);
    Vector3d f_W(0, 0, 0);
    for (int i = 0; i < 1500; ++i) f_W = touch->update(at({x, -0.01 + 1e-5 * i, -0.001})).f_T_W;
    const double factor = 2 * (x + kHalf) / (2 * kHalf);
    EXPECT_NEAR(-f_W.y() / f_W.z(), 0.3 * factor, 1e-9) << x;
  }
}

TEST(SurfaceMap, IsFixedToAMovingBody) {
  const Slab on = slab(once);
  const SurfaceChoice surface = textured(on, ramp());
  auto still = build(on, surface);
  MotionChoice motion;
  motion.kind = MotionKind::kRigid;
  motion.mass = 1e8;  // hardly pushed
  motion.omega_W = {0, 0, 2};
  auto moving = move_object(build_object_touch(on.mesh, {}, surface).value(), on.mesh, motion,
                            {2 * kStiffness, 0, 1e-3})
                    .value();
  const Vector3d p_B(0.0061, -0.0033, -0.001);
  const Vector3d f_B = press(*still, p_B.x(), p_B.y(), 0.001);
  double most = 0;
  for (int i = 0; i < 800; ++i) {
    const auto turn = Eigen::AngleAxisd(2e-3 * i, Vector3d::UnitZ()).toRotationMatrix();
    const double above = i < 400 ? 0.004 * (400 - i) / 400 : 0;
    const Vector3d f_W = moving->update(at(turn * (p_B + Vector3d(0, 0, above)))).f_T_W;
    if (i > 500) most = std::max(most, (turn.transpose() * f_W - f_B).norm());
  }
  EXPECT_GT(std::abs(f_B.x()), 1e-3);
  EXPECT_LT(most, 1e-4);
}

TEST(SurfaceMap, OverlappingPartsKeepTheirOwn) {
  // Two slabs, the second 30 mm to the right and so overlapping the first.
  Slab two = slab(once);
  const Slab other = slab([](std::size_t side, const Vector3d& p) -> Vector2d {
    return {1 - once(side, p).x(), once(side, p).y()};
  });
  const auto first = static_cast<std::int32_t>(two.mesh.vertices.size());
  for (const Vector3d& p : other.mesh.vertices)
    two.mesh.vertices.emplace_back(p + Vector3d(0.03, 0, 0.001));
  for (const auto& [a, b, c] : other.mesh.triangles) {
    two.mesh.triangles.push_back({first + a, first + b, first + c});
  }
  two.attributes.uv.insert(two.attributes.uv.end(), other.attributes.uv.begin(),
                           other.attributes.uv.end());
  two.attributes.colours.insert(two.attributes.colours.end(), other.attributes.colours.begin(),
                                other.attributes.colours.end());
  auto touch = build(two, textured(two, ramp()));
  EXPECT_LT(press(*touch, -0.004, 0.002, 0.001).x(), -1e-3);
  touch->update(at({0.034, 0.002, 0.01}));
  touch->update(at({0.034, 0.002, 0.00101}));
  EXPECT_GT(touch->update(at({0.034, 0.002, 0})).f_T_W.x(), 1e-3);
}

TEST(SurfaceMap, MissingOrUnusableMapsAreErrors) {
  Slab on = slab(once);
  SurfaceChoice without = textured(on, ramp());
  without.maps.reset();
  EXPECT_NE(error_of(on, without).find("Use a mesh file instead of a shape"), std::string::npos);
  EXPECT_NE(error_of(on, textured(on, halves(), 0.002)).find("has a slope of"), std::string::npos);
  EXPECT_NE(
      error_of(on, textured(on, halves(), 0.002)).find("by the texture coordinates of triangle"),
      std::string::npos);
  SurfaceChoice dented = textured(on, ramp());
  dented.dent.emplace();
  EXPECT_NE(error_of(on, dented).find("A surface that deforms"), std::string::npos);
  SurfaceChoice stiff = stiff_by_colour(on, 0.5);
  on.attributes.colours[5][1].x() = kNan;
  stiff.maps = make_surface_maps(on.mesh, on.attributes).value();
  EXPECT_NE(error_of(on, stiff).find("1 of 320 triangles have no vertex colours, which "
                                     "stiffness_map needs; the first is triangle 5 near"),
            std::string::npos);
  on.attributes = {};
  stiff.maps = make_surface_maps(on.mesh, on.attributes).value();
  EXPECT_NE(error_of(on, stiff).find("The file has no vertex colours"), std::string::npos);
  SurfaceChoice smooth = textured(on, ramp());
  EXPECT_NE(error_of(on, smooth).find("The file has no texture coordinates"), std::string::npos);
  on.attributes.uv.resize(3);
  EXPECT_FALSE(make_surface_maps(on.mesh, on.attributes));
}

TEST(SurfaceMap, NotANumberIsNoForce) {
  const Slab on = slab(once);
  SurfaceChoice surface = textured(on, ramp());
  surface.stiffness_map = MapChoice{.channel = 0, .black = 0.5, .white = 1};
  auto touch = build(on, surface);
  press(*touch, 0.004, 0.003, 0.001);
  EXPECT_EQ(touch->update(at({kNan, 0, -0.001})).f_T_W, Vector3d(0, 0, 0));
  // The next contact starts again.
  EXPECT_GT(press(*touch, 0.004, 0.003, 0.001).z(), 0.1);
}

TEST(SurfaceMap, TickDoesNotAllocate) {
  const Slab on = slab(torn);
  SurfaceChoice surface = textured(on, ramp());
  surface.stiffness_map = MapChoice{.channel = 0, .black = 0.5, .white = 1};
  auto touch = build(on, surface);
  press(*touch, -0.003, 0.001, 0.001);
  EXPECT_EQ(support::heap_calls_of([&] {
              for (int i = 0; i < 600; ++i) touch->update(at({-0.003 + i * 1e-5, 0.001, -0.001}));
            }),
            0);
}

}  // namespace
}  // namespace thimble::render
