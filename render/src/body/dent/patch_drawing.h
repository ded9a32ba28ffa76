#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "body/dent/dent_motion.h"
#include "mesh/contact_mesh.h"
#include "thimble/render/body_patch.h"

namespace thimble::render {

/// Draws a dent as a BodyPatch: begin, split and add_moving, finish.
///
/// Never turns a triangle over relative to the base surface. In the plane of its base triangle, the
/// area of a displaced triangle is a quadratic function of the share s of the dent that is drawn.
/// The share is kept below the least s at which any area vanishes. With displacements along the
/// normal only it is 1, because no area vanishes. Where a dent is deeper than the surface's
/// curvature or its triangles allow, only a part of it is drawn and the patch reports it.
///
/// Normals: that of the untouched surface at the base point, plus the change of the mean of the
/// faces around (by area) due to the dent. So they are the untouched ones where nothing is
/// displaced, also at points that split a triangle.
class PatchDrawing {
 public:
  /// Split of an edge of the touched triangle: base point and displacement.
  struct Split {
    double place = 0.5;  ///< Place of the base point, from 0 at corner k to 1 at k + 1, exclusive.
    Eigen::Vector3d u{0, 0, 0};  ///< Displacement, m.
  };

  /// Reserves memory and computes the normals of the mesh. Real-time: never from the servo thread.
  explicit PatchDrawing(std::shared_ptr<const ContactMesh> mesh);

  // All of the following are Real-time: safe. Precondition: numbers are valid.

  /// Begins a new drawing.
  void begin() noexcept;
  /// Draws `triangle` as 6 around the cursor at the place with these `weights` (above 0), displaced
  /// by `u` (m), and each neighbour as 2. Call once, before `add_moving`.
  void split(std::int32_t triangle, const Eigen::Vector3d& weights, const Eigen::Vector3d& u,
             const std::array<Split, 3>& edges, const DentMotion& motion) noexcept;
  /// Draws all triangles around moving vertices.
  void add_moving(const DentMotion& motion) noexcept;
  /// Returns the drawing.
  void finish(BodyPatch& patch) noexcept;

  /// Returns the unit normal of the untouched surface at a vertex: faces weighted by their angles.
  const Eigen::Vector3d& normal(std::int32_t vertex) const noexcept {
    return normals_[static_cast<std::size_t>(vertex)];
  }

 private:
  struct Point {
    Eigen::Vector3d p{0, 0, 0};     // base point
    Eigen::Vector3d u{0, 0, 0};     // displacement
    Eigen::Vector3d n{0, 0, 0};     // normal of the untouched surface
    Eigen::Vector3d turn{0, 0, 0};  // sum of the changes of the faces around, as area vectors
    double area = 0;                // sum of the areas around, twice
    std::int32_t vertex = -1;
    bool moves = false;
  };
  struct Seen {
    std::uint32_t round = 0;
    std::uint16_t point = 0;
  };

  std::uint16_t corner(std::int32_t vertex, const DentMotion& motion) noexcept;
  std::uint16_t add_point(const Point& point) noexcept;
  void add_triangle(std::uint16_t a, std::uint16_t b, std::uint16_t c,
                    std::int32_t source) noexcept;
  bool first_time(std::int32_t triangle) noexcept;
  double share() const noexcept;
  void turn_normals(double share) noexcept;
  void find_normal(std::int32_t vertex) noexcept;

  std::shared_ptr<const ContactMesh> mesh_;
  std::vector<Eigen::Vector3d> normals_;
  std::vector<Seen> vertices_;            // of the mesh
  std::vector<std::uint32_t> triangles_;  // of the mesh: the round in which it was drawn
  std::uint32_t round_ = 0;
  std::vector<Point> points_;
  std::vector<std::array<std::uint16_t, 3>> drawn_;
  std::vector<std::int32_t> source_;
  bool complete_ = true;
};

}  // namespace thimble::render
