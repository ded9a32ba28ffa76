// Textures act at the place of the material below the tip; tested through whole objects.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <numbers>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "body/motion/move_object.h"
#include "mesh/contact_mesh.h"
#include "mesh/smooth_normals.h"
#include "search/make_search.h"
#include "support/heap_guard.h"
#include "support/meshes/shapes.h"
#include "support/random.h"
#include "surface/texture/sandpaper.h"
#include "surface/texture/sines.h"
#include "thimble/render/build_object_touch.h"
#include "thimble/render/build_primitive_touch.h"
#include "thimble/render/object_touch.h"
#include "thimble/render/surface/spring_damper.h"
#include "thimble/render/surface/surface_response.h"
#include "track/blended.h"
#include "track/curved_depth.h"
#include "track/edge_blending.h"
#include "track/god_object.h"
#include "track/mesh_contact.h"
#include "track/packed_contact_in_memory.h"
#include "unit/render/surface/open_loop.h"
#include "unit/render/track/god_object_shapes.h"

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

/// Waves that change only along z.
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

/// Moves a tip from far outside to the start of a closed path and once around; returns the work of
/// the force. The sum over even steps of a smooth closed path converges faster than any power.
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

TEST(TexturePlace, RoughnessIsIndependentOfDepth) {
  Sandpaper::Settings rough;
  rough.roughness = 20e-6;
  const auto ripple = [&](double depth) {
    auto wall = build_primitive_touch(HalfSpace{}, textured<Sandpaper>(rough));
    support::Random random(1);
    double mean = 0, square = 0;
    constexpr int kPlaces = 4000;
    for (int i = 0; i < kPlaces; ++i) {
      const Vector3d p{random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), 0};
      wall->update(at(p + Vector3d(0, 0, 0.001)));
      // From just above the wall straight in.
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

TEST(TexturePlace, ClosedPathInATriangleDoesNoWork) {
  const TriangleMesh ball = support::icosphere(0, 0.05);
  const auto& corners = ball.triangles[3];
  const auto p = [&](std::size_t k) { return ball.vertices[static_cast<std::size_t>(corners[k])]; };
  const Vector3d n = (p(1) - p(0)).cross(p(2) - p(0)).normalized();
  const Vector3d x = (p(1) - p(0)).normalized(), y = n.cross(x);
  // Off the middle, where edge planes have different slopes.
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

TEST(TexturePlace, ClosedPathInABallDoesNoWorkAtAnyDepth) {
  const auto way = [](double s) -> Vector3d {
    return (0.026 + 0.002 * std::sin(s)) *
           Vector3d(0.3 * std::cos(s), 0.4 * std::sin(s), 1).normalized();
  };
  auto ball = build_primitive_touch(Sphere{.p_WO = {0, 0, 0}, .radius = 0.03},
                                    textured<Sines>(waves(5e-5)));
  const Work work = work_around(*ball, {0, 0, 0.04}, way, 20000);
  EXPECT_LT(std::abs(work.net), 1e-9 * work.gross);
}

const SurfaceChoice kPlain{.spring = {.stiffness = kStiffness, .damping = 0}, .effects = {}};

OpenLoop open_loop_of_object(const TriangleMesh& mesh, const ContactChoice& choice,
                             const Vector3d& outside, const auto& way) {
  auto plain = build_object_touch(mesh, choice, kPlain).value();
  auto textured_one = build_object_touch(mesh, choice, textured<Sines>(waves(5e-5))).value();
  const auto bare = [&](const driver::DeviceState& state) { return plain->update(state); };
  const auto rough = [&](const driver::DeviceState& state) { return textured_one->update(state); };
  const OpenLoop open = open_loop(bare, rough, outside, way);
  EXPECT_TRUE(open.felt);
  return open;
}

// Around the top of a ball of 1,280 triangles, 2.4 to 4.4 mm deep.
Vector3d around_top(double s) {
  return (0.0466 + 0.001 * std::sin(s + 1)) *
         Vector3d(0.25 * std::cos(s), 0.2 * std::sin(s), 1).normalized();
}

TEST(TexturePlace, ContinuousClosestPointAddsNoWorkOnEdges) {
  // Smooth shading by itself has a small net work, because a shaded normal is not a gradient: that
  // is the contact's own value. The part that a texture adds is the gradient of an energy.
  const TriangleMesh ball = support::icosphere(3, 0.05);
  ContactChoice offset = by(TrackerChoice::kOffset);
  ContactChoice round = offset, uncurved = offset, banded = offset;
  round.normals = NormalWeights::kAngle;
  uncurved.curved_depth = false;
  banded.blending = BlendingChoice::kSizedBand;
  struct Case {
    const char* name;
    ContactChoice choice;
    double plain;  // bound of the contact's own net work
    double added;
  };
  // `compact` measures the depth in single precision, where it is multiplied: an error of 3e-7.
  for (const Case& one :
       {Case{"offset", offset, 1e-8, 1e-9}, Case{"offset, means of faces", round, 2e-6, 1e-9},
        Case{"offset, uncurved", uncurved, 2e-6, 1e-9},
        Case{"offset, sized band", banded, 2e-4, 1e-9},
        Case{"compact", by(TrackerChoice::kPacked), 2e-6, 5e-8}}) {
    const OpenLoop open = open_loop_of_object(ball, one.choice, {0, 0, 0.06}, around_top);
    std::printf("%s: the contact leaves %.2e open, the texture adds %.2e\n", one.name, open.plain,
                open.added);
    EXPECT_LT(std::abs(open.added), one.added) << one.name;
    EXPECT_LT(std::abs(open.plain), one.plain) << one.name;
  }
}

TEST(TexturePlace, JumpsOverEdgesAddLittleWork) {
  // At the edges of flat faces the closest point jumps, and the force depends on the tip's path: it
  // is not a function of the place, and the contact itself takes energy there.
  const TriangleMesh ball = support::icosphere(3, 0.05);
  for (const auto& [tracker, most] :
       {std::pair{TrackerChoice::kEdgePlanes, 1e-3}, std::pair{TrackerChoice::kGodObject, 1e-2}}) {
    const char* name = kTrackerNames[static_cast<std::size_t>(tracker)].data();
    const OpenLoop open = open_loop_of_object(ball, by(tracker), {0, 0, 0.06}, around_top);
    std::printf("%s: the contact leaves %.2e open, the texture adds %.2e\n", name, open.plain,
                open.added);
    EXPECT_LT(open.plain, 1e-9) << name << " gives energy";
    EXPECT_LT(std::abs(open.added), most) << name;
  }
}

TEST(TexturePlace, AddsNoWorkInsideAFaceWithAnyShading) {
  const TriangleMesh ball = support::icosphere(0, 0.05);
  const auto& corners = ball.triangles[3];
  const auto p = [&](std::size_t k) { return ball.vertices[static_cast<std::size_t>(corners[k])]; };
  const Vector3d n = (p(1) - p(0)).cross(p(2) - p(0)).normalized();
  const Vector3d x = (p(1) - p(0)).normalized(), y = n.cross(x);
  const Vector3d middle = 0.5 * p(0) + 0.3 * p(1) + 0.2 * p(2);
  const auto way = [&](double s) -> Vector3d {
    return middle + 0.002 * std::cos(s) * x + 0.0015 * std::sin(s) * y -
           (0.0034 + 0.001 * std::sin(s + 1)) * n;
  };
  for (const BlendingChoice blending : {BlendingChoice::kFlat, BlendingChoice::kFixedBand,
                                        BlendingChoice::kSizedBand, BlendingChoice::kPhong}) {
    for (const bool curved : {false, true}) {
      ContactChoice choice = by(TrackerChoice::kEdgePlanes);
      choice.blending = blending;
      choice.curved_depth = curved;
      choice.band = 0.02;
      const OpenLoop open = open_loop_of_object(ball, choice, middle + 0.01 * n, way);
      std::printf(
          "edge_planes, blending %d, curved %d: the contact leaves %.2e open, the texture "
          "adds %.2e\n",
          static_cast<int>(blending), curved, open.plain, open.added);
      EXPECT_LT(std::abs(open.added), 1e-9);
    }
  }
}

TEST(TexturePlace, EdgePlanesAddWorkOnlyAtGaps) {
  // On meshes of equal triangles the two closest points coincide. On others they are apart below an
  // edge, and the height jumps there.
  const auto open = [](const TriangleMesh& ball, const auto& shading, const Vector3d& outside,
                       const auto& way) {
    const auto mesh = std::make_shared<const ContactMesh>(ContactMesh::build(ball).value());
    const auto search = make_search(*mesh);
    const SpringDamper spring{.stiffness = kStiffness, .damping = 0};
    using Contact = Blended<MeshContact, std::decay_t<decltype(shading)>>;
    const Contact contact(MeshContact(mesh, search), shading,
                          std::make_shared<const SmoothNormals>(*mesh));
    ContactForceLaw bare(contact, spring);
    ContactForceLaw rough(contact, Sines(waves(5e-5), {}), spring);
    const OpenLoop around = open_loop(bare, rough, outside, way);
    EXPECT_TRUE(around.felt);
    return around;
  };
  const TriangleMesh even = support::icosphere(0, 0.05), uneven = support::icosphere(3, 0.05);
  // Over the edges of a corner of 20 equal triangles, 3 to 5 mm below.
  const Vector3d corner = even.vertices[0].normalized();
  const Vector3d x = corner.unitOrthogonal(), y = corner.cross(x);
  const auto around_corner = [&](double s) -> Vector3d {
    return (0.0385 + 0.001 * std::sin(s + 1)) *
           (0.25 * std::cos(s) * x + 0.2 * std::sin(s) * y + corner).normalized();
  };
  for (const auto& [name, equal, flat, banded] :
       {std::tuple{"equal triangles", true, open(even, Flat(), 0.06 * corner, around_corner),
                   open(even, SizedBand(), 0.06 * corner, around_corner)},
        std::tuple{"others", false, open(uneven, Flat(), Vector3d(0, 0, 0.06), around_top),
                   open(uneven, SizedBand(), Vector3d(0, 0, 0.06), around_top)}}) {
    std::printf("edge_planes, %s: flat leaves %.2e open, the texture adds %.2e; bands %.2e, %.2e\n",
                name, flat.plain, flat.added, banded.plain, banded.added);
    EXPECT_LT(std::abs(flat.plain), 1e-9) << name;
    // Bands turn the normal independently of the depth.
    EXPECT_LT(std::abs(banded.plain), 5e-3) << name;
    for (const double added : {flat.added, banded.added}) {
      EXPECT_LT(std::abs(added), equal ? 1e-9 : 1e-3) << name;
    }
  }
}

TEST(TexturePlace, IsFixedToABodyThatTurns) {
  // The tip moves with a material place of a turning block: its force is constant in the block's
  // frame, independent of waves in the world.
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

TEST(TexturePlace, IsFixedToYieldingClay) {
  // Layers are one below the other. Clay that is pressed in through two layers shows its initial
  // height, because its surface is still the same material: it yields at its yield force, and the
  // proxy is above the tip by the height that was pressed away.
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
  // At z = 20 mm, five wavelengths up: half-way between peak and valley.
  for (std::size_t i = 1200; i < bare.size(); ++i) {
    ASSERT_NEAR(rough[i] - bare[i], 0.0002, 1e-5) << i;
  }
}

// If two walls of a groove hold the tip, the place is on their edge and moves only along it. If
// three do, it is the corner and does not move. There and over a wall, `J_MT` is compared with
// differences of the places themselves.
template <class Contact>
void expect_places_in_a_hollow(const char* name, const Contact& made) {
  constexpr double kWall = 0.02, kStep = 1e-5, kAny = std::numeric_limits<double>::infinity();
  struct Case {
    Vector3d p, closest;
    Vector3d moves;  // 1 if the place moves with the tip along an axis
  };
  for (const Case& one : {Case{{0.023, 0.004, 0.003}, {kWall, kAny, kAny}, {kAny, kAny, kAny}},
                          Case{{0.023, 0.004, 0.022}, {kWall, 0.004, kWall}, {0, 1, 0}},
                          Case{{0.004, -0.0215, 0.0235}, {0.004, -kWall, kWall}, {1, 0, 0}},
                          Case{{-0.022, -0.023, 0.0225}, {-kWall, -kWall, kWall}, {0, 0, 0}}}) {
    const auto closest_at = [&](const Vector3d& tip) {
      Contact contact = made;
      constexpr int kIn = 300;
      for (int i = 0; i <= kIn; ++i) contact.update(at(one.p * i / kIn));
      EXPECT_TRUE(contact.update(at(tip)).touching) << name;
      return closest_point_of(contact, tip);
    };
    const ClosestSurfacePoint closest = closest_at(one.p);
    for (int k = 0; k < 3; ++k) {
      const Vector3d axis = Vector3d::Unit(k);
      if (one.closest[k] < kAny) {
        EXPECT_NEAR(closest.p_M[k], one.closest[k], 1e-8) << name;
      }
      const Vector3d moved =
          (closest_at(one.p + kStep * axis).p_M - closest_at(one.p - kStep * axis).p_M) /
          (2 * kStep);
      if (one.moves[k] < kAny) {
        EXPECT_LT((moved - one.moves[k] * axis).norm(), 1e-5) << name;
      }
      EXPECT_LT((closest.J_MT.col(k) - moved).norm(), 1e-5) << name << ", axis " << k;
    }
  }
}

TEST(TexturePlace, InAGrooveIsOnTheEdgeOrCorner) {
  const TriangleMesh hollow = support::block_around(support::box({0.02, 0.02, 0.02}), 0.05);
  const auto mesh = std::make_shared<const ContactMesh>(ContactMesh::build(hollow).value());
  const auto search = make_search(*mesh);
  const auto normals = std::make_shared<const SmoothNormals>(*mesh);
  expect_places_in_a_hollow("edge_planes", MeshContact(mesh, search));
  expect_places_in_a_hollow("edge_planes, phong", Blended<MeshContact, Phong>(
                                                      MeshContact(mesh, search), Phong(), normals));
  expect_places_in_a_hollow("offset", Blended<OffsetContact, Phong, CurvedDepth>(
                                          OffsetContact(mesh, search, normals), Phong(), normals));
  expect_places_in_a_hollow("compact", InMemoryContact(PackedSurface::build(*mesh).value()));
  expect_places_in_a_hollow("god_object", GodObjectContact(mesh, search));
}

TEST(TexturePlace, IsContinuousAndSteadyUnderARestingHand) {
  ClosestPointFollower place;
  ClosestSurfacePoint found;
  found.p_M = {0, 0, 0};
  found.J_MT.setIdentity();
  EXPECT_EQ(place.follow({0, 0, -0.001}, 0.001, found).p_M, found.p_M);
  found.p_M = {0.002, 0, 0};  // a cell of another part of the surface
  EXPECT_EQ(place.follow({0, 0, -0.001}, 0.001, found).p_M.x() < 1e-12, true);
  Vector3d before(0, 0, 0);
  double p = 0;
  for (int i = 0; i < 100; ++i) {
    p += 1e-5;
    const ClosestSurfacePoint felt = place.follow({p, 0, -0.001}, 0.001, found);
    EXPECT_LE((felt.p_M - before).norm(), 4e-5 + 1e-12);
    const bool arrived = felt.p_M == found.p_M;
    EXPECT_EQ(felt.J_MT.norm() > 0, arrived);
    before = felt.p_M;
  }
  EXPECT_EQ(before, found.p_M);
  // A surface that moves counts as path as well.
  found.p_M.x() += 3e-5;
  found.surface_path = 1e-5;
  EXPECT_EQ(place.follow({p, 0, -0.001}, 0.001, found).p_M, found.p_M);
}

TEST(TexturePlace, FindsClosestPointsWithoutAllocation) {
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
