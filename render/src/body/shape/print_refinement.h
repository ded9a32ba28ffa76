#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "mesh/contact_mesh.h"

namespace thimble::render {

/// An edge: from corner `k` of a triangle to the next one.
struct EdgeOfTriangle {
  std::int32_t triangle = -1;  ///< One of its two triangles.
  std::size_t k = 0;           ///< Number of the corner where it begins.
};

/// Finds the triangles under a print that are too coarse for it [BP 4.3: "problems when the model
/// was deformed too much"], and the edge at which each is split.
///
/// The search goes over the surface outwards from the touched triangle, bounded per tick. A
/// triangle is split at its longest edge. If the triangle behind that edge has a longer one, that
/// one is split first, and so on [Rivara]. So angles stay above half of the smallest angle of the
/// mesh.
class PrintRefinement {
 public:
  /// Splits triangles with an edge longer than `edge` m, within `radius` m of a press, of a mesh
  /// that grows to `triangles_max`. Makes no edge shorter than an eighth of `edge`. All lengths are
  /// those on the first shape. Real-time: never from the servo thread.
  PrintRefinement(double edge, double radius, std::size_t triangles_max);

  // All of the following are Real-time: safe.

  /// Begins a tick: the press is on `triangle`, at a place that was at `p_first` (m) on the first
  /// shape.
  void press(std::int32_t triangle, const Eigen::Vector3d& p_first) noexcept;

  /// Returns the next edge to split; none if the mesh is fine enough or the tick has examined
  /// enough. `mesh` must include all moves and splits so far; `first_places` are the first places
  /// of its vertices.
  std::optional<EdgeOfTriangle> next(const ContactMesh& mesh,
                                     std::span<const Eigen::Vector3d> first_places) noexcept;

  /// Receives the result of splitting the edge from `next`. A triangle whose edge cannot be split
  /// stays unchanged.
  void take(const EdgeSplit& split) noexcept;

  static constexpr int kLooksMax = 192;  ///< Maximum number of triangles examined per tick.
  static constexpr int kSplitsMax = 16;  ///< Maximum number of edges split per tick.
  static constexpr double kFinest = 16;  ///< Maximum number of edges per radius.

 private:
  void add(std::int32_t triangle) noexcept;

  double edge_;
  double reach_;
  std::vector<std::int32_t> queue_;  // triangles of this round, each once; capacity for all
  std::vector<std::uint32_t> seen_;  // per triangle: the last round that contained it
  std::uint32_t round_ = 0;
  std::size_t next_ = 0;
  int looks_ = 0;
  int splits_ = 0;
  int idle_ = 0;  // ticks since a round found nothing to split
  bool split_any_ = false;
  Eigen::Vector3d p_first_{0, 0, 0};
  Eigen::Vector3d p_begun_{0, 0, 0};  // start of this round
};

}  // namespace thimble::render
