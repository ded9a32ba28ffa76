// Where textures are felt: at the place of the material below the tip, through whole objects.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

#include "body/motion/move_object.h"
#include "god_object_shapes.h"
#include "mesh/contact_mesh.h"
#include "mesh/smooth_normals.h"
#include "search/make_search.h"
#include "support/heap_guard.h"
#include "support/random.h"
#include "support/shapes.h"
#include "surface/texture/sandpaper.h"
#include "surface/texture/sines.h"
#include "thimble/render/build_object_touch.h"
#include "thimble/render/build_primitive_touch.h"
#include "thimble/render/surface/surface_response.h"
#include "track/blended.h"
#include "track/curved_depth.h"
#include "track/edge_blending.h"
#include "track/god_object.h"
#include "track/memory_contact.h"
#include "track/mesh_contact.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kStiffness = 800;
constexpr double kTick = 1e-3;

driver::DeviceState at(const Vector3d& p_WT) {
  driver::DeviceState state;
  state.p_WT = p_WT;
  state.dt = kTick;
  return state;
}

/// Waves that change in all three directions.
Sines::Settings waves(double amplitude) {
  Sines::Settings settings;
  settings.waves = {{.amplitude = amplitude, .wavelength = 0.004, .direction = {1, 0.3, 0.2}},
                    {.amplitude = amplitude, .wavelength = 0.005, .direction = {0.1, 1, 0.4}},
                    {.amplitude = amplitude, .wavelength = 0.003, .direction = {-0.2, 0.3, 1}}};
  return settings;
}

/// Waves that change along z alone.
Sines::Settings layers() {
  Sines::Settings settings;
  settings.waves = {{.amplitude = 0.0002, .wavelength = 0.004, .direction = {0, 0, 1}}};
  return settings;
}

template <class Stage>
SurfaceChoice textured(const typename Stage::Settings& settings) {
  static constexpr EffectKind kKind = effect_kind<Stage>();
  return {.spring = {.stiffness = kStiffness, .damping = 0},
          .effects = {{&kKind, [settings]() -> std::unique_ptr<AnyStage> {
                         return std::make_unique<AnyStageOf<Stage>>(Stage(settings, {}));
                       }}}};
}

ContactChoice by(TrackerChoice tracker) {
  ContactChoice choice;
  choice.tracker = tracker;
  return choice;
}

struct Work {
  double net = 0, gross = 0;
};

/// Leads a tip from far outside to the start of a closed way and once around; gives the work of the
/// force. The sum over even steps of a smooth closed way converges faster than any power.
template <class Way>
Work work_around(ObjectTouch& object, const Vector3d& outside, const Way& way, int steps) {
  driver::ForceCommand command;
  constexpr int kIn = 4000;
  for (int i = 0; i <= kIn; ++i) {
    command = object.update(at(outside + i * (way(0.0) - outside) / kIn));
  }
  EXPECT_TRUE(command.touch.in_contact);
  Work work;
  for (int i = 0; i < steps; ++i) {
    const double s = kTurn * i / steps;
    const double e = 1e-3;
    const Vector3d direction =
        (45 * (way(s + e) - way(s - e)) - 9 * (way(s + 2 * e) - way(s - 2 * e)) +
         (way(s + 3 * e) - way(s - 3 * e))) /
        (60 * e) * (kTurn / steps);
    const double power = object.update(at(way(s))).f_T_W.dot(direction);
    work.net += power;
    work.gross += std::abs(power);
  }
  return work;
}

TEST(TexturePlace, FeelsAsRoughAtEveryDepth) {
  Sandpaper::Settings rough;
  rough.roughness = 20e-6;
  const auto ripple = [&](double depth) {
    auto wall = build_primitive_touch(HalfSpace{}, textured<Sandpaper>(rough));
    support::Random random(1);
    double mean = 0, square = 0;
    constexpr int kPlaces = 4000;
    for (int i = 0; i < kPlaces; ++i) {
      const Vector3d p(random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), 0);
      wall->update(at(p + Vector3d(0, 0, 0.001)));
      // From just above the wall, straight in.
      wall->update(at(p - Vector3d(0, 0, 1e-7)));
      const double felt = wall->update(at(p - Vector3d(0, 0, depth))).f_T_W.z() / kStiffness;
      mean += felt / kPlaces;
      square += felt * felt / kPlaces;
    }
    return std::sqrt(square - mean * mean);
  };
  const double shallow = ripple(0.0008), deep = ripple(0.0034);
  std::printf("asked 20 um; felt %.2f um at 0.8 mm, %.2f um at 3.4 mm\n", 1e6 * shallow,
              1e6 * deep);
  EXPECT_NEAR(shallow, 20e-6, 1e-6);
  EXPECT_NEAR(deep, shallow, 1e-12);
}

TEST(TexturePlace, DoesNoWorkAroundAClosedWayInsideAFlatTriangleAlsoInDepth) {
  const TriangleMesh ball = support::icosphere(0, 0.05);
  const auto& corners = ball.triangles[3];
  const auto p = [&](std::size_t k) { return ball.vertices[static_cast<std::size_t>(corners[k])]; };
  const Vector3d n = (p(1) - p(0)).cross(p(2) - p(0)).normalized();
  const Vector3d x = (p(1) - p(0)).normalized(), y = n.cross(x);
  // Beside the middle, where edge planes lean unequally far away.
  const Vector3d middle = 0.5 * p(0) + 0.3 * p(1) + 0.2 * p(2);
  for (const TrackerChoice tracker :
       {TrackerChoice::kEdgePlanes, TrackerChoice::kNormalProjection, TrackerChoice::kGodObject}) {
    auto object = build_object_touch(ball, by(tracker), textured<Sines>(waves(5e-5))).value();
    const auto way = [&](double s) -> Vector3d {
      return middle + 0.002 * std::cos(s) * x + 0.0015 * std::sin(s) * y -
             (0.0034 + 0.001 * std::sin(s + 1)) * n;
    };
    const Work work = work_around(*object, middle + 0.01 * n, way, 20000);
    std::printf("%s: %.2e of what goes in and out\n",
                std::string(kTrackerNames[static_cast<std::size_t>(tracker)]).c_str(),
                work.net / work.gross);
    EXPECT_LT(std::abs(work.net), 1e-9 * work.gross);
    EXPECT_GT(work.gross, 1e-5);
  }
}

TEST(TexturePlace, DoesNoWorkAroundAClosedWayInABallAtAnyDepth) {
  const auto way = [](double s) -> Vector3d {
    return (0.026 + 0.002 * std::sin(s)) *
           Vector3d(0.3 * std::cos(s), 0.4 * std::sin(s), 1).normalized();
  };
  auto ball = build_primitive_touch(Sphere{.p_WO = {0, 0, 0}, .radius = 0.03},
                                    textured<Sines>(waves(5e-5)));
  const Work work = work_around(*ball, {0, 0, 0.04}, way, 20000);
  EXPECT_LT(std::abs(work.net), 1e-9 * work.gross);
}

TEST(TexturePlace, AddsNoWorkToSmoothMeshesAcrossEdgesAndCorners) {
  // Smooth shading of a mesh does a little work by itself; what a texture adds to it is below that.
  const TriangleMesh ball = support::icosphere(3, 0.05);
  const auto way = [](double s) -> Vector3d {
    return (0.0466 + 0.001 * std::sin(s + 1)) *
           Vector3d(0.25 * std::cos(s), 0.2 * std::sin(s), 1).normalized();
  };
  for (const TrackerChoice tracker : {TrackerChoice::kOffset, TrackerChoice::kPacked}) {
    const char* name = kTrackerNames[static_cast<std::size_t>(tracker)].data();
    const SurfaceChoice plain{.spring = {.stiffness = kStiffness, .damping = 0}, .effects = {}};
    auto bare = build_object_touch(ball, by(tracker), plain).value();
    auto rough = build_object_touch(ball, by(tracker), textured<Sines>(waves(5e-5))).value();
    const Work without = work_around(*bare, {0, 0, 0.06}, way, 40000);
    const Work with = work_around(*rough, {0, 0, 0.06}, way, 40000);
    std::printf("%s: %.2e of what goes in and out, %.2e without texture\n", name,
                with.net / with.gross, without.net / without.gross);
    // Corner normals that are means of faces are farther from the gradient of the depth than fitted
    // ones, and what that leaves open counts times the height over the depth.
    const double allowed = tracker == TrackerChoice::kOffset ? 1e-5 : 2e-4;
    EXPECT_LT(std::abs(with.net), allowed * with.gross);
  }
}

TEST(TexturePlace, IsFixedToABodyThatTurns) {
  // The tip goes along with a material place of a block that turns: it feels the same in the
  // block's frame, whatever wave stands in the world there.
  const TriangleMesh block = support::box({0.03, 0.03, 0.03});
  constexpr double kRate = 2;  // rad/s
  MotionChoice motion;
  motion.kind = MotionKind::kRigid;
  motion.mass = 1e8;  // hardly pushed
  motion.omega_W = {0, 0, kRate};
  const SurfaceChoice surface = textured<Sines>(waves(1e-4));
  auto object = move_object(build_object_touch(block, {}, surface).value(), block, motion,
                            {2 * kStiffness, 0, kTick})
                    .value();
  const Vector3d p_B(0.0118, 0.0077, 0.028);
  Vector3d first(0, 0, 0);
  double most = 0;
  for (int i = 0; i < 1500; ++i) {
    const auto turn = Eigen::AngleAxisd(kRate * kTick * i, Vector3d::UnitZ()).toRotationMatrix();
    const double above = i < 400 ? 0.004 * (400 - i) / 400 : 0;
    const Vector3d f_W = object->update(at(turn * (p_B + Vector3d(0, 0, above)))).f_T_W;
    const Vector3d f_B = turn.transpose() * f_W;
    if (i == 500) first = f_B;
    if (i > 500) most = std::max(most, (f_B - first).norm());
  }
  EXPECT_GT(first.head<2>().norm(), 0.01);
  EXPECT_LT(most, 1e-4);
}

TEST(TexturePlace, IsFixedToClayAsItGivesWay) {
  // Layers lie one below the other. Pressed in through two of them clay shows the height that it
  // showed at first, since its surface is still made of the same: it gives way at its yield force,
  // and the proxy stands as much higher above the tip as the surface was cut away there.
  ShapeChoice shape;
  shape.step = kTick;
  shape.clay.emplace();
  shape.clay->yield_force = 0.5;
  shape.clay->radius = 0.02;
  const TriangleMesh plate = support::plate(0.08, 0.04, 10);
  const auto depths = [&](SurfaceChoice surface) {
    surface.shape = shape;
    auto object = build_object_touch(plate, {}, surface).value();
    std::vector<double> all;
    double proxy = 0;
    for (int i = 0; i <= 3000; ++i) {
      const Vector3d p(0.0107, 0.0053, 0.023 - 1e-3 * 0.004 * i);
      const auto command = object->update(at(p));
      proxy = command.touch.p_WP.z();
      all.push_back(proxy - p.z());
    }
    EXPECT_LT(proxy, 0.02 - 0.007) << "the clay was to give way by two layers";
    return all;
  };
  const std::vector<double> bare =
      depths({.spring = {.stiffness = kStiffness, .damping = 0}, .effects = {}});
  const std::vector<double> rough = depths(textured<Sines>(layers()));
  // At z = 20 mm, five wavelengths up: half way between peak and valley.
  for (std::size_t i = 1200; i < bare.size(); ++i) {
    ASSERT_NEAR(rough[i] - bare[i], 0.0002, 1e-5) << i;
  }
}

// Where two walls of a hollow hold the tip the place is on their edge and moves along it only;
// where three do, it is the corner and does not move. There and over a wall `J_MT` is held to
// differences of the places themselves.
template <class Contact>
void expect_places_in_a_hollow(const char* name, const Contact& made) {
  constexpr double kWall = 0.02, kStep = 1e-5, kAny = std::numeric_limits<double>::infinity();
  struct Case {
    Vector3d p, foot;
    Vector3d moves;  // 1 where the place goes along with the tip, along an axis
  };
  for (const Case& one : {Case{{0.023, 0.004, 0.003}, {kWall, kAny, kAny}, {kAny, kAny, kAny}},
                          Case{{0.023, 0.004, 0.022}, {kWall, 0.004, kWall}, {0, 1, 0}},
                          Case{{0.004, -0.0215, 0.0235}, {0.004, -kWall, kWall}, {1, 0, 0}},
                          Case{{-0.022, -0.023, 0.0225}, {-kWall, -kWall, kWall}, {0, 0, 0}}}) {
    const auto foot_at = [&](const Vector3d& tip) {
      Contact contact = made;
      constexpr int kIn = 300;
      for (int i = 0; i <= kIn; ++i) contact.update(at(one.p * i / kIn));
      EXPECT_TRUE(contact.update(at(tip)).touching) << name;
      return foot_of(contact, tip);
    };
    const SurfaceFoot foot = foot_at(one.p);
    for (int k = 0; k < 3; ++k) {
      const Vector3d axis = Vector3d::Unit(k);
      if (one.foot[k] < kAny) {
        EXPECT_NEAR(foot.p_M[k], one.foot[k], 1e-8) << name;
      }
      const Vector3d moved =
          (foot_at(one.p + kStep * axis).p_M - foot_at(one.p - kStep * axis).p_M) / (2 * kStep);
      if (one.moves[k] < kAny) {
        EXPECT_LT((moved - one.moves[k] * axis).norm(), 1e-5) << name;
      }
      EXPECT_LT((foot.J_MT.col(k) - moved).norm(), 1e-5) << name << ", axis " << k;
    }
  }
}

TEST(TexturePlace, LiesOnTheEdgeOrCornerThatHoldsTheTipInAHollow) {
  const TriangleMesh hollow = support::block_around(support::box({0.02, 0.02, 0.02}), 0.05);
  const auto mesh = std::make_shared<const ContactMesh>(ContactMesh::build(hollow).value());
  const auto search = make_search(*mesh);
  const auto normals = std::make_shared<const SmoothNormals>(*mesh);
  expect_places_in_a_hollow("edge_planes", MeshContact(mesh, search));
  expect_places_in_a_hollow("edge_planes, phong", Blended<MeshContact, Phong>(
                                                      MeshContact(mesh, search), Phong(), normals));
  expect_places_in_a_hollow("offset", Blended<OffsetContact, Phong, CurvedDepth>(
                                          OffsetContact(mesh, search, normals), Phong(), normals));
  expect_places_in_a_hollow("compact", MemoryContact(PackedSurface::build(*mesh).value()));
  expect_places_in_a_hollow("god_object", GodObjectContact(mesh, search));
}

TEST(TexturePlace, NeverJumpsAndStandsStillUnderAHandThatRests) {
  FootFollower place;
  SurfaceFoot found;
  found.p_M = {0, 0, 0};
  found.J_MT.setIdentity();
  EXPECT_EQ(place.follow({0, 0, -0.001}, 0.001, found).p_M, found.p_M);
  found.p_M = {0.002, 0, 0};  // a cell of another part of the surface
  EXPECT_EQ(place.follow({0, 0, -0.001}, 0.001, found).p_M.x() < 1e-12, true);
  Vector3d before(0, 0, 0);
  double p = 0;
  for (int i = 0; i < 100; ++i) {
    p += 1e-5;
    const SurfaceFoot felt = place.follow({p, 0, -0.001}, 0.001, found);
    EXPECT_LE((felt.p_M - before).norm(), 4e-5 + 1e-12);
    const bool arrived = felt.p_M == found.p_M;
    EXPECT_EQ(felt.J_MT.norm() > 0, arrived);
    before = felt.p_M;
  }
  EXPECT_EQ(before, found.p_M);
  // A surface that moves by itself counts as path.
  found.p_M.x() += 3e-5;
  found.surface_path = 1e-5;
  EXPECT_EQ(place.follow({p, 0, -0.001}, 0.001, found).p_M, found.p_M);
}

TEST(TexturePlace, FindsItsFeetWithoutTheHeapOnEveryKindOfContact) {
  const TriangleMesh ball = support::icosphere(2, 0.05);
  for (std::size_t i = 0; i < kTrackerNames.size(); ++i) {
    auto object =
        build_object_touch(ball, by(static_cast<TrackerChoice>(i)), textured<Sines>(waves(5e-5)))
            .value();
    double most = 0;
    EXPECT_EQ(support::heap_calls_of([&] {
                for (int k = 0; k < 2000; ++k) {
                  const double s = 1e-3 * k;
                  const Vector3d p = (0.052 - 0.006 * std::min(1.0, 4 * s)) *
                                     Vector3d(std::sin(s), std::sin(2 * s), 1).normalized();
                  const Vector3d f = object->update(at(p)).f_T_W;
                  most = f.allFinite() ? std::max(most, f.norm()) : 1e300;
                }
              }),
              0)
        << kTrackerNames[i];
    EXPECT_GT(most, 1) << kTrackerNames[i];
    EXPECT_LT(most, 20) << kTrackerNames[i];
  }
}

}  // namespace
}  // namespace thimble::render
