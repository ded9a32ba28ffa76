#include "thimble/render/build_object_touch.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <iostream>
#include <limits>
#include <map>
#include <memory>
#include <numbers>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "support/meshes/made_solids.h"
#include "support/meshes/shapes.h"
#include "support/random.h"
#include "surface_turns.h"
#include "thimble/driver/device_state.h"
#include "thimble/render/mesh/mesh_file.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;
using support::rounded_block;
using support::split_in_plane;
using support::turned;
namespace fs = std::filesystem;

constexpr double kStiffness = 1000;  // N/m
constexpr double kDegrees = 180 / std::numbers::pi;

/// A mesh with the expected choice.
struct Case {
  std::string name;
  TriangleMesh mesh;
  TrackerChoice tracker = TrackerChoice::kEdgePlanes;
  std::string reason;  // begin of the reason
};

TriangleMesh prism(int sides) {
  return turned({{0.02, 0.02}, {0.02, 0.007}, {0.02, -0.007}, {0.02, -0.02}}, sides);
}

TriangleMesh chamfered_die() {
  // 45 degrees between the chamfers and the faces of a block of four sides.
  const double in = 0.004 * std::numbers::sqrt2;
  return split_in_plane(
      turned({{0.02 - in, 0.02}, {0.02, 0.016}, {0.02, -0.016}, {0.02 - in, -0.02}}, 4));
}

/// A shaft with a shoulder: two cylinders and a flat ring between them.
TriangleMesh shaft() {
  return turned({{0.01, 0.03},
                 {0.01, 0.02},
                 {0.01, 0.01},
                 {0.02, 0.01},
                 {0.02, 0},
                 {0.02, -0.01},
                 {0.02, -0.02}},
                64);
}

/// A cylinder with a chamfer of 30 degrees to the side.
TriangleMesh chamfered_cylinder() {
  const double in = 0.004 * std::tan(std::numbers::pi / 6);
  return turned({{0.02 - in, 0.016}, {0.02, 0.012}, {0.02, 0.004}, {0.02, -0.004}, {0.02, -0.012}},
                64);
}

TriangleMesh shipped(const std::string& name) {
  return load_mesh(fs::path(THIMBLE_SOURCE_DIR) / "app" / "scenes" / name).value();
}

std::vector<Case> cases() {
  using enum TrackerChoice;
  std::vector<Case> all{
      {"die", support::box({0.02, 0.02, 0.02}), kEdgePlanes, "faceted: 12 triangles"},
      {"fine die", split_in_plane(split_in_plane(support::box({0.02, 0.02, 0.02}))), kEdgePlanes,
       "faceted: 100 % of the area is flat"},
      {"chamfered die", chamfered_die(), kEdgePlanes, "faceted: 100 % of the area is flat"},
      {"nut of ten sides", prism(10), kEdgePlanes, "faceted: its faces turn by 36 degrees"},
      {"plate", support::plate(0.05, 0.002, 8), kEdgePlanes, "faceted: 100 % of the area is flat"},
      {"block with rounded edges", rounded_block(0.02, 0.002, 4, 0.03), kEdgePlanes,
       "faceted: large triangles"},
      {"icosahedron", support::icosphere(0, 0.02), kEdgePlanes, "faceted: 20 triangles"},
      {"ball of 80 triangles", support::icosphere(1, 0.02), kPacked, "smooth: 100 %"},
      {"ball", support::icosphere(3, 0.02), kPacked, "smooth: 100 %"},
      {"fine ball", support::icosphere(5, 0.02), kPacked, "smooth: 100 %"},
      {"ring", support::torus(0.03, 0.01, 48, 24), kPacked, "smooth: 100 %"},
      {"bumpy ball", support::bumpy_sphere(4, 0.03, 0.2, 3), kPacked, "smooth: 100 %"},
      {"shaft", shaft(), kPacked, "smooth: "},
      {"chamfered cylinder", chamfered_cylinder(), kPacked, "smooth: "},
      {"cylinder of 16 sides", prism(16), kPacked, "smooth: "},
      {"prism of 16 split sides", split_in_plane(split_in_plane(prism(16))), kEdgePlanes,
       "faceted: "},
      {"clay ball", shipped("clay_ball.off"), kPacked, "smooth: 100 %"},
      {"tin can", shipped("tin_can.off"), kPacked, "smooth: 75 %"},
      {"drum", shipped("trampoline.off"), kEdgePlanes, "faceted: 100 % of the area is flat"},
  };
  for (const auto& [name, tracker, reason] :
       {std::tuple{"elephant.off", kPacked, "smooth: 100 %"},
        std::tuple{"fandisk.off", kPacked, "smooth: 56 %"},
        std::tuple{"cube-meshed.off", kEdgePlanes, "faceted: 100 %"},
        std::tuple{"handle.off", kEdgePlanes, "faceted: large triangles"},
        std::tuple{"lion.off", kEdgePlanes, "not closed"}}) {
    const fs::path file = fs::path(THIMBLE_MESHES) / name;
    if (fs::exists(file)) all.push_back({name, load_mesh(file).value(), tracker, reason});
  }
  return all;
}

TEST(ChooseTracker, SuitsEachMeshOfTheTable) {
  for (const Case& one : cases()) {
    const ChosenTracker chosen = choose_tracker(one.mesh);
    EXPECT_EQ(chosen.contact.tracker, one.tracker) << one.name << ": " << chosen.reason;
    EXPECT_EQ(chosen.reason.substr(0, one.reason.size()), one.reason) << one.name;
  }
}

TEST(ChooseTracker, IgnoresTheScaleOfTheMesh) {
  for (const Case& one : cases()) {
    const ChosenTracker chosen = choose_tracker(one.mesh);
    for (const double factor : {1e-6, 0.37, 25.4, 1e6}) {
      TriangleMesh scaled = one.mesh;
      for (Vector3d& p : scaled.vertices) p *= factor;
      const ChosenTracker again = choose_tracker(scaled);
      EXPECT_EQ(again.contact, chosen.contact) << one.name << " times " << factor;
      EXPECT_EQ(again.reason, chosen.reason) << one.name << " times " << factor;
    }
  }
}

TEST(ChooseTracker, IgnoresTheNumbersOfVerticesAndTriangles) {
  support::Random random(std::uint64_t{7});
  for (const Case& one : cases()) {
    const ChosenTracker chosen = choose_tracker(one.mesh);
    TriangleMesh mixed = one.mesh;
    std::vector<std::int32_t> place(mixed.vertices.size());
    for (std::size_t v = 0; v < place.size(); ++v) place[v] = static_cast<std::int32_t>(v);
    const auto shuffle = [&random](auto& list) {
      for (std::size_t i = list.size(); i > 1; --i) std::swap(list[i - 1], list[random.bits() % i]);
    };
    shuffle(place);
    shuffle(mixed.triangles);
    for (std::size_t v = 0; v < place.size(); ++v) {
      mixed.vertices[static_cast<std::size_t>(place[v])] = one.mesh.vertices[v];
    }
    for (auto& corners : mixed.triangles) {
      for (std::int32_t& corner : corners) corner = place[static_cast<std::size_t>(corner)];
      std::rotate(corners.begin(), corners.begin() + random.bits() % 3, corners.end());
    }
    const ChosenTracker again = choose_tracker(mixed);
    EXPECT_EQ(again.contact, chosen.contact) << one.name;
    EXPECT_EQ(again.reason, chosen.reason) << one.name;
  }
}

/// A cube of 12 n^2 triangles. `round`: projected to a ball, so that its triangles are about as
/// large as each other. Its axes are tilted, and its coordinates are those of a file in single
/// precision.
TriangleMesh fine_cube(int n, bool round) {
  TriangleMesh mesh;
  const Eigen::Matrix3d R = Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()).matrix();
  const auto along = [&](int i) {
    const double place = 2.0 * i / n - 1;
    return round ? std::tan(place * std::numbers::pi / 4) : place;
  };
  std::map<std::array<int, 3>, std::int32_t> shared;  // vertices on the edges of the cube
  for (int side = 0; side < 6; ++side) {
    const int axis = side / 2;
    const auto vertex = [&](int i, int j) {
      std::array<int, 3> place{};
      place[static_cast<std::size_t>(axis)] = side % 2 == 0 ? 0 : n;
      place[static_cast<std::size_t>((axis + 1) % 3)] = i;
      place[static_cast<std::size_t>((axis + 2) % 3)] = j;
      const auto add = [&] {
        Vector3d p(along(place[0]), along(place[1]), along(place[2]));
        if (round) p.normalize();
        mesh.vertices.push_back((R * (0.02 * p)).cast<float>().cast<double>());
        return static_cast<std::int32_t>(mesh.vertices.size() - 1);
      };
      if (i > 0 && i < n && j > 0 && j < n) return add();
      const auto [found, is_new] = shared.try_emplace(place, 0);
      if (is_new) found->second = add();
      return found->second;
    };
    std::vector<std::int32_t> grid;
    for (int i = 0; i <= n; ++i) {
      for (int j = 0; j <= n; ++j) grid.push_back(vertex(i, j));
    }
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        const auto at = [&](int a, int b) {
          return grid[static_cast<std::size_t>((i + a) * (n + 1) + j + b)];
        };
        // Counter-clockwise from outside on the upper side of each axis.
        const bool upper = side % 2 == 1;
        mesh.triangles.push_back({at(0, 0), at(upper ? 1 : 0, upper ? 0 : 1), at(1, 1)});
        mesh.triangles.push_back({at(0, 0), at(1, 1), at(upper ? 0 : 1, upper ? 1 : 0)});
      }
    }
  }
  return mesh;
}

TEST(ChooseTracker, FineBallsAreSmoothAndFineDiceFaceted) {
  for (const int n : {29, 91, 160, 170, 289, 577}) {  // 10^4 to 4 10^6 triangles
    const ChosenTracker ball = choose_tracker(fine_cube(n, true));
    EXPECT_EQ(ball.contact.tracker, TrackerChoice::kPacked) << n << ": " << ball.reason;
    EXPECT_EQ(ball.reason.substr(0, 14), "smooth: 100 % ") << n;
    const ChosenTracker die = choose_tracker(fine_cube(n, false));
    EXPECT_EQ(die.contact.tracker, TrackerChoice::kEdgePlanes) << n << ": " << die.reason;
    EXPECT_EQ(die.reason, "faceted: 100 % of the area is flat") << n;
  }
}

TEST(ChooseTracker, RoundingOfABarOfNarrowStripsIsFlat) {
  // A tilted bar of narrow strips along its sides, with coordinates in single precision.
  constexpr int kStrips = 2000;  // of each side
  constexpr double kHalf = 0.02;
  const Eigen::Matrix3d R = Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()).matrix();
  TriangleMesh mesh;
  const auto add = [&](double x, double y, double z) {
    mesh.vertices.push_back((R * Vector3d(x, y, z)).cast<float>().cast<double>());
    return static_cast<std::int32_t>(mesh.vertices.size() - 1);
  };
  const std::int32_t bottom = add(0, 0, -kHalf), top = add(0, 0, kHalf);
  std::vector<std::array<std::int32_t, 2>> rim;
  for (int side = 0; side < 4; ++side) {
    for (int i = 0; i < kStrips; ++i) {
      const double along = kHalf * (2.0 * i / kStrips - 1);
      const double x = side == 0 ? along : side == 1 ? kHalf : side == 2 ? -along : -kHalf;
      const double y = side == 0 ? -kHalf : side == 1 ? along : side == 2 ? kHalf : -along;
      rim.push_back({add(x, y, -kHalf), add(x, y, kHalf)});
    }
  }
  for (std::size_t i = 0; i < rim.size(); ++i) {
    const auto& [a, b] = rim[i];
    const auto& [c, d] = rim[(i + 1) % rim.size()];
    for (const auto& corners : {std::array{a, c, d}, {a, d, b}, {bottom, c, a}, {top, b, d}}) {
      mesh.triangles.push_back(corners);
    }
  }
  const ChosenTracker chosen = choose_tracker(mesh);
  EXPECT_EQ(chosen.contact.tracker, TrackerChoice::kEdgePlanes) << chosen.reason;
}

TEST(ChooseTracker, SlightCurvatureOfAFinePlateIsFlat) {
  // A cap with a radius of 20 times its width, on a die.
  TriangleMesh mesh = fine_cube(91, false);
  for (Vector3d& p : mesh.vertices) p += p.squaredNorm() / (2 * 0.8) * p.normalized();
  EXPECT_EQ(choose_tracker(mesh).contact.tracker, TrackerChoice::kEdgePlanes);
}

/// Returns the force on a tip that comes from `from` and stops at `to`.
Vector3d force_at(const TriangleMesh& mesh, const ContactChoice& choice, const Vector3d& from,
                  const Vector3d& to) {
  const auto object = build_object_touch(mesh, choice, {.spring = {.stiffness = kStiffness}});
  if (!object) {
    ADD_FAILURE() << object.error().message;
    return Vector3d::Zero();
  }
  driver::DeviceState state;
  Vector3d force = Vector3d::Zero();
  constexpr int kTicks = 20;
  for (int i = 0; i <= kTicks; ++i) {
    state.tick = static_cast<std::uint64_t>(i);
    state.dt = 1e-3;
    state.p_WT = from + static_cast<double>(i) / kTicks * (to - from);
    force = (*object)->update(state).f_T_W;
  }
  return force;
}

double angle_between(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

TEST(ChooseTracker, KeepsTheRimOfAShaftSharp) {
  const TriangleMesh mesh = shaft();
  const ContactChoice choice = choose_tracker(mesh).contact;
  ASSERT_EQ(choice.tracker, TrackerChoice::kPacked);
  // 0.3 mm from the rim of the shoulder, on its flat ring and on the cylinder.
  for (int i = 0; i < 40; ++i) {
    const double angle = 0.157 * i;
    const Vector3d out(std::cos(angle), std::sin(angle), 0);
    const Vector3d on_top = 0.0194 * out + Vector3d(0, 0, 0.01);
    const Vector3d top =
        force_at(mesh, choice, on_top + Vector3d(0, 0, 1e-3), on_top - Vector3d(0, 0, 1e-4));
    EXPECT_LT(angle_between(top, Vector3d::UnitZ()), 1e-3) << i;
    const Vector3d on_side = 0.02 * out + Vector3d(0, 0, 0.0097);
    const Vector3d side = force_at(mesh, choice, on_side + 1e-3 * out, on_side - 1e-4 * out);
    EXPECT_LT(angle_between(side, out), 0.3 / kDegrees) << i;
  }
}

TEST(ChooseTracker, KeepsAChamferOfThirtyDegreesSharp) {
  const TriangleMesh mesh = chamfered_cylinder();
  const ContactChoice choice = choose_tracker(mesh).contact;
  ASSERT_TRUE(choice.crease_angle.has_value());
  EXPECT_GT(*choice.crease_angle, 2 * std::numbers::pi / 64);
  EXPECT_LT(*choice.crease_angle, std::numbers::pi / 6);
  // In the middle of a side of the chamfer, near its lower rim.
  const double angle = std::numbers::pi / 64;
  const Vector3d out(std::cos(angle), std::sin(angle), 0);
  const Vector3d n =
      std::cos(std::numbers::pi / 6) * out + std::sin(std::numbers::pi / 6) * Vector3d::UnitZ();
  const Vector3d rim = 0.02 * std::cos(angle) * out + Vector3d(0, 0, 0.012);
  const Vector3d up = (Vector3d::UnitZ() - n.z() * n).normalized();
  const Vector3d p = rim + 3e-4 * up;
  EXPECT_LT(angle_between(force_at(mesh, choice, p + 1e-3 * n, p - 1e-4 * n), n), 0.3 / kDegrees);
  // The default crease angle of the tracker would smooth it.
  const ContactChoice plain{.tracker = TrackerChoice::kPacked};
  EXPECT_GT(angle_between(force_at(mesh, plain, p + 1e-3 * n, p - 1e-4 * n), n), 5 / kDegrees);
}

/// A solid whose true surface is known.
struct Known {
  std::string name;
  TriangleMesh mesh;
  /// Draws a point of the true surface and its normal.
  std::function<std::pair<Vector3d, Vector3d>(support::Random&)> draw;
};

/// Returns the error of the force, RMS, relative to the force, at a depth of 0.2 mm.
double force_error(const Known& solid, const ContactChoice& choice) {
  constexpr double kDepth = 2e-4;
  support::Random random(std::uint64_t{3});
  double squares = 0;
  constexpr int kPoints = 100;
  for (int i = 0; i < kPoints; ++i) {
    const auto [p, n] = solid.draw(random);
    const Vector3d force = force_at(solid.mesh, choice, p + 2e-3 * n, p - kDepth * n);
    squares += (force / (kStiffness * kDepth) - n).squaredNorm();
  }
  return std::sqrt(squares / kPoints);
}

std::pair<Vector3d, Vector3d> on_cylinder(double radius, double angle, double z) {
  const Vector3d out(std::cos(angle), std::sin(angle), 0);
  return {radius * out + Vector3d(0, 0, z), out};
}

std::vector<Known> known_solids() {
  const auto ball = [](support::Random& random) {
    const Vector3d n = random.direction();
    return std::pair<Vector3d, Vector3d>(0.02 * n, n);
  };
  const auto barrel = [](support::Random& random) {
    return on_cylinder(0.02, random.uniform(0, 2 * std::numbers::pi),
                       random.uniform(-0.015, 0.015));
  };
  const auto shoulder = [](support::Random& random) {
    const double angle = random.uniform(0, 2 * std::numbers::pi);
    if (random.uniform(0, 1) < 0.5) return on_cylinder(0.02, angle, random.uniform(-0.015, 0.007));
    const Vector3d out(std::cos(angle), std::sin(angle), 0);
    return std::pair<Vector3d, Vector3d>(random.uniform(0.013, 0.018) * out + Vector3d(0, 0, 0.01),
                                         Vector3d::UnitZ());
  };
  const auto ring = [](support::Random& random) {
    const double u = random.uniform(0, 2 * std::numbers::pi);
    const double v = random.uniform(0, 2 * std::numbers::pi);
    const Vector3d out(std::cos(u), std::sin(u), 0);
    const Vector3d n = std::cos(v) * out + std::sin(v) * Vector3d::UnitZ();
    return std::pair<Vector3d, Vector3d>(0.03 * out + 0.01 * n, n);
  };
  // A prism taken as what it is: the middle of one of its sides, to 80 % of their width.
  const auto side_of = [](int sides) {
    return [sides](support::Random& random) {
      const double half = std::numbers::pi / sides;
      const auto side = static_cast<double>(random.bits() % static_cast<std::uint64_t>(sides));
      const double angle = half * (2 * side + 1);
      const Vector3d n(std::cos(angle), std::sin(angle), 0);
      const Vector3d along(-n.y(), n.x(), 0);
      const double at = 0.8 * random.uniform(-1, 1) * 0.02 * std::sin(half);
      return std::pair<Vector3d, Vector3d>(
          0.02 * std::cos(half) * n + at * along + Vector3d(0, 0, random.uniform(-0.015, 0.015)),
          n);
    };
  };
  const auto rounded = [](support::Random& random) {
    const double at = random.uniform(-0.016, 0.016);
    return std::pair<Vector3d, Vector3d>({0.02, at, random.uniform(-0.012, 0.012)},
                                         Vector3d::UnitX());
  };
  return {{"ball of 80", support::icosphere(1, 0.02), ball},
          {"ball of 1280", support::icosphere(3, 0.02), ball},
          {"ring", support::torus(0.03, 0.01, 48, 24), ring},
          {"shaft", shaft(), shoulder},
          {"cylinder of 16 sides", prism(16), barrel},
          {"cylinder of 32 sides", prism(32), barrel},
          {"nut of 6 sides", prism(6), side_of(6)},
          {"nut of 10 sides", prism(10), side_of(10)},
          {"nut of 12 sides", prism(12), side_of(12)},
          {"fine die", split_in_plane(prism(4)), side_of(4)},
          {"block with rounded edges", rounded_block(0.02, 0.002, 4, 0.03), rounded}};
}

TEST(ChooseTracker, HasTheSmallerErrorOnKnownSolids) {
  for (const Known& solid : known_solids()) {
    const ChosenTracker chosen = choose_tracker(solid.mesh);
    const double flat = force_error(solid, {.tracker = TrackerChoice::kEdgePlanes});
    const double smooth = force_error(solid, {.tracker = TrackerChoice::kPacked});
    const double own = force_error(solid, chosen.contact);
    std::cout << solid.name << ": edge_planes " << 100 * flat << " %, compact " << 100 * smooth
              << " %, chosen " << 100 * own << " % ("
              << kTrackerNames[static_cast<std::size_t>(chosen.contact.tracker)] << ", "
              << chosen.reason << ")\n";
    EXPECT_LE(own, std::min(flat, smooth) + 1e-3) << solid.name;
  }
}

TEST(ChooseTracker, IsEdgePlanesWhereCompactCannotServe) {
  const TriangleMesh ball = support::icosphere(3, 0.02);
  const auto reason = [&](const ContactChoice& contact, const SurfaceChoice& surface = {}) {
    const ChosenTracker chosen = choose_tracker(ball, contact, surface);
    EXPECT_EQ(chosen.contact.tracker, TrackerChoice::kEdgePlanes) << chosen.reason;
    EXPECT_TRUE(build_object_touch(ball, chosen.contact, surface).ok()) << chosen.reason;
    return chosen.reason;
  };
  EXPECT_EQ(reason({.blending = BlendingChoice::kFlat}), "blending is set");
  EXPECT_EQ(reason({.normals = NormalWeights::kRound}), "normals is set");
  EXPECT_EQ(reason({.curved_depth = true}), "curved_depth is set");
  EXPECT_EQ(reason({.band = 0.002}), "band is set");
  EXPECT_EQ(reason({}, {.spring = {.stiffness = kStiffness}, .dent = DentSettings()}),
            "its surface dents");
  EXPECT_EQ(reason({}, {.spring = {.stiffness = kStiffness}, .shape = {.clay = ClayChoice()}}),
            "its shape changes");
}

TEST(ChooseTracker, IsTheGodObjectForClayThatSplitsTriangles) {
  const TriangleMesh ball = support::icosphere(3, 0.02);
  const SurfaceChoice surface{.spring = {.stiffness = kStiffness},
                              .shape = {.clay = ClayChoice{.edge = 1e-3}}};
  const ChosenTracker chosen = choose_tracker(ball, {}, surface);
  EXPECT_EQ(chosen.contact.tracker, TrackerChoice::kGodObject);
  EXPECT_TRUE(build_object_touch(ball, chosen.contact, surface).ok());
}

TEST(ChooseTracker, LeavesContactOfATipWithARadiusAlone) {
  const ContactChoice ball_tip{.tracker = TrackerChoice::kOffset, .tip_radius = 0.004};
  EXPECT_EQ(choose_tracker(support::icosphere(3, 0.02), ball_tip).contact, ball_tip);
}

TEST(ChooseTracker, KeepsASearchAndACreaseAngleThatAreSet) {
  const ContactChoice set{.search = SearchChoice::kTree, .crease_angle = 0.2};
  const ContactChoice chosen = choose_tracker(chamfered_cylinder(), set).contact;
  EXPECT_EQ(chosen.tracker, TrackerChoice::kPacked);
  EXPECT_EQ(chosen.search, set.search);
  EXPECT_EQ(chosen.crease_angle, set.crease_angle);
}

TEST(ChooseTracker, NamesNoCreaseAngleIfNoEdgeDependsOnIt) {
  EXPECT_FALSE(choose_tracker(support::icosphere(4, 0.02)).contact.crease_angle.has_value());
}

TEST(ChooseTracker, AcceptsAnyMesh) {
  TriangleMesh mesh = support::icosphere(2, 0.02);
  EXPECT_EQ(choose_tracker({}).reason, "not closed");
  TriangleMesh holed = mesh;
  holed.triangles.pop_back();
  EXPECT_EQ(choose_tracker(holed).reason, "not closed");
  TriangleMesh flipped = mesh;
  std::swap(flipped.triangles[5][0], flipped.triangles[5][1]);
  EXPECT_EQ(choose_tracker(flipped).reason, "not closed");
  for (const double value : {std::nan(""), std::numeric_limits<double>::infinity(), 1e300}) {
    TriangleMesh wild = mesh;
    wild.vertices[3].x() = value;
    EXPECT_EQ(choose_tracker(wild).reason, "not closed") << value;
  }
  for (const std::int32_t number : {-1, 1 << 30, std::numeric_limits<std::int32_t>::min()}) {
    TriangleMesh wrong = mesh;
    wrong.triangles[3][1] = number;
    EXPECT_EQ(choose_tracker(wrong).reason, "not closed") << number;
  }
}

TEST(SurfaceTurns, FindThePartsOfACylinder) {
  // 64 sides: 5.6 degrees; barrel and two caps, the caps 1/3 of the area.
  const SurfaceTurns turns = surface_turns(turned({{0.02, 0.02}, {0.02, -0.02}}, 64));
  EXPECT_TRUE(turns.closed);
  double curved = 0;
  for (std::size_t i = 0; i < SurfaceTurns::kClasses; ++i) {
    curved += turns.curved[i];
    if (turns.curved[i] > 0) {
      EXPECT_NEAR(SurfaceTurns::turn_of(i) * kDegrees, 5.625, 0.95);
    }
  }
  EXPECT_NEAR(curved, 2.0 / 3, 1e-3);
  EXPECT_GT(turns.sharp, 0.2);
}

}  // namespace
}  // namespace thimble::render
