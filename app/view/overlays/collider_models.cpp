#include "view/overlays/collider_models.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <utility>

namespace thimble::view {
namespace {

constexpr float kCosSharp = 0.9848F;   // 10 degrees [chosen: the side of a round can is round]
constexpr float kCosFacet = 0.99996F;  // 0.5 degrees [chosen: parts of one face of a hull are flat]
// With more lines, facets cannot be distinguished [chosen].
constexpr std::size_t kFacetLinesMax = 6000;
constexpr float kCover = 0.22F, kEdgeCover = 0.95F;            // [chosen by eye]
constexpr float kFacetCover = 0.3F, kHiddenEdgeCover = 0.25F;  // [chosen by eye]

}  // namespace

ShapeEdges edges_of(const render::TriangleMesh& mesh) {
  struct Sides {
    Eigen::Vector3f n;
    float cosine = -1;  // of the bend; of the edge of one triangle as of a sharp one
  };
  std::map<std::pair<std::int32_t, std::int32_t>, Sides> sides_of;
  const auto at = [&](std::int32_t v) { return mesh.vertices[static_cast<std::size_t>(v)]; };
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3f n =
        (at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0])).normalized().cast<float>();
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(t[k], t[(k + 1) % 3]);
      const auto [side, first] = sides_of.try_emplace({low, high}, Sides{n});
      if (!first) side->second.cosine = side->second.n.dot(n);
    }
  }
  ShapeEdges edges;
  for (const auto& [ends, sides] : sides_of) {
    if (sides.cosine > kCosFacet) continue;
    (sides.cosine < kCosSharp ? edges.sharp : edges.facets)
        .push_back(
            {static_cast<std::uint32_t>(ends.first), static_cast<std::uint32_t>(ends.second)});
  }
  if (edges.facets.size() > kFacetLinesMax) edges.facets.clear();
  return edges;
}

ColliderModels::ColliderModels(const DrawnScene& scene) {
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const render::TriangleMesh& mesh = scene.objects[i].collider;
    if (mesh.triangles.empty()) continue;
    Model& model = models_.emplace_back();
    model.object = i;
    std::vector<Eigen::Vector3f> vertices;
    for (const Eigen::Vector3d& v : mesh.vertices) vertices.push_back(v.cast<float>());
    const ShapeEdges edges = edges_of(mesh);
    auto lines = edges.sharp;
    lines.insert(lines.end(), edges.facets.begin(), edges.facets.end());
    model.triangle_indices = static_cast<GLsizei>(3 * mesh.triangles.size());
    model.sharp_indices = static_cast<GLsizei>(2 * edges.sharp.size());
    model.facet_indices = static_cast<GLsizei>(2 * edges.facets.size());
    glBindBuffer(GL_ARRAY_BUFFER, *model.vertices);
    glBufferData(GL_ARRAY_BUFFER,
                 static_cast<GLsizeiptr>(vertices.size() * sizeof(Eigen::Vector3f)),
                 vertices.data(), GL_STATIC_DRAW);
    const auto set = [&](const GlVertexArray& array, const GlBuffer& indices, const void* data,
                         std::size_t bytes) {
      glBindVertexArray(*array);
      glBindBuffer(GL_ARRAY_BUFFER, *model.vertices);
      glEnableVertexAttribArray(0);
      glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
      glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, *indices);
      glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(bytes), data, GL_STATIC_DRAW);
    };
    set(model.surface, model.triangles, mesh.triangles.data(),
        mesh.triangles.size() * sizeof(mesh.triangles[0]));
    set(model.edges, model.edge_ends, lines.data(), lines.size() * sizeof(lines[0]));
  }
  glBindVertexArray(0);
}

void ColliderModels::draw(const std::vector<Eigen::Matrix4f>& places, Theme theme,
                          const GlProgram& plain) const {
  glUseProgram(*plain);
  glUniform1f(plain.at("nearer"), 0.0005F);
  const Colour colour = text_colour(kColliderColour, theme);
  const auto paint = [&](float cover) {
    glUniform4f(plain.at("paint"), colour[0], colour[1], colour[2], cover);
  };
  glDepthMask(GL_FALSE);
  // Front faces only, so that each shape is blended once.
  glEnable(GL_CULL_FACE);
  paint(kCover);
  for (const Model& model : models_) {
    glUniformMatrix4fv(plain.at("model"), 1, GL_FALSE, places[model.object].data());
    glBindVertexArray(*model.surface);
    glDrawElements(GL_TRIANGLES, model.triangle_indices, GL_UNSIGNED_INT, nullptr);
  }
  glDisable(GL_CULL_FACE);
  glEnable(GL_LINE_SMOOTH);
  // Lines of sharp edges, or of facets, where the depth test passes.
  const auto draw_lines = [&](GLenum test, float cover, bool sharp) {
    glDepthFunc(test);
    paint(cover);
    for (const Model& model : models_) {
      glUniformMatrix4fv(plain.at("model"), 1, GL_FALSE, places[model.object].data());
      glBindVertexArray(*model.edges);
      const auto begin = static_cast<std::uintptr_t>(sharp ? 0 : model.sharp_indices);
      glDrawElements(GL_LINES, sharp ? model.sharp_indices : model.facet_indices, GL_UNSIGNED_INT,
                     reinterpret_cast<const void*>(begin * sizeof(std::uint32_t)));
    }
  };
  draw_lines(GL_LESS, kFacetCover, false);
  draw_lines(GL_LESS, kEdgeCover, true);
  draw_lines(GL_GREATER, kHiddenEdgeCover, true);
  glDisable(GL_LINE_SMOOTH);
  glDepthFunc(GL_LESS);
  glDepthMask(GL_TRUE);
}

}  // namespace thimble::view
