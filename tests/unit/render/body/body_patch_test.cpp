#include "thimble/render/body_patch.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "dent_shapes.h"
#include "mesh/vertex_normals.h"
#include "support/contact_walk.h"
#include "support/long_form.h"
#include "support/meshes/body_meshes.h"
#include "thimble/render/mesh/mesh_file.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;
using support::any_weights;
using support::dent_in;
using support::press;
namespace fs = std::filesystem;

Vector3d at(const BodyPatch& patch, std::size_t point) {
  const auto& p = patch.points[point].p;
  return {p[0], p[1], p[2]};
}

/// Counts cracks between the patch and the mesh around it, and triangles that have turned over.
struct Faults {
  int cracks = 0;
  int flips = 0;
};

Faults faults_of(const BodyPatch& patch, const ContactMesh& mesh) {
  Faults faults;
  // Each side once in either direction, but for the border.
  std::set<std::pair<int, int>> sides;
  for (std::size_t i = 0; i < patch.triangle_count; ++i) {
    const auto& c = patch.triangles[i];
    for (std::size_t k = 0; k < 3; ++k) {
      faults.cracks += !sides.emplace(c[k], c[(k + 1) % 3]).second;
    }
    const Vector3d normal =
        (at(patch, c[1]) - at(patch, c[0])).cross(at(patch, c[2]) - at(patch, c[0]));
    faults.flips += !(normal.dot(mesh.cell(patch.source[i]).face.n) > 0);
  }
  std::set<std::pair<std::int32_t, std::int32_t>> border;
  for (const auto& [a, b] : sides) {
    if (sides.contains({b, a})) continue;
    for (const int point : {a, b}) {
      const std::int32_t vertex = patch.points[static_cast<std::size_t>(point)].vertex;
      if (vertex < 0) {
        ++faults.cracks;
        continue;
      }
      // Bit-identical where the mesh's own vertex is drawn.
      const Vector3d& drawn = mesh.position(vertex);
      const auto& p = patch.points[static_cast<std::size_t>(point)].p;
      faults.cracks += !(p[0] == drawn.x() && p[1] == drawn.y() && p[2] == drawn.z());
    }
    border.emplace(patch.points[static_cast<std::size_t>(a)].vertex,
                   patch.points[static_cast<std::size_t>(b)].vertex);
  }
  // The border is that of the omitted triangles.
  const std::set<std::int32_t> left_out(patch.source.begin(),
                                        patch.source.begin() + patch.triangle_count);
  std::size_t expected = 0;
  for (const std::int32_t t : left_out) {
    const auto& c = mesh.corners(t);
    for (std::size_t k = 0; k < 3; ++k) {
      if (left_out.contains(mesh.cell(t).neighbours[k])) continue;
      ++expected;
      faults.cracks += !border.contains({c[k], c[(k + 1) % 3]});
    }
  }
  faults.cracks += expected != border.size();
  return faults;
}

TriangleMesh scanned(const std::string& name) {
  const TriangleMesh file = load_mesh(fs::path(THIMBLE_MESHES) / name).value();
  Vector3d low = file.vertices[0], high = low;
  for (const Vector3d& p : file.vertices) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return placed(file, 0.1 / (high - low).maxCoeff(), Eigen::Matrix3d::Identity(),
                Vector3d(0, 0, 0));
}

TEST(BodyPatch, IsClosedAndUnfoldedInRandomTouches) {
  std::vector<std::pair<std::string, TriangleMesh>> meshes{
      {"ball", support::icosphere(3, 0.05)}, {"box", support::box({0.04, 0.03, 0.02})}};
  if (fs::exists(fs::path(THIMBLE_MESHES) / "elephant.off")) {
    for (const char* name : {"elephant.off", "armadillo.off", "cactus.off", "bull.off"}) {
      if (fs::exists(fs::path(THIMBLE_MESHES) / name)) meshes.emplace_back(name, scanned(name));
    }
  }
  auto patch = std::make_unique<BodyPatch>();
  const int touches = support::long_form() ? 100'000 : 3'000;
  for (const auto& [name, mesh] : meshes) {
    auto contact = ContactMesh::build(mesh);
    if (!contact) {
      std::printf("%s cannot be touched\n", name.c_str());
      continue;
    }
    auto dent = dent_in(mesh);
    support::Random random(31);
    int whole = 0;
    const int count = touches / static_cast<int>(meshes.size());
    std::int32_t t = 0;
    for (int i = 0; i < count; ++i) {
      // A jump to another place while the last dent still oscillates, or a move to a neighbour.
      if (random.bits() % 4 == 0) {
        t = static_cast<std::int32_t>(random.bits() %
                                      static_cast<std::uint64_t>(dent.mesh().triangle_count()));
      } else {
        t = dent.mesh().cell(t).neighbours[random.bits() % 3];
      }
      const double depth = 0.02 * std::pow(10, random.uniform(-4, 0));
      const Vector3d w = any_weights(random);
      const int ticks = 1 + static_cast<int>(random.bits() % 4);
      for (int k = 0; k < ticks; ++k) press(dent, t, w, depth);
      if (random.bits() % 8 == 0) dent.rest();
      dent.draw(*patch);
      ASSERT_TRUE(patch->complete) << name << " touch " << i;
      const Faults faults = faults_of(*patch, dent.mesh());
      ASSERT_EQ(faults.cracks, 0) << name << " touch " << i;
      ASSERT_EQ(faults.flips, 0) << name << " touch " << i << " depth " << depth << " share "
                                 << patch->share;
      whole += patch->share == 1;
    }
    std::printf("%-14s %d touches, %.1f %% drawn in full\n", name.c_str(), count,
                100.0 * whole / count);
  }
}

TEST(BodyPatch, ChangesNoNormalWhenATriangleIsFirstTouched) {
  auto patch = std::make_unique<BodyPatch>();
  const TriangleMesh mesh = support::icosphere(2, 0.05);
  auto dent = dent_in(mesh);
  support::Random random(8);
  double with = 0, without = 0;
  for (int i = 0; i < 200; ++i) {
    const auto t = static_cast<std::int32_t>(random.bits() % mesh.triangles.size());
    press(dent, t, any_weights(random), 1e-9);
    dent.draw(*patch);
    // The cursor and the points on the edges: compared with the untouched triangle at their places.
    for (std::size_t k = 0; k < patch->point_count; ++k) {
      const auto& point = patch->points[k];
      if (point.vertex >= 0) continue;
      const Vector3d shown(double{point.n[0]}, double{point.n[1]}, double{point.n[2]});
      const auto w = projected_weights(dent.mesh(), t, at(*patch, k));
      Vector3d untouched(0, 0, 0);
      for (std::size_t c = 0; c < 3; ++c) {
        const std::int32_t corner = dent.mesh().corners(t)[c];
        Vector3d sum(0, 0, 0);
        for (const std::int32_t f : dent.mesh().fan(corner)) {
          const auto& at_f = dent.mesh().corners(f);
          const auto j =
              static_cast<std::size_t>(std::find(at_f.begin(), at_f.end(), corner) - at_f.begin());
          sum +=
              corner_angle(dent.mesh().position(at_f[(j + 1) % 3]) - dent.mesh().position(corner),
                           dent.mesh().position(at_f[(j + 2) % 3]) - dent.mesh().position(corner)) *
              dent.mesh().cell(f).face.n;
        }
        untouched += w[static_cast<Eigen::Index>(c)] * sum.normalized();
      }
      // The mean of the normals of the drawn faces around the point, as in the paper.
      Vector3d faces(0, 0, 0);
      for (std::size_t f = 0; f < patch->triangle_count; ++f) {
        for (const std::uint16_t c : patch->triangles[f]) {
          if (c == k) faces += dent.mesh().cell(patch->source[f]).face.n;
        }
      }
      const auto angle = [](const Vector3d& a, const Vector3d& b) {
        return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / 3.14159265358979;
      };
      with = std::max(with, angle(shown, untouched));
      without = std::max(without, angle(faces, untouched));
    }
    for (int k = 0; k < 40; ++k) dent.rest();
  }
  std::printf("normals jump by %.1e degrees at first touch, by %.2f as means of faces\n", with,
              without);
  EXPECT_LT(with, 0.01);
  EXPECT_GT(without, 1);
}

}  // namespace
}  // namespace thimble::render
