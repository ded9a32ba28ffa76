#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "compact_mesh/large_pages.h"
#include "mesh/contact_mesh.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// Half the side of the lattice that positions are rounded to: 2^-31 of the mesh's longest side
/// is one step, and the difference of two positions fits into 32 bits.
inline constexpr double kLatticeHalf = 0x1p30;

/// All data of one triangle for a tick, in one cache line.
///
///     byte 0    36          48         60     64
///     | x y z  | normals   | neighbours | flags |
struct alignas(64) PackedTriangle {
  std::array<std::int32_t, 3> x, y, z;     ///< Corners on the lattice, one array per axis.
  std::array<std::uint32_t, 3> normals;    ///< Corner normals, octahedral, 16 bits per half.
  std::array<std::int32_t, 3> neighbours;  ///< Triangle over the edge from corner k to k + 1.
  std::uint32_t flags;  ///< Bit k: edge k is a crease. From bit 3: the input's number.

  /// Shift of the input's number in `flags`: 2^28 triangles fit, the maximum of a surface.
  static constexpr int kSourceShift = 3;

  /// Returns whether an edge is a crease. Real-time: safe.
  bool crease(std::size_t edge) const noexcept { return ((flags >> edge) & 1u) != 0; }

  /// Returns the number of the triangle in the input.
  std::int32_t source() const noexcept { return static_cast<std::int32_t>(flags >> kSourceShift); }

  /// Returns the position of corner `k`, in steps of the lattice from its middle; exact.
  Eigen::Vector3d corner(std::size_t k) const noexcept {
    return {static_cast<double>(x[k]), static_cast<double>(y[k]), static_cast<double>(z[k])};
  }
};
static_assert(sizeof(PackedTriangle) == 64 && alignof(PackedTriangle) == 64);

/// The packed value of a coordinate of 1. It has many divisors that the normals of symmetric
/// shapes are integers. At a half, the rounding of a scaled mesh would decide.
inline constexpr float kOctahedron = 32760;

/// Packs a unit vector into two signed numbers of 16 bits: the octahedron |x| + |y| + |z| = 1
/// unfolded onto a square [Meyer]. Wrong by at most 7e-5 rad. Real-time: safe.
THIMBLE_EXPORT std::uint32_t pack_normal(const Eigen::Vector3d& n) noexcept;

/// Returns the unpacked unit vector. Real-time: safe.
Eigen::Vector3d unpack_normal(std::uint32_t packed) noexcept;

/// Options of building a packed surface.
struct PackedSurfaceOptions {
  /// The angle between two faces above which their edge stays sharp, rad. 43 degrees: an
  /// icosahedron (41.8) is still a ball, a bevel (45) is an edge.
  double crease_angle = 0.75;
};

/// A closed surface as packed triangles of 64 bytes, sorted such that each eight, each 64 and so on
/// are close together: neighbours in space are near in memory. Frame W, m.
///
/// Corner normals are averages of the faces around, weighted by their angles [Thuermer]; a fan of
/// faces is split at its creases. Two triangles that share a smooth edge have bit-identical data
/// for its two ends. Packed triangles are numbered by their place; `source` returns the triangle of
/// the input.
class THIMBLE_EXPORT PackedSurface {
 public:
  /// Takes a prepared mesh, which has been checked completely. Positions move by up to 2^-32 of the
  /// longest side. Real-time: never from the servo thread.
  static driver::Result<PackedSurface> build(const ContactMesh& mesh,
                                             const PackedSurfaceOptions& options = {});

  /// Takes an unchecked mesh (W, m), in linear time. The error names a triangle that is not finite,
  /// has no area, or lacks its one consistently wound neighbour. Does not check whether a component
  /// is inside out; ContactMesh::build does. Real-time: never from the servo thread.
  static driver::Result<PackedSurface> build(const TriangleMesh& mesh,
                                             const PackedSurfaceOptions& options = {});

  /// All data of a surface besides its triangles.
  struct Frame {
    std::array<double, 3> origin{};  ///< m, W
    double step = 0;                 ///< m
    double per_step = 0;             ///< 1/m
    double rise = 0;                 ///< m
  };
  /// All packed triangles of a surface.
  using Triangles = std::vector<PackedTriangle, LargePages<PackedTriangle>>;

  /// Returns the frame, to store it with the triangles. Real-time: safe.
  Frame frame() const noexcept {
    return {{origin_.x(), origin_.y(), origin_.z()}, step_, per_step_, rise_};
  }

  /// Returns a stored surface. None if it cannot be one: there is no triangle, a number of a
  /// triangle is out of range, or a number of the frame is not finite. Real-time: never from the
  /// servo thread.
  static std::optional<PackedSurface> restore(const Frame& frame, Triangles triangles);

  // All of the following are Real-time: safe. Precondition: numbers are valid.

  std::int32_t triangle_count() const noexcept {
    return static_cast<std::int32_t>(triangles_.size());
  }
  /// Returns the packed triangle of a triangle. Real-time: safe.
  const PackedTriangle& triangle(std::int32_t t) const noexcept {
    return triangles_[static_cast<std::size_t>(t)];
  }
  std::span<const PackedTriangle> triangles() const noexcept {
    return triangles_;
  }  ///< Returns all packed triangles.

  /// Returns the number of a packed triangle in the input.
  std::int32_t source(std::int32_t t) const noexcept { return triangle(t).source(); }

  /// Returns the position of corner `k` of a packed triangle, m in W. Equal for all packed
  /// triangles that share it.
  Eigen::Vector3d position(std::int32_t t, std::size_t k) const noexcept {
    return origin_ + step_ * triangle(t).corner(k);
  }

  /// Converts a point (W, m) to steps of the lattice from its middle.
  Eigen::Vector3d to_lattice(const Eigen::Vector3d& p_W) const noexcept {
    return (p_W - origin_) * per_step_;
  }

  const Eigen::Vector3d& origin() const noexcept { return origin_; }  ///< Returns its origin, m.
  /// Returns the length of one step of the lattice, m.
  double step() const noexcept { return step_; }
  /// Returns the number of steps in 1 m.
  double per_step() const noexcept { return per_step_; }

  /// Returns the maximum height of the smooth surface defined by the normals above the triangles,
  /// m; 0 if it is less than 1e-5 of the size and cannot be felt.
  double rise() const noexcept { return rise_; }

  /// Returns the bytes of memory held.
  std::size_t bytes() const noexcept { return triangles_.capacity() * sizeof(PackedTriangle); }

 private:
  PackedSurface() = default;

  Triangles triangles_;
  Eigen::Vector3d origin_{0, 0, 0};
  double step_ = 0;
  double per_step_ = 0;
  double rise_ = 0;
};

}  // namespace thimble::render
