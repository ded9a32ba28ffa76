#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

#include "mesh/contact_mesh.h"
#include "thimble/driver/export.h"
#include "thimble/render/mesh/normal_weights.h"

namespace thimble::render {

/// The default angle between two faces' normals (rad) above which their edge is a crease. The right
/// angles of made objects stay sharp, the steps of a scan do not. Scenes may set another.
inline constexpr double kCreaseAngle = std::numbers::pi / 3;

/// The maximum crease angle of concave edges, whatever angle is set for others. Below concave
/// faces, depth and turning normal are the force of a potential only to the square of the angle.
/// Beyond this angle a hand may oscillate in the groove (../track/grooves.md).
inline constexpr double kConcaveCreaseAngle = kCreaseAngle;

/// The same for shading in bands along the edges, where the normal turns within a band.
inline constexpr double kConcaveCreaseAngleOfBands = std::numbers::pi / 9;

/// The normals for shading a mesh, at each corner of each triangle, and the crease flags of its
/// edges.
///
/// Triangles around a vertex that are joined over edges which are not creases form a smooth group.
/// A corner's normal is the weighted mean of its group's face normals, or fitted to its group's
/// vertices. So the normals of two triangles at both ends of a smooth edge are bit-identical, and
/// nothing is averaged over a crease. W, unit length. 73 bytes per triangle.
class THIMBLE_EXPORT SmoothNormals {
 public:
  /// Computes the normals of a mesh. At `crease_angle` = 0 all edges between faces that are not in
  /// one plane are creases; at pi only concave edges above `concave_crease_angle` are. Real-time:
  /// never from the servo thread.
  explicit SmoothNormals(const ContactMesh& mesh, double crease_angle = kCreaseAngle,
                         NormalWeights weights = NormalWeights::kFitted,
                         double concave_crease_angle = kConcaveCreaseAngle);

  /// Enables `refit`: 5 more bytes per triangle. Real-time: never from the servo thread.
  void prepare_refit(const ContactMesh& mesh);

  // All of the following are Real-time: safe. Precondition: numbers are valid.

  /// Updates the data that depends on triangles whose corners have moved (all around these) or that
  /// are new. Normals and creases are bit-identical to those of the newly built mesh. Precondition:
  /// `prepare_refit` was called with the same mesh. Its time does not grow with the mesh.
  void refit(const ContactMesh& mesh, std::span<const std::int32_t> triangles) noexcept;

  /// Returns the normals at the three corners of a triangle.
  const std::array<Eigen::Vector3d, 3>& corners(std::int32_t triangle) const noexcept {
    return corners_[static_cast<std::size_t>(triangle)];
  }

  /// Returns whether the edge from corner `k` to the next one is a crease.
  bool crease(std::int32_t triangle, std::size_t k) const noexcept {
    return ((creases_[static_cast<std::size_t>(triangle)] >> k) & 1U) != 0;
  }

 private:
  // A corner of a triangle: one place in the fan of its vertex.
  struct Corner {
    std::int32_t triangle;
    std::size_t k;

    bool operator==(const Corner&) const = default;
  };
  // Work memory for the normal of one group; stored, so that `refit` does not allocate.
  struct Group {
    std::vector<Corner> corners;
    std::vector<std::int32_t> vertices;
    std::vector<Eigen::Vector3d> points;
    std::vector<std::uint32_t> taken;  // per vertex: the number of the last group that used it
    std::uint32_t collected = 0;
  };

  static Corner across(const ContactMesh& mesh, const Corner& at, std::size_t edge) noexcept;
  void find_crease(const ContactMesh& mesh, std::int32_t triangle, std::size_t k) noexcept;
  void average_group(const ContactMesh& mesh, const Corner& start, Group& group) noexcept;
  void collect_points(const ContactMesh& mesh, Group& group) const noexcept;
  void refit_vertex(const ContactMesh& mesh, std::int32_t vertex) noexcept;

  double crease_angle_;
  double crease_cosine_;
  double concave_crease_angle_;  // of concave edges
  NormalWeights weights_;
  std::vector<std::array<Eigen::Vector3d, 3>> corners_;
  std::vector<std::uint8_t> creases_;  // bit k for edge k
  std::vector<bool> done_;             // per corner; empty unless refits are enabled
  std::vector<std::uint32_t> seen_;    // per vertex: the number of the last refit that found it
  std::uint32_t refits_ = 0;
  Group group_;
};

}  // namespace thimble::render
