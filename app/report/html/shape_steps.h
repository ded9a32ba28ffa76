#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <vector>

#include "report/html/page_block.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::report {

/// Change of the mesh of a permanently deformed object from one picture to the next: changed
/// vertices and triangles, and new ones, which follow all others.
struct ShapeStep {
  double t = 0;                          ///< s, in the page's time.
  std::size_t object = 0;                ///< Index in the scene.
  std::vector<std::uint32_t> vertices;   ///< Their indices.
  std::vector<float> places;             ///< Their new positions: x y z, W, m.
  std::vector<std::uint32_t> triangles;  ///< Their indices.
  std::vector<std::uint32_t> corners;    ///< Their vertices, three of each.

  bool empty() const noexcept { return vertices.empty() && triangles.empty(); }
};

/// Returns the changes from one mesh to another that was made from it by moves and splits.
/// Real-time: never from the servo thread.
ShapeStep shape_step(const render::TriangleMesh& before, const render::TriangleMesh& after);

/// Adds steps to a page under the names shapes.*; returns their description, null if there are
/// none. Real-time: never from the servo thread.
nlohmann::ordered_json page_shapes(std::span<const ShapeStep> steps, PageBlock& block);

}  // namespace thimble::report
