#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/adjacency.h"
#include "mesh/repair/orient_mesh.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// A plane with unit normal: `n . x + d` is the signed distance (m) of a point x.
struct Plane {
  Eigen::Vector3d n{0, 0, 0};  ///< Unit normal.
  double d = 0;                ///< m; n x + d = 0 on it.

  /// Returns the distance of a point from the plane, m, positive outside. Real-time: safe.
  double distance(const Eigen::Vector3d& x) const noexcept { return n.dot(x) + d; }
};

/// The data of one triangle that a tracker needs, in one place of memory. Points are relative to
/// ContactMesh::origin, so that a mesh far from the world's origin loses no digits.
struct TriangleCell {
  Plane face;                              ///< Outward normal; positive outside.
  std::array<std::int32_t, 3> neighbours;  ///< Triangle behind the edge from corner k to k + 1.
  /// Sharpness of its concave edges: sine of half the angle between the normals over the sharpest
  /// of them, in 1 / kSineUnit, rounded up; 0 if there is none, or the mesh has no edge planes.
  std::uint16_t concave = 0;
  /// Lean of the faces around its corners: the same sine for the largest angle to one of them, when
  /// the mesh was built; kSineUnit at a corner of more than `kFanMax` faces; 0 without edge planes.
  std::uint16_t around = 0;

  static constexpr double kSineUnit = 65535;
  /// Maximum number of faces around a corner that are examined one by one.
  static constexpr std::size_t kFanMax = 64;
  /// Sine of half an angle that is rounding: two faces in one plane.
  static constexpr double kFlat = 1e-9;

  /// Returns the distance inside a concave edge's plane (m) up to which a tip `depth` (m) below the
  /// face may be next to the face, not under it; 0 if no edge is concave. Real-time: safe.
  double concave_reach(double depth) const noexcept { return depth * (concave / kSineUnit); }
};

/// Options of building a contact mesh.
struct ContactMeshOptions {
  /// Winds triangles consistently and outwards (see orient_mesh); for a closed surface only one
  /// result is right. If false, meshes that need it are refused.
  bool orient = true;
  /// Computes the data for trackers that walk over edges. If false, the mesh must keep its shape.
  bool edge_planes = true;
  /// Stores edge planes, 96 of 200 bytes per triangle. If false, stores 24 bytes from which each
  /// plane is computed when needed (`edge_plane`), and the mesh must keep its shape. No effect
  /// without `edge_planes`.
  bool keep_planes = true;
  /// How far vertices may later move out of the box, as a share of its longest side, >= 0:
  /// `box_min` and `box_max` grow by it on all sides. 0 for a mesh that keeps its shape.
  double room = 0;
  /// Maximum number of triangles to which the mesh may grow by ContactMesh::split_edge; 0 for a
  /// mesh that keeps its triangles. Memory for them is reserved at once, 350 bytes each.
  std::size_t triangles_max = 0;
};

/// New place of a vertex.
struct VertexMove {
  std::int32_t vertex = 0;       ///< Number of the vertex.
  Eigen::Vector3d p_W{0, 0, 0};  ///< Its new position, m.
};

/// Result of splitting an edge in its middle, with the two triangles at it. Each triangle keeps its
/// number and the half at the first of the edge's ends; the other halves get new numbers.
struct EdgeSplit {
  std::int32_t vertex = -1;                 ///< The new middle vertex; -1: no split.
  std::array<std::int32_t, 2> ends{};       ///< The vertex kept by `triangles`, the one lost.
  std::array<std::int32_t, 2> triangles{};  ///< Triangles that keep their numbers.
  std::array<std::int32_t, 2> others{};     ///< The new triangles next to each.
};

/// A mesh prepared for contact: closed, consistently wound, with face planes, edge planes and
/// neighbours. Frame W, m.
///
/// The edge plane of two neighbours goes through their shared edge and the average of their unit
/// normals [BP 3.1, Fig. 4b]. Points on it are equally deep below both faces, so the depth does not
/// jump when the active triangle changes. Both neighbours store the same numbers with opposite
/// signs, so rounding cannot make each send the tip to the other.
class THIMBLE_EXPORT ContactMesh {
 public:
  /// Checks a mesh (W, m) and prepares it. The error joins the messages about all faults that
  /// prevent contact (see check_mesh). Real-time: never from the servo thread.
  static driver::Result<ContactMesh> build(const TriangleMesh& mesh,
                                           const ContactMeshOptions& options = {});

  // All of the following are Real-time: safe. Precondition: numbers are valid.

  std::int32_t triangle_count() const noexcept { return static_cast<std::int32_t>(cells_.size()); }

  std::int32_t vertex_count() const noexcept { return static_cast<std::int32_t>(vertices_.size()); }

  /// Returns the number of components that were wholly inside out and have been turned.
  std::size_t turned_components() const noexcept { return orientation_.turned_components; }

  /// Returns the report of all turned triangles.
  const OrientReport& orientation() const noexcept { return orientation_; }

  /// Returns the corners of a triangle, counter-clockwise from outside.
  const std::array<std::int32_t, 3>& corners(std::int32_t triangle) const noexcept {
    return triangles_[static_cast<std::size_t>(triangle)];
  }

  /// Returns the position of a vertex, m in W. All code reads positions by this function.
  const Eigen::Vector3d& position(std::int32_t vertex) const noexcept {
    return vertices_[static_cast<std::size_t>(vertex)];
  }

  /// Moves a vertex to `p_W` (m; finite), and with it the planes of the triangles around it and of
  /// their neighbours. Data built over the mesh (boxes of a search, smooth normals) is not updated;
  /// MovingMesh does that. A triangle that loses its area has the normal 0 and no depth. Real-time:
  /// safe; some 20 ns per triangle around the vertex.
  void move_vertex(std::int32_t vertex, const Eigen::Vector3d& p_W) noexcept;

  /// Returns whether a vertex has moved, or an edge was split, since the mesh was built.
  bool moved() const noexcept { return moved_; }

  /// Splits edge `k` of a triangle in its middle, with the triangle behind it. This adds one vertex
  /// and two triangles; no vertex is inside an edge of another triangle. The surface moves only by
  /// rounding. Both triangles keep the half at the edge's begin if `keep_begin`, else at its end.
  /// Splits nothing if the mesh may not grow (ContactMeshOptions::triangles_max), a vertex would
  /// have more than kValenceMax triangles, or the two triangles share more than this edge.
  /// Real-time: safe; about a microsecond.
  EdgeSplit split_edge(std::int32_t triangle, std::size_t k, bool keep_begin) noexcept;

  /// Returns the maximum number of triangles.
  std::size_t triangles_max() const noexcept { return std::max(triangles_max_, triangles_.size()); }
  std::size_t vertices_max() const noexcept {  ///< Returns the maximum number of vertices.
    return vertices_.size() + (triangles_max() - triangles_.size()) / 2;
  }

  static constexpr std::size_t kValenceMax = 64;  ///< Maximum valence after a split.

  /// Returns the position of corner `k` of a triangle, m in W.
  const Eigen::Vector3d& position(std::int32_t triangle, std::size_t k) const noexcept {
    return position(corners(triangle)[k]);
  }

  /// Returns the face and the neighbours of a triangle, relative to `origin`.
  const TriangleCell& cell(std::int32_t triangle) const noexcept {
    return cells_[static_cast<std::size_t>(triangle)];
  }

  /// Returns the planes over the edges of a triangle from corner k to k + 1, positive on its side
  /// [BP 4b], relative to `origin`. Precondition: `keeps_planes`.
  const std::array<Plane, 3>& edge_planes(std::int32_t triangle) const noexcept {
    return edges_[static_cast<std::size_t>(triangle)];
  }

  /// Returns whether edge planes are stored (ContactMeshOptions).
  bool keeps_planes() const noexcept { return edges_.data() != nullptr; }

  /// Returns one edge plane, bit-identical whether stored or computed. Computing takes some 60 ns,
  /// or 25 to 50 from the stored 24 bytes (ContactMeshOptions::keep_planes).
  Plane edge_plane(std::int32_t triangle, std::size_t k) const noexcept {
    return keeps_planes() ? edge_planes(triangle)[k] : made_edge_plane(triangle, k);
  }

  /// Returns whether edge `k` is concave: whether the faces rise from it.
  bool concave_edge(std::int32_t triangle, std::size_t k) const noexcept {
    return edge_plane(triangle, k).n.dot(cell(triangle).face.n) < -TriangleCell::kFlat;
  }

  /// Lists the triangles around a vertex.
  std::span<const std::int32_t> fan(std::int32_t vertex) const noexcept {
    const Fan fan = fan_of_[static_cast<std::size_t>(vertex)];
    return {fans_.data() + fan.begin(), fan.count()};
  }

  /// Returns the origin of the cells: the middle of the box, m in W.
  const Eigen::Vector3d& origin() const noexcept { return origin_; }

  /// Return the corners of the box of the vertices at building, grown by ContactMeshOptions::room;
  /// m, W. Searches use this box and find nothing outside.
  const Eigen::Vector3d& box_min() const noexcept { return box_min_; }
  const Eigen::Vector3d& box_max() const noexcept {
    return box_max_;
  }  ///< Returns the other corner.

  /// Returns whether a point is in the box; false for NaN.
  bool in_box(const Eigen::Vector3d& p_W) const noexcept {
    return (p_W.array() >= box_min_.array()).all() && (p_W.array() <= box_max_.array()).all();
  }

  /// Returns the depth of a point below a triangle's plane, m; negative outside.
  double depth(std::int32_t triangle, const Eigen::Vector3d& p_W) const noexcept {
    return -cell(triangle).face.distance(p_W - origin_);
  }

  /// Returns the depth below which rounding decides its sign, m.
  double depth_rounding() const noexcept { return depth_rounding_; }

 private:
  // Moves many vertices at once and updates each face and edge around them once.
  friend class MovingMesh;

  // Position of the triangles around a vertex in fans_; of 2^31 triangles at most.
  class Fan {
   public:
    Fan(std::uint64_t begin, std::uint64_t count) noexcept : word_(begin | count << kBits) {}
    std::size_t begin() const noexcept { return word_ & ((std::uint64_t{1} << kBits) - 1); }
    std::size_t count() const noexcept { return word_ >> kBits; }

   private:
    static constexpr int kBits = 33;
    std::uint64_t word_;
  };

  ContactMesh() = default;
  template <class Work>
  void for_all(const Work& work) const;
  void make_room(std::size_t triangles_max);
  bool add_to_fan(std::int32_t vertex, std::int32_t triangle) noexcept;
  void change_fan(std::int32_t vertex, const EdgeSplit& split) noexcept;
  static ContactMesh assemble(const TriangleMesh& mesh, const Adjacency& neighbours,
                              const ContactMeshOptions& options);
  void compute_face(std::int32_t triangle) noexcept;
  void compute_edge(std::int32_t triangle, std::size_t k) noexcept;
  std::int32_t place_edge(std::int32_t triangle, std::size_t k) noexcept;
  struct EdgeSides;  // data of two faces for an edge plane
  EdgeSides edge_sides(std::int32_t triangle, std::size_t k) const noexcept;
  Plane made_edge_plane(std::int32_t triangle, std::size_t k) const noexcept;
  void compute_edges();
  void compute_edge_sizes();
  void measure_edges(std::int32_t triangle) noexcept;
  void collect_fans();
  void measure_around();

  std::vector<Eigen::Vector3d> vertices_;
  std::vector<std::array<std::int32_t, 3>> triangles_;
  std::vector<TriangleCell> cells_;
  std::vector<std::array<Plane, 3>> edges_;  // empty if planes are not stored
  // For computed planes: the divisor of the normal; 0: the plane is along a face.
  std::vector<std::array<double, 3>> edge_sizes_;
  std::vector<Fan> fan_of_;
  std::vector<std::int32_t> fans_;
  std::size_t fans_built_ = 0;  // size of fans_ at building; grown fans are behind it
  std::size_t triangles_max_ = 0;
  Eigen::Vector3d origin_{0, 0, 0};
  Eigen::Vector3d box_min_{0, 0, 0};
  Eigen::Vector3d box_max_{0, 0, 0};
  double depth_rounding_ = 0;
  bool moved_ = false;
  OrientReport orientation_;
};

}  // namespace thimble::render
