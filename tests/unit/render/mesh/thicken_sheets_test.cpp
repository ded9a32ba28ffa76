#include "thimble/render/mesh/thicken_sheets.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "support/meshes/shapes.h"
#include "support/random.h"
#include "thimble/render/mesh/check_mesh.h"
#include "thimble/render/mesh/repair_mesh.h"
#include "track/god_object.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

constexpr double kThickness = 0.001;  // m
constexpr double kStiffness = 500;    // N/m

// A square sheet about the origin, normal along z.
TriangleMesh sheet(double side, int cells) {
  TriangleMesh mesh;
  for (int i = 0; i <= cells; ++i) {
    for (int j = 0; j <= cells; ++j) {
      mesh.vertices.emplace_back(side * (static_cast<double>(i) / cells - 0.5),
                                 side * (static_cast<double>(j) / cells - 0.5), 0);
    }
  }
  for (int i = 0; i < cells; ++i) {
    for (int j = 0; j < cells; ++j) {
      const int a = i * (cells + 1) + j, b = a + cells + 1;
      mesh.triangles.push_back({a, b, b + 1});
      mesh.triangles.push_back({a, b + 1, a + 1});
    }
  }
  return mesh;
}

TriangleMesh moebius_strip(int pieces) {
  TriangleMesh mesh;
  for (int i = 0; i < pieces; ++i) {
    const double a = 2 * std::numbers::pi * i / pieces;
    for (const double w : {-0.02, 0.02}) {
      const double r = 0.05 + w * std::cos(a / 2);
      mesh.vertices.emplace_back(r * std::cos(a), r * std::sin(a), w * std::sin(a / 2));
    }
  }
  for (int i = 0; i < pieces; ++i) {
    const bool last = i + 1 == pieces;
    const int a = 2 * i, b = a + 1, c = last ? 1 : a + 2, d = last ? 0 : a + 3;
    mesh.triangles.push_back({a, c, d});
    mesh.triangles.push_back({a, d, b});
  }
  return mesh;
}

// Half planes that share one edge.
TriangleMesh book(int pages) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, -0.05}, {0, 0, 0.05}};
  for (int i = 0; i < pages; ++i) {
    const double a = 2 * std::numbers::pi * i / pages + 0.1;
    const int first = static_cast<int>(mesh.vertices.size());
    for (const double z : {-0.05, 0.05}) {
      mesh.vertices.emplace_back(0.05 * std::cos(a), 0.05 * std::sin(a), z);
    }
    // Random orientation.
    if (i % 2 == 0) {
      mesh.triangles.push_back({0, first, first + 1});
      mesh.triangles.push_back({0, first + 1, 1});
    } else {
      mesh.triangles.push_back({0, first + 1, first});
      mesh.triangles.push_back({0, 1, first + 1});
    }
  }
  return mesh;
}

void expect_closed(const TriangleMesh& mesh, const std::string& what) {
  const ThickenedMesh thick = thicken_sheets(mesh, kThickness);
  for (const MeshFault& fault : check_mesh(thick.mesh).faults) {
    ADD_FAILURE() << what << ": " << describe(fault);
  }
}

TEST(ThickenSheets, MakesAThinBodyOfASheet) {
  const ThickenedMesh thick = thicken_sheets(sheet(0.1, 10), kThickness);
  const MeshFindings found = check_mesh(thick.mesh);
  EXPECT_TRUE(found.touchable());
  EXPECT_EQ(found.components, 1u);
  EXPECT_NEAR(found.volume, 0.1 * 0.1 * kThickness, 1e-12);
  EXPECT_NEAR(found.box_max.z() - found.box_min.z(), kThickness, 1e-12);
  EXPECT_EQ(thick.report.sheets, 1u);
  EXPECT_EQ(thick.report.triangles, 200u);
  EXPECT_DOUBLE_EQ(thick.report.thinnest, kThickness);
}

TEST(ThickenSheets, ClosesOneSidedAndMultiplePageSheets) {
  expect_closed(moebius_strip(40), "Moebius strip");
  for (int pages = 2; pages < 8; ++pages) expect_closed(book(pages), std::to_string(pages));
  TriangleMesh triangle;
  triangle.vertices = {{0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}};
  triangle.triangles = {{0, 1, 2}};
  expect_closed(triangle, "triangle");
  // A fin on a body makes a sheet of both.
  TriangleMesh fin = support::box(Vector3d::Constant(0.05));
  fin.triangles.push_back({0, 1, support::add_vertex(fin, {0, -0.1, -0.1})});
  expect_closed(fin, "box with a fin");
}

TEST(ThickenSheets, DoesNotChangeClosedParts) {
  TriangleMesh mesh = support::icosphere(2, 0.05);
  const std::size_t closed = mesh.triangles.size();
  const TriangleMesh beside = sheet(0.1, 2);
  const auto first = static_cast<std::int32_t>(mesh.vertices.size());
  for (const Vector3d& p : beside.vertices) mesh.vertices.push_back(p + Vector3d(0, 0, 0.2));
  for (const auto& [a, b, c] : beside.triangles) {
    mesh.triangles.push_back({first + a, first + b, first + c});
  }
  const ThickenedMesh thick = thicken_sheets(mesh, kThickness);
  EXPECT_TRUE(check_mesh(thick.mesh).touchable());
  EXPECT_EQ(thick.report.sheets, 1u);
  for (std::size_t t = 0; t < closed; ++t) EXPECT_EQ(thick.mesh.triangles[t], mesh.triangles[t]);
}

// Random triangles over few vertices: edges of many triangles, and fans that meet at corners.
TEST(ThickenSheets, ClosesRandomlyConnectedTriangles) {
  support::Random random(31);
  for (int round = 0; round < 300; ++round) {
    TriangleMesh mesh;
    const int vertices = 4 + static_cast<int>(random.bits() % 8);
    for (int i = 0; i < vertices; ++i) mesh.vertices.push_back(random.in_box(0.05));
    const int triangles = 1 + static_cast<int>(random.bits() % 14);
    for (int i = 0; i < triangles; ++i) {
      std::array<std::int32_t, 3> t;
      for (auto& v : t)
        v = static_cast<std::int32_t>(random.bits() % static_cast<unsigned>(vertices));
      mesh.triangles.push_back(t);
    }
    const RepairedMesh cleaned = repair_mesh(mesh);
    if (cleaned.mesh.triangles.empty()) continue;
    const ThickenedMesh thick = thicken_sheets(cleaned.mesh, kThickness);
    TriangleMesh oriented = thick.mesh;
    orient_mesh(oriented);
    const auto built = ContactMesh::build(oriented);
    EXPECT_TRUE(built.ok()) << round << ": " << built.error().message;
  }
}

// The same on a lattice, where triangles are coplanar and on top of each other.
TEST(ThickenSheets, ClosesCoplanarOverlappingTriangles) {
  support::Random random(32);
  for (int round = 0; round < 300; ++round) {
    TriangleMesh mesh;
    for (int i = 0; i < 9; ++i) mesh.vertices.emplace_back(0.01 * (i % 3), 0.01 * (i / 3), 0);
    mesh.vertices.emplace_back(0.01, 0.01, 0.01);
    for (int i = 0; i < 10; ++i) {
      std::array<std::int32_t, 3> t;
      for (auto& v : t) v = static_cast<std::int32_t>(random.bits() % 10);
      mesh.triangles.push_back(t);
    }
    const RepairedMesh cleaned = repair_mesh(mesh);
    const ThickenedMesh thick = thicken_sheets(cleaned.mesh, 0.1 * kThickness);
    for (const MeshFault& fault : check_mesh(thick.mesh).faults) {
      EXPECT_EQ(fault.kind, MeshFault::Kind::kInsideOut) << round << ": " << describe(fault);
    }
  }
}

TEST(ThickenSheets, SharpBendsMakeASheetThinner) {
  TriangleMesh pipe = sheet(0.06, 24);  // half a pipe of 3 mm, in a sheet of 10 mm
  for (Vector3d& p : pipe.vertices) {
    const double a = std::numbers::pi * (p.x() / 0.06 + 0.5);
    p = Vector3d(-0.003 * std::cos(a), p.y(), 0.003 * std::sin(a));
  }
  const ThickenedMesh thick = thicken_sheets(pipe, 0.01);
  EXPECT_TRUE(check_mesh(thick.mesh).touchable());
  EXPECT_LT(thick.report.thinnest, 0.01);
  EXPECT_GT(thick.report.thinnest, 0.0005);
  // No face has the opposite direction: fronts come first, then their backs.
  for (std::size_t t = 0; t < pipe.triangles.size(); ++t) {
    const auto normal = [](const TriangleMesh& mesh, std::size_t i) {
      const auto& [a, b, c] = mesh.triangles[i];
      const auto at = [&mesh](std::int32_t v) {
        return mesh.vertices[static_cast<std::size_t>(v)];
      };
      return Vector3d((at(b) - at(a)).cross(at(c) - at(a)).normalized());
    };
    EXPECT_GT(normal(pipe, t).dot(normal(thick.mesh, 2 * t)), 0.1) << t;
    EXPECT_LT(normal(pipe, t).dot(normal(thick.mesh, 2 * t + 1)), -0.1) << t;
  }
}

const ContactState& move(GodObjectContact& contact, const Vector3d& p_WT) {
  driver::DeviceState state;
  state.p_WT = p_WT;
  return contact.update(state);
}

TEST(ThickenSheets, HoldsADeepTipFromBothSides) {
  const ThickenedMesh thick = thicken_sheets(sheet(0.1, 10), kThickness);
  for (const double side : {1.0, -1.0}) {
    auto contact = GodObjectContact::build(thick.mesh);
    ASSERT_TRUE(contact.ok()) << contact.error().message;
    support::Random random(8);
    Vector3d p(0, 0, side * 0.01);
    move(*contact, p);
    double deepest = 0;
    for (int tick = 0; tick < 20000; ++tick) {
      // Wanders below the sheet, at most 40 mm deep and at least 10 mm from its rim.
      Vector3d to = p + random.in_box(0.001) - Vector3d(0, 0, side * 0.0001);
      to = to.cwiseMax(Vector3d(-0.04, -0.04, -0.04)).cwiseMin(Vector3d(0.04, 0.04, 0.04));
      if (side * to.z() > 0) to.z() = 0;
      p = to;
      const ContactState& state = move(*contact, p);
      ASSERT_TRUE(state.touching) << tick;
      EXPECT_GT(side * state.n_W.z(), 0.999) << tick;
      EXPECT_NEAR(state.depth, kThickness / 2 - side * p.z(), 1e-9) << tick;
      deepest = std::max(deepest, state.depth);
    }
    EXPECT_GT(deepest, 0.039);
  }
}

TEST(ThickenSheets, RepeatedEntryGivesNoEnergyToTheHand) {
  const ThickenedMesh thick = thicken_sheets(sheet(0.1, 6), kThickness);
  auto contact = GodObjectContact::build(thick.mesh);
  ASSERT_TRUE(contact.ok());
  support::Random random(17);
  for (int round = 0; round < 100; ++round) {
    // A closed path: in on one side, around below the sheet, over its rim, and out.
    std::vector<Vector3d> corners{{0, 0, 0.02}};
    for (int i = 0; i < 6; ++i) corners.push_back(random.in_box(0.06));
    corners.emplace_back(0.2, 0, 0.02);
    double work = 0;
    Vector3d force = Vector3d::Zero(), p = corners.front();
    move(*contact, Vector3d::Constant(std::nan("")));
    move(*contact, p);
    for (std::size_t i = 1; i < corners.size(); ++i) {
      for (int step = 1; step <= 4000; ++step) {
        const Vector3d to = corners[i - 1] + (corners[i] - corners[i - 1]) * (step / 4000.0);
        const ContactState& state = move(*contact, to);
        const Vector3d next =
            state.touching ? Vector3d(kStiffness * state.depth * state.n_W) : Vector3d::Zero();
        work += (force + next).dot(to - p) / 2;
        force = next;
        p = to;
      }
    }
    EXPECT_LT(work, 1e-5) << round;  // J returned to the hand; the spring stores about 1 J
  }
}

}  // namespace
}  // namespace thimble::render
