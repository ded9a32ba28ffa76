#include "thimble/render/contact/moving_mesh.h"

#include <utility>

#include "contact/search_answers.h"
#include "contact/swept_over.h"
#include "thimble/render/contact/search_frame.h"

namespace thimble::render {

using Eigen::Vector3d;

MovingMesh::MovingMesh(ContactMesh mesh, const MovingMeshOptions& options)
    : mesh_(std::move(mesh)), search_(make_moving_search(mesh_, options.search)) {
  if (!options.normals) return;
  normals_.emplace(mesh_, options.crease_angle, *options.normals);
  normals_->prepare_refit(mesh_);
}

SurfaceMoved MovingMesh::move_vertices(std::span<const VertexMove> moves,
                                       const Vector3d& p_WT) noexcept {
  SurfaceMoved moved;
  const Vector3d p_far = far_along_x(frame_of(mesh_), p_WT);
  for (const VertexMove& move : moves) {
    if (!place(move, p_WT, p_far, moved.swept_over)) ++moved.refused;
  }
  for (const VertexMove& move : moves) search_->refit(mesh_.fan(move.vertex));
  if (normals_) normals_->refit(mesh_, moves);
  return moved;
}

bool MovingMesh::place(const VertexMove& move, const Vector3d& p_WT, const Vector3d& p_far,
                       std::int32_t& swept) noexcept {
  if (!mesh_.in_box(move.p_W)) return false;
  // Vertex by vertex, so that what is swept over is made of tetrahedra.
  for (const std::int32_t t : mesh_.fan(move.vertex)) {
    const auto& corners = mesh_.corners(t);
    const std::size_t k = corners[0] == move.vertex ? 0 : corners[1] == move.vertex ? 1 : 2;
    const int way =
        swept_over(p_WT, p_far, mesh_.position(move.vertex), mesh_.position(t, (k + 1) % 3),
                   mesh_.position(t, (k + 2) % 3), move.p_W);
    if (way > 0) swept = t;
  }
  mesh_.move_vertex(move.vertex, move.p_W);
  return true;
}

}  // namespace thimble::render
