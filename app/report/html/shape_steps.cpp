#include "report/html/shape_steps.h"

namespace thimble::report {

ShapeStep shape_step(const render::TriangleMesh& before, const render::TriangleMesh& after) {
  ShapeStep step;
  for (std::size_t v = 0; v < after.vertices.size(); ++v) {
    if (v < before.vertices.size() && before.vertices[v] == after.vertices[v]) continue;
    step.vertices.push_back(static_cast<std::uint32_t>(v));
    for (const double one : after.vertices[v]) step.places.push_back(static_cast<float>(one));
  }
  for (std::size_t t = 0; t < after.triangles.size(); ++t) {
    if (t < before.triangles.size() && before.triangles[t] == after.triangles[t]) continue;
    step.triangles.push_back(static_cast<std::uint32_t>(t));
    for (const std::int32_t v : after.triangles[t]) {
      step.corners.push_back(static_cast<std::uint32_t>(v));
    }
  }
  return step;
}

nlohmann::ordered_json page_shapes(std::span<const ShapeStep> steps, PageBlock& block) {
  if (steps.empty()) return {};
  std::vector<double> times;
  std::vector<std::uint16_t> objects;
  std::vector<std::uint32_t> vertices_of, triangles_of, vertices, triangles, corners;
  std::vector<float> places;
  const auto append = [](auto& to, const auto& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  for (const ShapeStep& step : steps) {
    times.push_back(step.t);
    objects.push_back(static_cast<std::uint16_t>(step.object));
    vertices_of.push_back(static_cast<std::uint32_t>(step.vertices.size()));
    triangles_of.push_back(static_cast<std::uint32_t>(step.triangles.size()));
    append(vertices, step.vertices);
    append(places, step.places);
    append(triangles, step.triangles);
    append(corners, step.corners);
  }
  block.add("shapes.t", times);
  block.add("shapes.object", objects);
  block.add("shapes.vertices_of", vertices_of);
  block.add("shapes.triangles_of", triangles_of);
  block.add("shapes.vertices", vertices);
  block.add("shapes.places", places);
  block.add("shapes.triangles", triangles);
  block.add("shapes.corners", corners);
  return {{"steps", times.size()}};
}

}  // namespace thimble::report
