#include "mesh/repair/out_array.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <numbers>
#include <string>
#include <utility>

#include "mesh/adjacency.h"
#include "mesh/contact_mesh.h"
#include "mesh/repair/orient_mesh.h"
#include "support/meshes/reference_geometry.h"
#include "support/meshes/shapes.h"
#include "support/random.h"
#include "thimble/render/mesh/check_mesh.h"
#include "thimble/render/mesh/mesh_file.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;
namespace fs = std::filesystem;

const fs::path kFolder = THIMBLE_MESHES;

void append(TriangleMesh& mesh, const TriangleMesh& other) {
  const auto shift = static_cast<std::int32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto& [a, b, c] : other.triangles) {
    mesh.triangles.push_back({a + shift, b + shift, c + shift});
  }
}

TriangleMesh turned(TriangleMesh mesh) {
  for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  return mesh;
}

// Reverses about half of the triangles and marks them with -1 in `turns`, as the OUT array must.
TriangleMesh shuffled(TriangleMesh mesh, OutArray& turns) {
  support::Random random(5);
  turns.clear();
  for (auto& triangle : mesh.triangles) {
    const bool turn = random.bits() % 2 == 1;
    turns.push_back(turn ? -1 : 1);
    if (turn) std::swap(triangle[1], triangle[2]);
  }
  return mesh;
}

// A box whose faces are cut along both diagonals.
TriangleMesh crossed_box() {
  TriangleMesh mesh = support::box({1, 1, 1});
  mesh.triangles.clear();
  const int sides[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                           {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& side : sides) {
    Vector3d middle(0, 0, 0);
    for (const int v : side) middle += mesh.vertices[static_cast<std::size_t>(v)] / 4;
    const std::int32_t m = support::add_vertex(mesh, middle);
    for (int k = 0; k < 4; ++k) mesh.triangles.push_back({side[k], side[(k + 1) % 4], m});
  }
  return mesh;
}

TEST(OutArray, ReportsReversedTriangles) {
  TriangleMesh shell = support::icosphere(2, 3);
  append(shell, turned(support::icosphere(2, 2)));
  append(shell, support::icosphere(2, 1));
  for (const TriangleMesh& mesh :
       {support::icosphere(3, 0.05), support::torus(3, 1, 24, 12), support::box({1, 1, 1}),
        crossed_box(), support::bumpy_sphere(4, 0.05, 0.3, 6), support::wedge(0.08, 0.1, 0.1),
        support::needle(64, 0.1, 0.01), support::plate(0.1, 0.0002, 6), shell}) {
    EXPECT_EQ(compute_out_array(mesh), OutArray(mesh.triangles.size(), 1));
    OutArray turns;
    const TriangleMesh mixed = shuffled(mesh, turns);
    EXPECT_EQ(compute_out_array(mixed), turns);
  }
}

TEST(OutArray, IsTheSameInTheCycleAsPrecomputed) {
  for (const TriangleMesh& mesh :
       {support::bumpy_sphere(3, 0.05, 0.3, 6), crossed_box(), support::plate(0.1, 0.0002, 6)}) {
    OutArray turns;
    const TriangleMesh mixed = shuffled(mesh, turns);
    const OutFinder finder(mixed);
    for (std::size_t t = 0; t < turns.size(); ++t) {
      ASSERT_EQ(finder.find(static_cast<std::int32_t>(t)), turns[t]) << t;
    }
  }
}

TEST(OutArray, HoldsAtEveryScaleAndFarFromTheOrigin) {
  for (const double scale : {1e-6, 1.0, 1e3}) {
    for (const double offset : {0.0, 1e4}) {
      TriangleMesh mesh = support::bumpy_sphere(2, 0.05, 0.3, 6);
      for (Vector3d& p : mesh.vertices) p = scale * (p + offset * Vector3d(1, -2, 3));
      EXPECT_EQ(compute_out_array(mesh), OutArray(mesh.triangles.size(), 1)) << scale << offset;
    }
  }
}

TEST(OutArray, IsZeroForTrianglesWithoutASide) {
  TriangleMesh mesh = support::box({1, 1, 1});
  mesh.triangles.push_back({0, 0, 1});
  mesh.triangles.push_back({0, 1, 99});
  const auto broken = support::add_vertex(mesh, Vector3d::Constant(std::nan("")));
  mesh.triangles.push_back({0, 1, broken});
  const OutArray out = compute_out_array(mesh);
  for (std::size_t t = 0; t < 12; ++t) EXPECT_EQ(out[t], 1) << t;
  for (std::size_t t = 12; t < 15; ++t) EXPECT_EQ(out[t], 0) << t;
  EXPECT_TRUE(compute_out_array({}).empty());
}

TEST(OutArray, IsTheSameInTheCycleForEightyThousandTriangles) {
  OutArray turns;
  const TriangleMesh mesh = shuffled(support::bumpy_sphere(6, 0.05, 0.3, 6), turns);
  const auto begin = std::chrono::steady_clock::now();
  const OutArray out = compute_out_array(mesh);
  const auto middle = std::chrono::steady_clock::now();
  const OutFinder finder(mesh);
  int same = 0;
  constexpr int kAsked = 100;
  for (int i = 0; i < kAsked; ++i) {
    const std::size_t t = static_cast<std::size_t>(i) * (turns.size() / kAsked);
    same += finder.find(static_cast<std::int32_t>(t)) == out[t];
  }
  const auto end = std::chrono::steady_clock::now();
  using Microseconds = std::chrono::duration<double, std::micro>;
  std::printf(
      "OUT array of %zu triangles: %.2f us each precomputed (1 byte), %.0f us in the cycle\n",
      turns.size(), Microseconds(middle - begin).count() / static_cast<double>(turns.size()),
      Microseconds(end - middle).count() / kAsked);
  EXPECT_EQ(out, turns);
  EXPECT_EQ(same, kAsked);
}

TEST(OrientMesh, RestoresShuffledMeshesAndReportsIt) {
  TriangleMesh shell = support::icosphere(2, 3);
  append(shell, turned(support::icosphere(2, 2)));
  for (const TriangleMesh& mesh : {support::torus(3, 1, 24, 12), shell, support::box({1, 1, 1})}) {
    OutArray turns;
    TriangleMesh mixed = shuffled(mesh, turns);
    const OrientReport report = orient_mesh(mixed);
    EXPECT_TRUE(check_mesh(mixed).touchable());
    EXPECT_EQ(compute_out_array(mixed), OutArray(mixed.triangles.size(), 1));
    EXPECT_EQ(report.turned_triangles,
              static_cast<std::size_t>(std::count(turns.begin(), turns.end(), -1)));
    EXPECT_EQ(turns[static_cast<std::size_t>(report.first_turned)], -1);
    EXPECT_EQ(report.repaired_components, check_mesh(mixed).components);
    EXPECT_EQ(report.one_sided_components, 0u);
    // After one pass nothing is left to do.
    const auto once = mixed.triangles;
    EXPECT_EQ(orient_mesh(mixed).turned_triangles, 0u);
    EXPECT_EQ(mixed.triangles, once);
  }
}

TEST(OrientMesh, OrientsOpenPartsByMajorityAndKeepsOneSided) {
  TriangleMesh open = support::icosphere(2, 1);
  open.triangles.resize(open.triangles.size() - 7);
  const auto whole = open.triangles;
  for (const std::size_t t : {3u, 40u, 77u}) std::swap(open.triangles[t][1], open.triangles[t][2]);
  EXPECT_EQ(orient_mesh(open).turned_triangles, 3u);
  for (std::size_t t = 0; t < whole.size(); ++t) {
    // A triangle that was reversed twice may begin with another corner; only its orientation
    // counts.
    const auto& [a, b, c] = open.triangles[t];
    const auto& [d, e, f] = whole[t];
    EXPECT_TRUE((a == d && b == e && c == f) || (b == d && c == e && a == f) ||
                (c == d && a == e && b == f));
  }

  TriangleMesh strip;
  constexpr int kAround = 12;
  for (int i = 0; i < kAround; ++i) {
    const double u = 2 * std::numbers::pi * i / kAround;
    for (const double s : {-0.3, 0.3}) {
      const double r = 1 + s * std::cos(u / 2);
      strip.vertices.emplace_back(r * std::cos(u), r * std::sin(u), s * std::sin(u / 2));
    }
  }
  for (int i = 0; i < kAround; ++i) {
    const bool last = i == kAround - 1;
    const int a = 2 * i, b = a + 1, c = last ? 1 : a + 2, d = last ? 0 : a + 3;
    strip.triangles.push_back({a, c, b});
    strip.triangles.push_back({b, c, d});
  }
  const auto before = strip.triangles;
  const OrientReport report = orient_mesh(strip);
  EXPECT_EQ(report.one_sided_components, 1u);
  EXPECT_EQ(report.turned_triangles, 0u);
  EXPECT_EQ(strip.triangles, before);
  EXPECT_NE(describe(report).find("only one side"), std::string::npos);
}

TEST(OrientMesh, IsDoneAndReportedByTheContactMesh) {
  OutArray turns;
  const TriangleMesh mixed = shuffled(support::bumpy_sphere(3, 0.05, 0.3, 6), turns);
  const auto contact = ContactMesh::build(mixed);
  ASSERT_TRUE(contact.ok());
  EXPECT_EQ(contact->orientation().turned_triangles,
            static_cast<std::size_t>(std::count(turns.begin(), turns.end(), -1)));
  EXPECT_EQ(contact->turned_components(), 0u);
  EXPECT_GT(contact->depth(0, Vector3d::Zero()), 0);
  EXPECT_NE(describe(contact->orientation()).find("reversed"), std::string::npos);
  const auto refused = ContactMesh::build(mixed, {.orient = false});
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message.find("opposite orientation"), std::string::npos);
}

TEST(OrientMesh, OrientsTheShuffledFilesAsTheParityOfRaysDoes) {
  if (!fs::exists(kFolder / "elephant.off")) {
    GTEST_SKIP() << "The scanned meshes are not here: run app/fetch_meshes.sh to unpack them.";
  }
  for (const char* name : {"blobby-shuffled.off", "cube-shuffled.off", "cube4-shuffled.off",
                           "oblong-shuffled.off", "tet-shuffled.off", "boeing.off"}) {
    const TriangleMesh file = load_mesh(kFolder / name).value();
    ASSERT_FALSE(check_mesh(file).touchable()) << name;
    TriangleMesh by_winding = file;
    EXPECT_GT(orient_mesh(by_winding).turned_triangles, 0u) << name;
    EXPECT_TRUE(check_mesh(by_winding).touchable()) << name;
    EXPECT_GT(check_mesh(by_winding).volume, 0) << name;
    // Where a mesh passes through itself, rays see the matter there, and orientation does not.
    if (std::string(name) == "boeing.off") continue;
    TriangleMesh by_rays = file;
    const OutArray out = compute_out_array(file);
    for (std::size_t t = 0; t < out.size(); ++t) {
      if (out[t] < 0) std::swap(by_rays.triangles[t][1], by_rays.triangles[t][2]);
    }
    EXPECT_EQ(by_winding.triangles, by_rays.triangles) << name;
  }
}

TEST(OutArray, AgreesWithTheWindingOfScannedMeshes) {
  if (!fs::exists(kFolder / "elephant.off")) {
    GTEST_SKIP() << "The scanned meshes are not here: run app/fetch_meshes.sh to unpack them.";
  }
  int meshes = 0, agree = 0;
  std::size_t undecided = 0;
  for (const auto& entry : fs::directory_iterator(kFolder)) {
    if (entry.path().extension() != ".off") continue;
    const auto file = load_mesh(entry.path());
    if (!file || !ContactMesh::build(*file)) continue;
    TriangleMesh mesh = *file;
    orient_mesh(mesh);
    const OutArray out = compute_out_array(mesh);
    const auto against = std::count(out.begin(), out.end(), -1);
    undecided += static_cast<std::size_t>(std::count(out.begin(), out.end(), 0));
    ++meshes;
    agree += against == 0;
    if (against > 0) {
      std::printf("%-24s %td of %zu triangles look into matter: the mesh passes through itself\n",
                  entry.path().filename().c_str(), against, out.size());
    }
  }
  std::printf("%d of %d meshes agree; %zu triangles without a sign\n", agree, meshes, undecided);
  EXPECT_GT(meshes, 80);
  EXPECT_GE(agree, meshes - 5);
  EXPECT_EQ(undecided, 0u);
}

TEST(FindNeighbour, MatchesTheArray) {
  const TriangleMesh torus = support::torus(3, 1, 20, 10);
  std::size_t meshes = 0;
  const auto compare = [&meshes](const TriangleMesh& mesh, const std::string& name) {
    const auto array = find_adjacency(mesh);
    if (!array) return;
    ++meshes;
    // All triangles of a small mesh, a part of a large one: in the cycle each answer takes a pass
    // over the mesh.
    const std::size_t step = 1 + mesh.triangles.size() / 2000;
    for (std::size_t t = 0; t < mesh.triangles.size(); t += step) {
      for (std::size_t k = 0; k < 3; ++k) {
        ASSERT_EQ(find_neighbour(mesh, static_cast<std::int32_t>(t), k), (*array)[t][k])
            << name << " triangle " << t << " edge " << k;
      }
    }
  };
  compare(torus, "torus");
  compare(support::needle(64, 1, 0.1), "needle");
  EXPECT_EQ(meshes, 2u);
  if (!fs::exists(kFolder / "elephant.off")) return;
  for (const auto& entry : fs::directory_iterator(kFolder)) {
    if (entry.path().extension() != ".off") continue;
    if (const auto mesh = load_mesh(entry.path())) compare(*mesh, entry.path().filename());
  }
  EXPECT_GT(meshes, 80u);
}

TEST(FindNeighbour, ReturnsNoneOverAnOpenEdge) {
  TriangleMesh mesh = support::box({1, 1, 1});
  mesh.triangles.erase(mesh.triangles.begin() + 1);
  EXPECT_EQ(find_neighbour(mesh, 0, 2), -1);  // edge 3-0, whose other triangle was removed
  EXPECT_GE(find_neighbour(mesh, 0, 0), 0);
}

}  // namespace
}  // namespace thimble::render
