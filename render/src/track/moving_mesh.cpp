#include "track/moving_mesh.h"

#include <algorithm>
#include <array>
#include <utility>

#include "search/search_answers.h"
#include "search/search_frame.h"
#include "track/swept_contact.h"

namespace thimble::render {

using Eigen::Vector3d;

MovingMesh::MovingMesh(ContactMesh mesh, const MovingMeshOptions& options)
    : mesh_(std::move(mesh)), search_(make_moving_search(mesh_, options.search)) {
  const std::size_t count = mesh_.triangles_max();
  around_.reserve(count);
  marks_.assign(count, 0);
  if (!options.normals) return;
  normals_.emplace(mesh_, options.crease_angle, *options.normals, options.concave_crease_angle);
  normals_->prepare_refit(mesh_);
}

SurfaceMoved MovingMesh::move_vertices(std::span<const VertexMove> moves,
                                       const Vector3d& p_WT) noexcept {
  SurfaceMoved moved;
  const Vector3d p_far = far_along_x(frame_of(mesh_), p_WT);
  around_.clear();
  if (++round_ == 0) {
    std::fill(marks_.begin(), marks_.end(), 0);
    round_ = 1;
  }
  for (const VertexMove& move : moves) {
    if (!place(move, p_WT, p_far, moved.swept_over)) ++moved.refused;
  }
  fit_planes();
  search_->refit(around_);
  if (normals_) normals_->refit(mesh_, around_);
  return moved;
}

EdgeSplit MovingMesh::split_edge(std::int32_t triangle, std::size_t k, bool keep_begin) noexcept {
  const EdgeSplit split = mesh_.split_edge(triangle, k, keep_begin);
  if (split.vertex < 0) return split;
  const std::array all{split.triangles[0], split.triangles[1], split.others[0], split.others[1]};
  search_->refit(all);
  if (normals_) normals_->refit(mesh_, all);
  return split;
}

bool MovingMesh::place(const VertexMove& move, const Vector3d& p_WT, const Vector3d& p_far,
                       std::int32_t& swept) noexcept {
  if (!mesh_.in_box(move.p_W)) return false;
  // Vertex by vertex, so that the swept volume consists of tetrahedra.
  for (const std::int32_t t : mesh_.fan(move.vertex)) {
    const auto& corners = mesh_.corners(t);
    const std::size_t k = corners[0] == move.vertex ? 0 : corners[1] == move.vertex ? 1 : 2;
    const int way =
        swept_over(p_WT, p_far, mesh_.position(move.vertex), mesh_.position(t, (k + 1) % 3),
                   mesh_.position(t, (k + 2) % 3), move.p_W);
    if (way > 0) swept = t;
    if (marked(t)) continue;
    marks_[static_cast<std::size_t>(t)] = round_;
    around_.push_back(t);  // at most all triangles; capacity is reserved
  }
  mesh_.vertices_[static_cast<std::size_t>(move.vertex)] = move.p_W;
  return true;
}

void MovingMesh::fit_planes() noexcept {
  mesh_.moved_ = true;
  for (const std::int32_t t : around_) mesh_.compute_face(t);
  for (const std::int32_t t : around_) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t behind = mesh_.cell(t).neighbours[k];
      if (t < behind || !marked(behind)) mesh_.compute_edge(t, k);
    }
  }
}

}  // namespace thimble::render
