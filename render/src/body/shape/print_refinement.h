#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "mesh/contact_mesh.h"

namespace thimble::render {

/// Names an edge: that from corner `k` of a triangle to the next one.
struct EdgeOfTriangle {
  std::int32_t triangle = -1;  ///< One of its two.
  std::size_t k = 0;           ///< Of the corner where it begins.
};

/// The search for the triangles under a print that are too coarse for it [BP 4.3: "problems when
/// the model was deformed too much"], and for the edge at which each is split.
///
/// It goes over the surface outwards from the touched triangle, so much per tick that the cost of a
/// tick is bounded. A triangle is split at its longest edge; where the triangle behind that has a
/// longer one, that is split first, and so on [Rivara]: angles stay above half of the smallest
/// that the mesh had.
class PrintRefinement {
 public:
  /// Splits triangles with an edge longer than `edge` m, within `radius` m of a press, of a mesh
  /// that grows to `triangles_max`; makes no edge shorter than an eighth of `edge`. All lengths are
  /// those on the first shape. Real-time: never from the servo thread.
  PrintRefinement(double edge, double radius, std::size_t triangles_max);

  // All of the following are Real-time: safe.

  /// Begins a tick: the press is on `triangle`, at a place that was at `p_first` (m) on the first
  /// shape.
  void press(std::int32_t triangle, const Eigen::Vector3d& p_first) noexcept;

  /// Returns the next edge to split, none if all is fine or the tick has looked at enough. `mesh`
  /// is as all moves and splits so far have led it, `first_places` where its vertices were at
  /// first.
  std::optional<EdgeOfTriangle> next(const ContactMesh& mesh,
                                     std::span<const Eigen::Vector3d> first_places) noexcept;

  /// Takes in what came of the edge that `next` has named; a triangle whose edge cannot be split
  /// stays as it is.
  void take(const EdgeSplit& split) noexcept;

  static constexpr int kLooksMax = 192;  ///< Triangles looked at per tick.
  static constexpr int kSplitsMax = 16;  ///< Edges split per tick.
  static constexpr double kFinest = 16;  ///< Edges per radius, at most.

 private:
  void add(std::int32_t triangle) noexcept;

  double edge_;
  double reach_;
  std::vector<std::int32_t> queue_;  // triangles of this round, each once; room for all
  std::vector<std::uint32_t> seen_;  // per triangle: the last round that had it
  std::uint32_t round_ = 0;
  std::size_t next_ = 0;
  int looks_ = 0;
  int splits_ = 0;
  int idle_ = 0;  // ticks since a round found all fine
  bool split_any_ = false;
  Eigen::Vector3d p_first_{0, 0, 0};
  Eigen::Vector3d p_begun_{0, 0, 0};  // where this round began
};

}  // namespace thimble::render
