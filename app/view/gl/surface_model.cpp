#include "view/gl/surface_model.h"

#include <cstddef>
#include <cstdint>
#include <utility>

namespace thimble::view {
namespace {

/// One vertex in the format of OpenGL.
struct MeshVertex {
  Eigen::Vector3f p;
  Eigen::Vector3f n;
};

const void* offset(std::size_t bytes) {
  return reinterpret_cast<const void*>(bytes);  // NOLINT: OpenGL takes offsets as pointers
}

void attribute(GLuint place, std::size_t stride, std::size_t at) {
  glEnableVertexAttribArray(place);
  glVertexAttribPointer(place, 3, GL_FLOAT, GL_FALSE, static_cast<GLsizei>(stride), offset(at));
}

template <class T>
void fill(GLenum kind, const std::vector<T>& data, GLenum use) {
  glBufferData(kind, static_cast<GLsizeiptr>(data.size() * sizeof(T)), data.data(), use);
}

}  // namespace

SurfaceModel::SurfaceModel(const render::TriangleMesh& mesh, double crease_angle,
                           NormalWeights weights)
    : crease_angle_(crease_angle),
      weights_(weights),
      triangles_(mesh.triangles.size()),
      dent_(mesh, {}) {
  reshape(mesh);
  glBindVertexArray(*mesh_array_);
  glBindBuffer(GL_ARRAY_BUFFER, *vertices_);
  attribute(0, sizeof(MeshVertex), offsetof(MeshVertex, p));
  attribute(1, sizeof(MeshVertex), offsetof(MeshVertex, n));
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, *indices_);
  glBindVertexArray(*edge_array_);
  attribute(0, sizeof(MeshVertex), offsetof(MeshVertex, p));
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, *edge_indices_);
  glBindVertexArray(*dent_array_);
  glBindBuffer(GL_ARRAY_BUFFER, *dent_vertices_);
  for (GLuint place = 0; place < 9; ++place) {
    attribute(place, sizeof(DentVertex), place * sizeof(Eigen::Vector3f));
  }
  glBindVertexArray(*dent_edge_array_);
  attribute(0, sizeof(DentVertex), 0);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, *dent_edge_indices_);
  glBindVertexArray(0);
}

void SurfaceModel::reshape(const render::TriangleMesh& mesh) {
  const CreasedMesh drawn = crease(mesh, crease_angle_, weights_);
  dent_ = DentSurface(mesh, drawn);
  triangles_ = drawn.triangles.size();
  edges_ = drawn.edges.size();
  closed_ = drawn.closed;
  box_.setEmpty();
  for (const Eigen::Vector3f& p : drawn.positions) box_.extend(p);
  if (!box_.isEmpty()) {
    const Eigen::Vector3f more = Eigen::Vector3f::Constant(0.1F * box_.diagonal().norm());
    box_ = {box_.min() - more, box_.max() + more};
  }
  upload(drawn);
  unbend();
}

void SurfaceModel::upload(const CreasedMesh& drawn) {
  std::vector<MeshVertex> vertices;
  vertices.reserve(drawn.positions.size());
  for (std::size_t i = 0; i < drawn.positions.size(); ++i) {
    vertices.push_back({drawn.positions[i], drawn.normals[i]});
  }
  glBindVertexArray(0);
  glBindBuffer(GL_ARRAY_BUFFER, *vertices_);
  fill(GL_ARRAY_BUFFER, vertices, GL_STATIC_DRAW);
  glBindBuffer(GL_ARRAY_BUFFER, *indices_);
  fill(GL_ARRAY_BUFFER, drawn.triangles, GL_STATIC_DRAW);
  glBindBuffer(GL_ARRAY_BUFFER, *edge_indices_);
  fill(GL_ARRAY_BUFFER, drawn.edges, GL_STATIC_DRAW);
}

void SurfaceModel::unbend() {
  dent_.clear();
  find_ranges();
}

void SurfaceModel::bend(const render::BodyPatch& patch) {
  dent_.set(patch);
  find_ranges();
  if (dent_.vertices().empty()) return;
  // Allocates a new buffer, because the card may still read the last one.
  glBindBuffer(GL_ARRAY_BUFFER, *dent_vertices_);
  fill(GL_ARRAY_BUFFER, dent_.vertices(), GL_STREAM_DRAW);
  std::vector<std::array<std::uint32_t, 2>> edges;
  for (std::uint32_t t = 0; t < dent_.vertices().size(); t += 3) {
    for (std::uint32_t k = 0; k < 3; ++k) edges.push_back({t + k, t + (k + 1) % 3});
  }
  dent_edges_ = static_cast<GLsizei>(2 * edges.size());
  glBindBuffer(GL_ARRAY_BUFFER, *dent_edge_indices_);
  fill(GL_ARRAY_BUFFER, edges, GL_STREAM_DRAW);
}

// Finds the ranges of triangles that are not bent; their indices do not change.
void SurfaceModel::find_ranges() {
  range_counts_.clear();
  range_begins_.clear();
  std::size_t begin = 0;
  const auto add = [&](std::size_t end) {
    if (end > begin) {
      range_counts_.push_back(static_cast<GLsizei>(3 * (end - begin)));
      range_begins_.push_back(offset(3 * sizeof(std::uint32_t) * begin));
    }
    begin = end + 1;
  };
  for (const std::uint32_t hidden : dent_.hidden()) add(hidden);
  add(triangles_);
}

bool SurfaceModel::hides_back(const Eigen::Vector3f& p_BEye) const {
  return closed_ && !box_.contains(p_BEye);
}

void SurfaceModel::draw_mesh() const {
  if (range_counts_.empty()) return;
  glBindVertexArray(*mesh_array_);
  glMultiDrawElements(GL_TRIANGLES, range_counts_.data(), GL_UNSIGNED_INT, range_begins_.data(),
                      static_cast<GLsizei>(range_counts_.size()));
}

void SurfaceModel::draw_dent() const {
  if (dent_.vertices().empty()) return;
  glBindVertexArray(*dent_array_);
  glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(dent_.vertices().size()));
}

void SurfaceModel::draw_edges() const {
  // In a dent, the edges of the original mesh are below or above the bent surface.
  if (dent_.hidden().empty()) {
    glBindVertexArray(*edge_array_);
    glDrawElements(GL_LINES, static_cast<GLsizei>(2 * edges_), GL_UNSIGNED_INT, nullptr);
    return;
  }
  glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
  draw_mesh();
  glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
  glBindVertexArray(*dent_edge_array_);
  glDrawElements(GL_LINES, dent_edges_, GL_UNSIGNED_INT, nullptr);
}

}  // namespace thimble::view
