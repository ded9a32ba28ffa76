#pragma once

#include <cstdint>

#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::scene {

/// Appends the triangles of one mesh to another. Real-time: never from the servo thread.
inline void append(const render::TriangleMesh& mesh, render::TriangleMesh& whole) {
  const auto first = static_cast<std::int32_t>(whole.vertices.size());
  whole.vertices.insert(whole.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
  for (const auto& [a, b, c] : mesh.triangles) {
    whole.triangles.push_back({first + a, first + b, first + c});
  }
}

}  // namespace thimble::scene
