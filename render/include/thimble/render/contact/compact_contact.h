#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>

#include "thimble/driver/device_state.h"
#include "thimble/driver/result.h"
#include "thimble/render/contact/bvh.h"
#include "thimble/render/contact/compact_surface.h"
#include "thimble/render/contact/contact_state.h"
#include "thimble/render/contact/surface_tracker.h"

namespace thimble::render {

/// Finds what the tip touches on a smooth surface of any size: a tree of boxes while it is free,
/// tracking from triangle to triangle while it touches. The `Contact` stage of Touch; the place of
/// MeshContact where meshes are large or curved.
///
/// Lowered by d along its corner normals, a triangle x_i becomes the triangle x_i - d n_i. The one
/// that holds the tip p, for its own d, is active:
///
///        n_0        n_1          p = sum l_i (x_i - d n_i),  l_i >= 0, sum l_i = 1
///     x_0 \__________/ x_1       n_W = sum l_i n_i, normalised
///          \   q    /            depth = (q - p) . n_W + bend, q = sum l_i x_i
///           \__p___/             bend = sum l_i (x_i - q) . n_i / (1 + |sum l_i n_i|)
///
/// Neighbours share lowered edges to the bit, so depth and direction are continuous over edges and
/// vertices. `bend` is how far a smooth surface with these normals rises above the triangle, right
/// to second order [STABILITY 3]. Over a crease the tip changes sides at the plane that halves the
/// angle, where both faces measure the same depth [BP 3.1, Fig. 4b], and the direction jumps.
///
/// Contact begins when the path enters the triangles themselves: on a bulge of edge length L and
/// radius R the depth starts at up to L^2 / 6R [STABILITY 3]. It ends when the depth is negative
/// and the tip is outside the triangles; in a hollow the depth is 0 until then.
class CompactContact {
 public:
  /// Takes a prepared surface and builds the tree. Real-time: never from the servo thread.
  explicit CompactContact(CompactSurface surface);

  /// Prepares a mesh (W, m); the error is that of CompactSurface::build.
  /// Real-time: never from the servo thread.
  static driver::Result<CompactContact> build(const TriangleMesh& mesh,
                                              const CompactSurfaceOptions& options = {});

  /// Finds the contact at `state.p_WT` (W, m) and keeps it until the next call; `triangle` is the
  /// number of a record. A tip that is inside on the first tick touches nothing until it has been
  /// outside. A position that is NaN or beyond `kPositionMax` ends the contact and makes the next
  /// tick a first one. Real-time: safe; tens of ns in contact, at worst `kHopsMax` triangles,
  /// `kPatchMax` more and two questions to the tree.
  const ContactState& update(const driver::DeviceState& state) noexcept;

  /// Gives the result of the last `update`. Real-time: safe.
  const ContactState& state() const noexcept { return state_; }

  const TrackerCounters& counters() const noexcept { return counters_; }
  const CompactSurface& surface() const noexcept { return *surface_; }
  const Bvh& search() const noexcept { return *search_; }

 private:
  // Is the active record unpacked. Lengths are in steps of the lattice; a point p is held as
  // p - x_0 = a e_1 + b e_2 - h f with the sides e_1, e_2 and the unit normal f, and so are the
  // corner normals: n_i = u_i e_1 + v_i e_2 + w_i f.
  struct Facet {
    std::int32_t triangle = -1;
    std::uint32_t creases = 0;
    Eigen::Vector3d corner{0, 0, 0}, side_1{0, 0, 0}, side_2{0, 0, 0}, face{0, 0, 0};
    Eigen::Vector3d dual_1{0, 0, 0}, dual_2{0, 0, 0};  // a = dual_1 . (p - x_0), b = dual_2 . ...
    std::array<Eigen::Vector3d, 3> normals;
    // Per axis: at corner 0, and by how much it is more at corners 1 and 2.
    std::array<double, 3> u{}, v{}, w{};
    double rise_1 = 0, rise_2 = 0;  // e_1 . n_1, e_2 . n_2
    double tilt_squared = 0;        // of the normals against the face, at most
  };
  // Is where the tip stands in the lowered triangle.
  struct Place {
    double l0 = 0, l1 = 0, l2 = 0;  // negative: outside the edge opposite of that corner
    double depth = 0;               // d
    bool valid = false;             // false where the lowered triangle is folded over
  };

  bool follow(const Eigen::Vector3d& p_WT, const Eigen::Vector3d& p) noexcept;
  bool holds(const Eigen::Vector3d& p, const Place& place) const noexcept;
  bool settle(const Eigen::Vector3d& p, bool walked, Place& place) noexcept;
  void unpack(std::int32_t triangle) noexcept;
  Place locate(const Eigen::Vector3d& p) const noexcept;
  int edge_to_hop(const Eigen::Vector3d& p, const Place& place) const noexcept;
  double side_of_crease(const Eigen::Vector3d& p, std::size_t edge) const noexcept;
  std::int32_t walk(std::int32_t triangle, const Eigen::Vector3d& p,
                    std::uint16_t& hops) const noexcept;
  bool find_near(const Eigen::Vector3d& p, std::int32_t before) noexcept;
  bool find_again(const Eigen::Vector3d& p, std::int32_t before) noexcept;
  void report(const Eigen::Vector3d& p_WT, const Place& place) noexcept;
  void report_nearest(const Eigen::Vector3d& p_WT, const Eigen::Vector3d& p) noexcept;

  // On the heap, so that the tree keeps pointing at the surface when the contact moves.
  std::shared_ptr<const CompactSurface> surface_;
  std::shared_ptr<const Bvh> search_;
  Facet facet_;
  ContactState state_;
  TrackerCounters counters_;
  Eigen::Vector3d p_WT_before_{0, 0, 0};
  bool has_before_ = false;
};

}  // namespace thimble::render
