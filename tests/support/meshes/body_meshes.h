#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include "body/spring/mesh_springs.h"
#include "body/spring/spring_motion.h"
#include "body/spring/spring_network.h"
#include "support/random.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::support {

/// Makes an open sheet of n x n vertices with equilateral triangles of the given side (m); inner
/// vertices have valence 6.
inline render::TriangleMesh triangle_sheet(std::int32_t n, double side) {
  render::TriangleMesh mesh;
  for (std::int32_t j = 0; j < n; ++j) {
    for (std::int32_t i = 0; i < n; ++i) {
      mesh.vertices.emplace_back(side * (i + 0.5 * j), side * std::sqrt(0.75) * j, 0);
    }
  }
  for (std::int32_t j = 0; j + 1 < n; ++j) {
    for (std::int32_t i = 0; i + 1 < n; ++i) {
      const std::int32_t a = j * n + i;
      mesh.triangles.push_back({a, a + 1, a + n});
      mesh.triangles.push_back({a + 1, a + n + 1, a + n});
    }
  }
  return mesh;
}

/// Makes a network of `n` nodes in a chain with chords, with constants over many powers of ten.
template <int kDof>
render::SpringNetwork<kDof> wild_network(std::int32_t n, double stiffness_max, bool damped,
                                         std::uint64_t seed) {
  Random random(seed);
  const auto spread = [&](double high) { return high * std::pow(10, random.uniform(-6, 0)); };
  std::vector<render::BodyNode> nodes;
  std::vector<render::BodySpring<kDof>> springs;
  for (std::int32_t i = 0; i < n; ++i) {
    nodes.push_back(
        {spread(1e-2), i % 3 == 0 ? spread(stiffness_max) : 0.0, damped ? spread(1.0) : 0.0});
    for (const std::int32_t other : {i - 1, static_cast<std::int32_t>(random.bits() % 1000) % n}) {
      if (other < 0 || other == i) continue;
      render::BodySpring<kDof> spring{i, other, spread(stiffness_max), damped ? spread(10.0) : 0.0};
      if constexpr (kDof == 3) {
        if (seed % 2 == 0) spring.along = random.direction();
      }
      springs.push_back(spring);
    }
  }
  return render::SpringNetwork<kDof>::build(nodes, springs).value();
}

/// Makes a network of a mesh's vertices along its edges, in which each vertex moves only along its
/// normal. It is the smallest network whose limits and motion are known in closed form.
inline render::SpringNetwork<1> join_heights(const render::TriangleMesh& mesh,
                                             const render::MeshSpringSettings& settings) {
  std::set<std::pair<std::int32_t, std::int32_t>> edges;
  for (const auto& triangle : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      edges.insert(std::minmax(triangle[k], triangle[(k + 1) % 3]));
    }
  }
  std::vector<render::BodySpring<1>> springs;
  for (const auto& [low, high] : edges) {
    springs.push_back({low, high, settings.neighbour_stiffness, settings.neighbour_damping});
  }
  const std::vector<render::BodyNode> nodes(
      mesh.vertices.size(), {settings.mass, settings.base_stiffness, settings.base_damping});
  return render::SpringNetwork<1>::build(nodes, springs).value();
}

/// Moves every node at random, up to `u` (m) away and at up to `v` (m/s).
template <int kDof>
void throw_nodes(render::SpringMotion<kDof>& motion, double u, double v, std::uint64_t seed) {
  Random random(seed);
  using Vector = typename render::SpringMotion<kDof>::Vector;
  const auto draw = [&](double size) {
    Vector x;
    for (int k = 0; k < kDof; ++k) x[k] = random.uniform(-size, size);
    return x;
  };
  for (std::int32_t i = 0; i < motion.network().node_count(); ++i) {
    const Vector place = draw(u);
    motion.place(i, place, draw(v));
  }
}

}  // namespace thimble::support
