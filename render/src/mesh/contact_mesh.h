#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/repair/orient_mesh.h"
#include "thimble/driver/result.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// Is a plane with unit normal: `n . x + d` is the signed distance (m) of a point x.
struct Plane {
  Eigen::Vector3d n{0, 0, 0};  ///< Unit normal.
  double d = 0;                ///< m; n x + d = 0 on it.

  /// Tells the distance of a point from the plane, m, positive outside. Real-time: safe.
  double distance(const Eigen::Vector3d& x) const noexcept { return n.dot(x) + d; }
};

/// Holds what a tracker needs of one triangle, in one place of memory. Points are given relative to
/// ContactMesh::origin, so that a mesh far from the world's origin loses no digits.
struct TriangleCell {
  Plane face;  ///< Normal outwards; positive outside.
  std::array<Plane, 3>
      edges;  ///< Over the edge from corner k to k + 1; positive on this side [BP 4b].
  std::array<std::int32_t, 3> neighbours;  ///< Triangle behind each edge plane.
  /// How sharp its hollow edges are: sine of half the angle between the normals over the sharpest
  /// of them, in 1 / kSineUnit, rounded up; 0 if there is none.
  std::uint16_t hollow = 0;
  /// How far the faces around its corners lean away: the same of the largest angle to one of them,
  /// as the mesh was built; kSineUnit at a corner of more than `kFanMax` faces.
  std::uint16_t around = 0;

  static constexpr double kSineUnit = 65535;
  /// Faces around a corner that are looked at one by one.
  static constexpr std::size_t kFanMax = 64;
  /// Sine of half an angle that is rounding: two faces in one plane.
  static constexpr double kFlat = 1e-9;

  /// Returns whether edge `k` is hollow: whether the faces rise from it. Real-time: safe.
  bool hollow_edge(std::size_t k) const noexcept { return edges[k].n.dot(face.n) < -kFlat; }
  /// Returns how far on this side of a hollow edge's plane (m) a tip `depth` (m) below the face may
  /// be and still be beside the face, not under it; 0 if no edge is hollow. Real-time: safe.
  double beside_hollow(double depth) const noexcept { return depth * (hollow / kSineUnit); }
};

/// Sets how a contact mesh is built.
struct ContactMeshOptions {
  /// Winds triangles alike and outwards (see orient_mesh): for a closed surface only one answer is
  /// right. If false, meshes that need it are refused.
  bool orient = true;
  /// How far vertices may later move out of the box, as a share of its longest side, >= 0:
  /// `box_min` and `box_max` grow by it on all sides. 0 for a mesh that keeps its shape.
  double room = 0;
};

/// Says where a vertex goes.
struct VertexMove {
  std::int32_t vertex = 0;       ///< Its number.
  Eigen::Vector3d p_W{0, 0, 0};  ///< m
};

/// Is a mesh made ready to be touched: closed, wound alike, with face planes, edge planes and
/// neighbours. Frame W, m.
///
/// The edge plane of two neighbours goes through their shared edge and the average of their unit
/// normals [BP 3.1, Fig. 4b]. Points of it lie equally deep below both faces, so the depth does not
/// jump when the active triangle changes. Both neighbours hold the same numbers with opposite
/// signs: no rounding can make each send the tip to the other.
class ContactMesh {
 public:
  /// Checks a mesh (W, m) and prepares it. The error joins the sentences about everything that
  /// keeps the mesh from being touched (see check_mesh). Real-time: never from the servo thread.
  static driver::Result<ContactMesh> build(const TriangleMesh& mesh,
                                           const ContactMeshOptions& options = {});

  // All of the following are Real-time: safe. Precondition: numbers name what exists.

  std::int32_t triangle_count() const noexcept { return static_cast<std::int32_t>(cells_.size()); }

  std::int32_t vertex_count() const noexcept { return static_cast<std::int32_t>(vertices_.size()); }

  /// Tells how many components were wholly inside out and have been turned.
  std::size_t turned_components() const noexcept { return orientation_.turned_components; }

  /// Tells all that was turned round.
  const OrientReport& orientation() const noexcept { return orientation_; }

  /// Tells the corners of a triangle, counter-clockwise from outside.
  const std::array<std::int32_t, 3>& corners(std::int32_t triangle) const noexcept {
    return triangles_[static_cast<std::size_t>(triangle)];
  }

  /// Tells where a vertex is, m in W. Everything that asks for positions asks here.
  const Eigen::Vector3d& position(std::int32_t vertex) const noexcept {
    return vertices_[static_cast<std::size_t>(vertex)];
  }

  /// Moves a vertex to `p_W` (m; finite), and with it the planes of the triangles around it and of
  /// their neighbours. What was built over the mesh (boxes of a search, smooth normals) knows the
  /// old place until it is told: MovingMesh does all of it. A triangle that loses its area has the
  /// normal 0 and no depth. Real-time: safe; some 20 ns per triangle around the vertex.
  void move_vertex(std::int32_t vertex, const Eigen::Vector3d& p_W) noexcept;

  /// Returns whether any vertex has moved since the mesh was built.
  bool moved() const noexcept { return moved_; }

  /// Tells where corner `k` of a triangle is, m in W.
  const Eigen::Vector3d& position(std::int32_t triangle, std::size_t k) const noexcept {
    return position(corners(triangle)[k]);
  }

  /// Gives the planes and neighbours of a triangle, relative to `origin`.
  const TriangleCell& cell(std::int32_t triangle) const noexcept {
    return cells_[static_cast<std::size_t>(triangle)];
  }

  /// Lists the triangles around a vertex.
  std::span<const std::int32_t> fan(std::int32_t vertex) const noexcept {
    const auto v = static_cast<std::size_t>(vertex);
    return {fans_.data() + fan_begin_[v], fan_begin_[v + 1] - fan_begin_[v]};
  }

  /// Tells the point that cells are relative to: the middle of the box, m in W.
  const Eigen::Vector3d& origin() const noexcept { return origin_; }

  /// Tell the box of the vertices as they were when built, grown by ContactMeshOptions::room; m, W.
  /// Searches count in it: they find nothing that lies outside.
  const Eigen::Vector3d& box_min() const noexcept { return box_min_; }
  const Eigen::Vector3d& box_max() const noexcept { return box_max_; }  ///< Tells the other corner.

  /// Tells whether a point lies in the box. NaN does not.
  bool in_box(const Eigen::Vector3d& p_W) const noexcept {
    return (p_W.array() >= box_min_.array()).all() && (p_W.array() <= box_max_.array()).all();
  }

  /// Tells how far a point lies below a triangle's plane, m; negative outside.
  double depth(std::int32_t triangle, const Eigen::Vector3d& p_W) const noexcept {
    return -cell(triangle).face.distance(p_W - origin_);
  }

  /// Tells the depth below which rounding decides its sign, m.
  double depth_rounding() const noexcept { return depth_rounding_; }

 private:
  // Moves many vertices at once and does each face and edge around them once.
  friend class MovingMesh;

  ContactMesh() = default;
  void compute_face(std::int32_t triangle) noexcept;
  void compute_edge(std::int32_t triangle, std::size_t k) noexcept;
  void collect_fans();
  void measure_around();

  std::vector<Eigen::Vector3d> vertices_;
  std::vector<std::array<std::int32_t, 3>> triangles_;
  std::vector<TriangleCell> cells_;
  std::vector<std::size_t> fan_begin_;
  std::vector<std::int32_t> fans_;
  Eigen::Vector3d origin_{0, 0, 0};
  Eigen::Vector3d box_min_{0, 0, 0};
  Eigen::Vector3d box_max_{0, 0, 0};
  double depth_rounding_ = 0;
  bool moved_ = false;
  OrientReport orientation_;
};

}  // namespace thimble::render
