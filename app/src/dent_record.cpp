#include "dent_record.h"

#include <algorithm>
#include <vector>

namespace thimble::app {
namespace {

constexpr std::int64_t kFrame = 16'000'000;  // ns: a screen's 60 pictures a second

}  // namespace

DentRecord::DentRecord(std::int64_t period_ns)
    : every_(static_cast<std::uint64_t>(std::max<std::int64_t>(1, kFrame / period_ns))) {}

void DentRecord::take(const driver::TickRecord& tick, render::SceneTouch& touch) noexcept {
  if (tick.tick % every_ != 0 || !touch.draw(patch_)) return;
  newest_.store(patch_);
  if (patch_.triangle_count == 0 || !(tick.depth > depth_)) return;
  depth_ = tick.depth;
  deepest_ = patch_;
}

render::TriangleMesh bent(const render::TriangleMesh& mesh, std::size_t first_triangle,
                          const render::BodyPatch& patch) {
  std::vector<bool> left_out(mesh.triangles.size(), false);
  for (std::size_t i = 0; i < patch.triangle_count; ++i) {
    left_out[first_triangle + static_cast<std::size_t>(patch.source[i])] = true;
  }
  render::TriangleMesh result;
  result.vertices = mesh.vertices;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!left_out[t]) result.triangles.push_back(mesh.triangles[t]);
  }
  const auto first = static_cast<std::int32_t>(mesh.vertices.size());
  for (std::size_t i = 0; i < patch.point_count; ++i) {
    const auto& p = patch.points[i].p;
    result.vertices.emplace_back(double{p[0]}, double{p[1]}, double{p[2]});
  }
  for (std::size_t i = 0; i < patch.triangle_count; ++i) {
    const auto& [a, b, c] = patch.triangles[i];
    result.triangles.push_back({first + a, first + b, first + c});
  }
  return result;
}

}  // namespace thimble::app
