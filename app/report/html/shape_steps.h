#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <vector>

#include "report/html/page_block.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::report {

/// How the mesh of an object that is shaped for good changed from one picture to the next: vertices
/// and triangles that are other ones from then on, new ones behind all others.
struct ShapeStep {
  double t = 0;                          ///< s, in the page's time.
  std::size_t object = 0;                ///< Of the scene.
  std::vector<std::uint32_t> vertices;   ///< Which.
  std::vector<float> places;             ///< Where each is then: x y z, W, m.
  std::vector<std::uint32_t> triangles;  ///< Which.
  std::vector<std::uint32_t> corners;    ///< Their vertices, three of each.

  bool empty() const noexcept { return vertices.empty() && triangles.empty(); }
};

/// Returns what leads from one mesh to another that came of it by moves and splits.
/// Real-time: never from the servo thread.
ShapeStep shape_step(const render::TriangleMesh& before, const render::TriangleMesh& after);

/// Adds steps to a page under the names shapes.*; returns how many there are, null if none.
/// Real-time: never from the servo thread.
nlohmann::ordered_json page_shapes(std::span<const ShapeStep> steps, PageBlock& block);

}  // namespace thimble::report
