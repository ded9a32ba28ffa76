#pragma once

#include <cstdint>
#include <numbers>

#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::studies {

/// Returns a closed tube of `around` by `across` quadrilaterals, each of two triangles. `point(u,
/// v)` returns the surface point at the angles u around the ring and v around its tube (rad).
/// Real-time: never from the servo thread.
template <class Point>
render::TriangleMesh tube_mesh(std::int32_t around, std::int32_t across, const Point& point) {
  render::TriangleMesh mesh;
  const double turn = 2 * std::numbers::pi;
  const auto vertex = [=](std::int32_t i, std::int32_t j) {
    return i % around * across + j % across;
  };
  for (std::int32_t i = 0; i < around; ++i) {
    for (std::int32_t j = 0; j < across; ++j) {
      mesh.vertices.push_back(point(turn * i / around, turn * j / across));
      mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)});
      mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
    }
  }
  return mesh;
}

}  // namespace thimble::studies
