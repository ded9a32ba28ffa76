#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "support/meshes/bench_meshes.h"
#include "support/random.h"
#include "track/moving_mesh.h"

// Cost of moving vertices of a mesh and updating all structures built over it: a patch of 37
// vertices (three rings) at random places, pressed in by a fifth of an edge and released. Must
// hardly depend on the size of the mesh.

namespace thimble::bench {
namespace {

using Eigen::Vector3d;
using render::NormalWeights;
using render::VertexMove;

constexpr std::size_t kPatch = 37;

// Returns the vertices nearest to one along the surface, with a displacement that is largest at the
// first.
std::vector<VertexMove> patch(const render::ContactMesh& mesh, std::int32_t centre) {
  std::vector<std::int32_t> found{centre};
  for (std::size_t i = 0; i < found.size() && found.size() < kPatch; ++i) {
    for (const std::int32_t t : mesh.fan(found[i])) {
      for (const std::int32_t v : mesh.corners(t)) {
        if (found.size() < kPatch && std::find(found.begin(), found.end(), v) == found.end()) {
          found.push_back(v);
        }
      }
    }
  }
  const std::int32_t t = mesh.fan(centre)[0];
  const double edge = (mesh.position(t, 0) - mesh.position(t, 1)).norm();
  std::vector<VertexMove> moves;
  for (const std::int32_t v : found) {
    moves.push_back({v, mesh.position(v) - 0.2 * edge * mesh.cell(t).face.n});
  }
  return moves;
}

// Separate function, so that callgrind can count it only (--toggle-collect=*move_patch_once*).
[[gnu::noinline]] void move_patch_once(render::MovingMesh& surface,
                                       const std::vector<VertexMove>& moves) {
  surface.move_vertices(moves, Vector3d::Constant(0.2));
}

void move_patch(benchmark::State& state, std::optional<NormalWeights> normals) {
  const auto mesh = support::bench_ball({}, static_cast<std::size_t>(state.range(0)));
  render::MovingMesh surface(render::ContactMesh::build(mesh).value(),
                             {.search = {}, .normals = normals});
  support::Random random(1);
  std::vector<std::vector<VertexMove>> moves;
  for (int i = 0; i < 256; ++i) {
    const auto centre = static_cast<std::int32_t>(random.bits() % mesh.vertices.size());
    moves.push_back(patch(surface.mesh(), centre));
    moves.push_back(moves.back());
    for (VertexMove& back : moves.back()) back.p_W = surface.mesh().position(back.vertex);
  }
  std::size_t i = 0;
  for (auto _ : state) move_patch_once(surface, moves[i++ % moves.size()]);
  state.counters["ns_per_vertex"] = benchmark::Counter(
      static_cast<double>(kPatch) * 1e-9,
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK_CAPTURE(move_patch, no_normals, std::nullopt)->Arg(10'000)->Arg(1'000'000);
BENCHMARK_CAPTURE(move_patch, mean_normals, NormalWeights::kAngle)->Arg(10'000)->Arg(1'000'000);
BENCHMARK_CAPTURE(move_patch, fitted_normals, NormalWeights::kFitted)->Arg(10'000)->Arg(1'000'000);

}  // namespace
}  // namespace thimble::bench
