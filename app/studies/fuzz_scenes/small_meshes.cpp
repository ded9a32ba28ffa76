#include "studies/fuzz_scenes/small_meshes.h"

#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <system_error>
#include <utility>

#include "studies/tube_mesh.h"
#include "thimble/render/mesh/mesh_file.h"

namespace thimble::studies {
namespace {

using Eigen::Vector3d;
using render::TriangleMesh;

constexpr double kPi = std::numbers::pi;

/// Divides each triangle into four and projects all corners onto the unit sphere.
TriangleMesh refined(const TriangleMesh& coarse) {
  TriangleMesh mesh{coarse.vertices, {}};
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> middles;
  const auto middle = [&](std::int32_t a, std::int32_t b) {
    const auto [place, fresh] = middles.try_emplace(
        {std::min(a, b), std::max(a, b)}, static_cast<std::int32_t>(mesh.vertices.size()));
    if (fresh) {
      const Vector3d sum = coarse.vertices[static_cast<std::size_t>(a)] +
                           coarse.vertices[static_cast<std::size_t>(b)];
      mesh.vertices.push_back(sum.normalized());
    }
    return place->second;
  };
  for (const auto& [a, b, c] : coarse.triangles) {
    const std::int32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    mesh.triangles.push_back({a, ab, ca});
    mesh.triangles.push_back({b, bc, ab});
    mesh.triangles.push_back({c, ca, bc});
    mesh.triangles.push_back({ab, bc, ca});
  }
  return mesh;
}

TriangleMesh ball(int refinements) {
  TriangleMesh mesh{
      {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
      {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
  for (int i = 0; i < refinements; ++i) mesh = refined(mesh);
  return mesh;
}

/// Returns a ball with six bumps and concave places between them.
TriangleMesh star() {
  TriangleMesh mesh = ball(3);
  for (Vector3d& v : mesh.vertices) {
    const double high = std::pow(v.cwiseAbs().maxCoeff(), 4);
    v *= 0.5 + 0.5 * high;
  }
  return mesh;
}

TriangleMesh box(const Vector3d& half) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.emplace_back((i & 1 ? 1 : -1) * half.x(), (i & 2 ? 1 : -1) * half.y(),
                               (i & 4 ? 1 : -1) * half.z());
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

TriangleMesh ring() {
  return tube_mesh(24, 12, [](double u, double v) {
    const double r = 1 + 0.4 * std::cos(v);
    return Vector3d(r * std::cos(u), r * std::sin(u), 0.4 * std::sin(v));
  });
}

/// Returns a slim cone: many thin triangles meet at its vertex.
TriangleMesh needle() {
  constexpr std::int32_t kAround = 32;
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 2}, {0, 0, 0}};
  for (int k = 0; k < kAround; ++k) {
    const double u = 2 * kPi * k / kAround;
    mesh.vertices.emplace_back(0.4 * std::cos(u), 0.4 * std::sin(u), 0);
  }
  for (std::int32_t k = 0; k < kAround; ++k) {
    const std::int32_t here = 2 + k, next = 2 + (k + 1) % kAround;
    mesh.triangles.push_back({0, here, next});
    mesh.triangles.push_back({1, next, here});
  }
  return mesh;
}

/// Returns a roof with an edge of 20 degrees.
TriangleMesh wedge() {
  const double half = std::tan(10 * kPi / 180);
  return {{{-1, -half, 0}, {1, -half, 0}, {1, half, 0}, {-1, half, 0}, {-1, 0, 1}, {1, 0, 1}},
          {{0, 2, 1}, {0, 3, 2}, {0, 1, 5}, {0, 5, 4}, {2, 3, 4}, {2, 4, 5}, {1, 2, 5}, {3, 0, 4}}};
}

}  // namespace

TriangleMesh small_mesh(std::size_t which) {
  switch (which) {
    case 0:
      return ball(2);
    case 1:
      return box({1, 1, 1});
    case 2:
      return ring();
    case 3:
      return star();
    case 4:
      return box({1, 1, 0.04});
    case 5:
      return needle();
    default:
      return wedge();
  }
}

driver::Result<void> write_small_meshes(const std::filesystem::path& folder) {
  std::error_code status;
  std::filesystem::create_directories(folder, status);
  for (std::size_t i = 0; i < kSmallMeshes.size(); ++i) {
    const auto file = folder / (std::string(kSmallMeshes[i]) + ".off");
    if (auto done = render::save_mesh(small_mesh(i), file); !done) return done;
  }
  return {};
}

}  // namespace thimble::studies
