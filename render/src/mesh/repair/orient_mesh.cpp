#include "mesh/repair/orient_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

#include "mesh/repair/nesting.h"

namespace thimble::render {
namespace {

bool is_whole(const TriangleMesh& mesh, std::size_t t) {
  return has_three_vertices(mesh, t) &&
         std::all_of(mesh.triangles[t].begin(), mesh.triangles[t].end(), [&mesh](std::int32_t v) {
           return mesh.vertices[static_cast<std::size_t>(v)].allFinite();
         });
}

// Numbers the parts connected over edges, in the order of their first triangles.
void number_components(const TriangleMesh& mesh, const std::vector<EdgeUse>& uses,
                       MeshComponents& found) {
  Groups groups(mesh.triangles.size());
  for (std::size_t begin = 0; begin < uses.size();) {
    const std::size_t end = end_of_edge(uses, begin);
    for (std::size_t i = begin + 1; i < end; ++i) {
      groups.join(uses[begin].triangle, uses[i].triangle);
    }
    begin = end;
  }
  found.component_of.resize(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto root = static_cast<std::size_t>(groups.find(static_cast<std::int32_t>(t)));
    found.component_of[t] =
        root == t ? static_cast<std::int32_t>(found.count++) : found.component_of[root];
  }
}

void find_closed(const TriangleMesh& mesh, const std::vector<EdgeUse>& uses,
                 MeshComponents& found) {
  found.closed.assign(found.count, true);
  const auto component_of = [&found](std::int32_t t) {
    return static_cast<std::size_t>(found.component_of[static_cast<std::size_t>(t)]);
  };
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!is_whole(mesh, t)) found.closed[component_of(static_cast<std::int32_t>(t))] = false;
  }
  for (std::size_t begin = 0; begin < uses.size();) {
    const std::size_t end = end_of_edge(uses, begin);
    if (end - begin != 2 || uses[begin].upward == uses[begin + 1].upward) {
      found.closed[component_of(uses[begin].triangle)] = false;
    }
    begin = end;
  }
}

}  // namespace

MeshComponents find_components(const TriangleMesh& mesh, const std::vector<EdgeUse>& uses) {
  MeshComponents found;
  number_components(mesh, uses, found);
  find_closed(mesh, uses, found);
  const std::vector<ClosedPart> parts = nest_components(mesh, found);
  found.inside_out.assign(found.count, false);
  for (std::size_t i = 0; i < found.count; ++i) {
    if (!found.closed[i]) continue;
    const bool cavity = parts[i].nested_in % 2 == 1;
    found.inside_out[i] = cavity ? parts[i].volume > 0 : parts[i].volume < 0;
  }
  return found;
}

}  // namespace thimble::render
