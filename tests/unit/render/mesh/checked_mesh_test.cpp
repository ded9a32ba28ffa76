#include "mesh/repair/checked_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "mesh/contact_mesh.h"
#include "mesh/repair/certainly_valid.h"
#include "mesh/repair/orient_mesh.h"
#include "mesh/repair/touching_parts.h"
#include "support/meshes/shapes.h"
#include "support/random.h"
#include "support/tracker_names.h"
#include "thimble/render/build_object_touch.h"
#include "thimble/render/mesh/check_mesh.h"

// Large meshes are checked on another thread while contact is built as if they were valid. Their
// faults must still be reported, and in the same way by every kind of contact.

namespace thimble::render {
namespace {

using support::kTrackers;

TriangleMesh ball() {
  return support::icosphere(4, 0.05);  // 5,120 triangles
}

TriangleMesh inside_out(TriangleMesh mesh) {
  for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  return mesh;
}

std::string refusal(const TriangleMesh& mesh, TrackerChoice tracker) {
  ContactChoice choice;
  choice.tracker = tracker;
  const auto touch = build_object_touch(mesh, choice, {});
  return touch ? "" : touch.error().message;
}

TEST(CheckedMesh, ReportsTheSameFaultForEveryTracker) {
  TriangleMesh hole = ball(), beyond = ball(), nowhere = ball(), doubled = ball(), empty;
  hole.triangles.erase(hole.triangles.begin() + 2000);
  beyond.triangles[3000][1] = 1 << 30;
  nowhere.vertices[100].x() = std::numeric_limits<double>::quiet_NaN();
  doubled.triangles.push_back(doubled.triangles[7]);
  for (const TriangleMesh* mesh : {&hole, &beyond, &nowhere, &doubled, &empty}) {
    ASSERT_FALSE(check_contact_mesh(*mesh, true));
    const std::string told = check_contact_mesh(*mesh, true).error().message;
    EXPECT_NE(told.find("The mesh "), std::string::npos) << told;
    for (const TrackerChoice tracker : kTrackers) {
      EXPECT_EQ(refusal(*mesh, tracker), told) << static_cast<int>(tracker);
    }
  }
}

TEST(CheckedMesh, OrientsALargeInsideOutMeshForEveryTracker) {
  const TriangleMesh wrong = inside_out(ball());
  ASSERT_TRUE(check_contact_mesh(wrong, true));
  EXPECT_TRUE(check_contact_mesh(wrong, true)->turned);
  EXPECT_FALSE(check_contact_mesh(ball(), true)->turned);
  EXPECT_FALSE(check_contact_mesh(wrong, false)) << "unless it may not be turned";
  const auto mesh = ContactMesh::build(wrong);
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->turned_components(), 1u);
  for (const TrackerChoice tracker : kTrackers) {
    ContactChoice choice;
    choice.tracker = tracker;
    auto right = build_object_touch(ball(), choice, {}).value();
    auto turned = build_object_touch(wrong, choice, {}).value();
    driver::DeviceState state;
    for (const double radius : {0.06, 0.0495, 0.049}) {
      state.p_WT = radius * Eigen::Vector3d(0.6, -0.64, 0.48);
      const auto a = right->update(state), b = turned->update(state);
      EXPECT_LT((a.f_T_W - b.f_T_W).norm(), 1e-9) << static_cast<int>(tracker);
      EXPECT_EQ(a.touch.in_contact, radius < 0.0498) << static_cast<int>(tracker);
      EXPECT_EQ(b.touch.in_contact, radius < 0.0498) << static_cast<int>(tracker);
    }
  }
}

bool surely(const TriangleMesh& mesh) {
  const auto neighbours = find_adjacency(mesh);
  return neighbours && certainly_valid(mesh, *neighbours);
}

TriangleMesh joined(const TriangleMesh& a, const TriangleMesh& b) {
  TriangleMesh both = a;
  const auto first = static_cast<std::int32_t>(a.vertices.size());
  both.vertices.insert(both.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const auto& [i, j, k] : b.triangles) {
    both.triangles.push_back({i + first, j + first, k + first});
  }
  return both;
}

TEST(CertainlyValid, AcceptsSingleBodies) {
  for (const TriangleMesh& mesh :
       {ball(), support::bumpy_sphere(3, 0.05, 0.3, 6), support::wedge(0.08, 0.1, 0.1),
        support::needle(64, 0.1, 0.01), support::plate(0.1, 0.0002, 3),
        support::torus(0.05, 0.02, 40, 20)}) {
    EXPECT_TRUE(surely(mesh));
    EXPECT_TRUE(check_mesh(mesh).touchable());
  }
}

// A scene does not orient a certainly valid mesh, and does not search it for parts that touch.
TEST(CertainlyValid, NothingIsTurnedAndNoPartsTouch) {
  support::Random random(300);
  int valid = 0;
  for (int round = 0; round < 300; ++round) {
    TriangleMesh mesh =
        round % 2 == 0 ? support::icosphere(1, 0.05) : support::torus(0.05, 0.02, 8, 5);
    for (Eigen::Vector3d& p : mesh.vertices) {
      p.x() += 0.03 * (random.uniform(-0.5, 0.5));
    }
    if (random.bits() % 4 == 0) mesh.vertices.push_back({0, 0, 0});  // of no triangle
    if (random.bits() % 4 == 0) std::swap(mesh.triangles[3][0], mesh.triangles[3][1]);
    if (random.bits() % 4 == 0) mesh = inside_out(std::move(mesh));
    if (!certainly_valid(mesh)) continue;
    ++valid;
    EXPECT_EQ(describe(find_touching_parts(mesh)), "");
    const auto before = mesh.triangles;
    EXPECT_EQ(describe(orient_mesh(mesh)), "");
    EXPECT_EQ(mesh.triangles, before);
  }
  EXPECT_GT(valid, 100);
}

TEST(CertainlyValid, AcceptsNoFaultyOrComplexMesh) {
  const TriangleMesh sound = support::icosphere(2, 0.05);
  TriangleMesh hole = sound, flipped = sound, flat = sound, nowhere = sound, pinched = sound;
  hole.triangles.pop_back();
  std::swap(flipped.triangles[9][0], flipped.triangles[9][1]);
  flat.vertices[static_cast<std::size_t>(flat.triangles[3][0])] =
      flat.vertices[static_cast<std::size_t>(flat.triangles[3][1])];
  nowhere.vertices.push_back({0, 0, std::numeric_limits<double>::quiet_NaN()});
  // Two distant vertices become one: two fans there, but still one component.
  for (auto& triangle : pinched.triangles) std::replace(triangle.begin(), triangle.end(), 20, 140);
  TriangleMesh pillow{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 1}}};
  for (const TriangleMesh* mesh : {&hole, &flipped, &flat, &nowhere, &pinched, &pillow}) {
    EXPECT_FALSE(surely(*mesh));
    EXPECT_FALSE(check_mesh(*mesh).touchable());
  }
  EXPECT_FALSE(surely(inside_out(sound)));
  EXPECT_FALSE(surely({}));
  TriangleMesh away = sound;
  for (Eigen::Vector3d& p : away.vertices) p.x() += 1;
  EXPECT_FALSE(surely(joined(sound, away))) << "two parts are looked at closely";
  EXPECT_TRUE(check_contact_mesh(joined(sound, away), true));
}

// Undetected damage would be felt: the quick check may miss only faults that check_mesh misses as
// well.
TEST(CertainlyValid, AcceptsNoMeshThatCheckMeshRefuses) {
  support::Random random(5);
  const auto below = [&random](std::size_t count) {
    return static_cast<std::size_t>(random.bits() % count);
  };
  int told = 0, doubted = 0;
  for (int round = 0; round < 3000; ++round) {
    TriangleMesh mesh = round % 3 == 0   ? support::icosphere(1, 0.05)
                        : round % 3 == 1 ? support::plate(0.1, 1e-6, 2)
                                         : support::torus(0.05, 0.02, 6, 4);
    const std::size_t t = below(mesh.triangles.size());
    const auto any = [&] { return static_cast<std::int32_t>(below(mesh.vertices.size())); };
    switch (below(7)) {
      case 0:
        mesh.triangles[t][below(3)] = any();
        break;
      case 1:
        std::swap(mesh.triangles[t][0], mesh.triangles[t][1]);
        break;
      case 2:
        mesh.vertices[static_cast<std::size_t>(any())] =
            mesh.vertices[static_cast<std::size_t>(any())];
        break;
      case 3: {
        const std::int32_t from = any(), to = any();
        for (auto& triangle : mesh.triangles) {
          std::replace(triangle.begin(), triangle.end(), from, to);
        }
        break;
      }
      case 4:
        // Turned inside out by moving vertices through the mesh.
        for (Eigen::Vector3d& p : mesh.vertices) p.z() *= random.uniform(-1, 1) > 0 ? 1 : -1;
        break;
      case 5:
        mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(t));
        break;
      default:
        for (Eigen::Vector3d& p : mesh.vertices) p.z() *= 1e-14;
    }
    const bool sound = check_mesh(mesh).touchable();
    if (surely(mesh)) {
      ASSERT_TRUE(sound) << round;
      ++told;
    } else {
      doubted += sound;
    }
  }
  EXPECT_GT(told, 300);
  EXPECT_LT(doubted, 300);
}

}  // namespace
}  // namespace thimble::render
