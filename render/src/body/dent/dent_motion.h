#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "body/dent/vertex_links.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/render/body/dent_settings.h"
#include "thimble/render/body/network_bounds.h"

namespace thimble::render {

/// Moves the vertices of a dent: those within some rings of the touched triangle, and those that
/// still oscillate. All others rest on their base points. No work in a tick grows with the mesh.
///
/// `u` is the displacement of a vertex from its base point (m, in the frame of the given mesh).
/// Springs and dampers are those of SpringNetwork, equal at all vertices and edges
/// (vertex_links.h), with up to three cursor springs that change from tick to tick. The cursor
/// springs act at the end of the step in every scheme, so that they may have any stiffness: at
/// infinity the vertex is at the cursor. The implicit schemes are those of SpringMotion, scaled in
/// the same way. For any number of rounds, without the cursor they never gain energy, and with it
/// no more than it supplies. So a few rounds in single precision are enough; scaled values are in
/// double precision.
class THIMBLE_EXPORT DentMotion {
 public:
  using Vector = Eigen::Vector3d;  ///< In W.
  /// Maximum number of vertices that move at once: 8 rings of a regular mesh are 243.
  static constexpr std::size_t kNodesMax = 512;
  static constexpr std::size_t kLinksMax = 8 * kNodesMax;  ///< Maximum number of springs at once.

  /// Prepares the vertices of a mesh, all on their base points. The error names an invalid setting,
  /// or the limit of the integrator that the step exceeds, with the remedy. Takes more substeps
  /// where they help. Real-time: never from the servo thread.
  static driver::Result<DentMotion> build(std::shared_ptr<const VertexLinks> links,
                                          const DentSettings& settings);

  // A copy would not have the reserved memory for moving vertices, so none would move.
  DentMotion(const DentMotion&) = delete;
  DentMotion& operator=(const DentMotion&) = delete;
  DentMotion(DentMotion&&) = default;
  DentMotion& operator=(DentMotion&&) = default;

  // All of the following are Real-time: safe. Precondition: numbers name existing vertices.

  /// Makes the vertices within the rings of `first` move (all of a whole body), and keeps those
  /// that still move. All others are put on their base points. If the capacity is exceeded,
  /// vertices are stopped.
  void gather(std::span<const std::int32_t> first) noexcept;
  /// Stops adding vertices: those that move continue until they have settled.
  void release() noexcept;

  /// A spring and a damper from the cursor to a vertex.
  struct CursorSpring {
    double stiffness = 0;    ///< N/m, 0 to infinity
    double damping = 0;      ///< N s/m, >= 0
    Vector target{0, 0, 0};  ///< Displacement at which it is at rest, m.
    Vector rate{0, 0, 0};    ///< Rate of change of the target, m/s.
  };
  /// Applies cursor spring `k` (0 to 2) to `vertex` during the next step. Has no effect on a vertex
  /// that does not move, or if the spring has a NaN.
  void pull(std::size_t k, std::int32_t vertex, const CursorSpring& spring) noexcept;
  /// Advances by one step and removes the cursor springs. Costs nothing while no vertex moves.
  void step() noexcept;
  /// Returns the mean force (N) of cursor spring `k` on its vertex over the last step.
  const Vector& force(std::size_t k) const noexcept { return grips_[k].force; }

  /// Returns the displacement of any vertex, m.
  Vector u(std::int32_t vertex) const noexcept {
    const std::int32_t s = places_[at(vertex)].slot;
    return s < 0 ? Vector(0, 0, 0) : Vector(u_[at(s)].head<3>());
  }
  /// Returns the velocity of any vertex, m/s. Real-time: safe.
  Vector v(std::int32_t vertex) const noexcept {
    const std::int32_t s = places_[at(vertex)].slot;
    return s < 0 ? Vector(0, 0, 0) : Vector(v_[at(s)].head<3>());
  }
  /// Returns whether a vertex moves.
  bool moves(std::int32_t vertex) const noexcept { return places_[at(vertex)].slot >= 0; }
  /// Returns the moving vertices.
  std::span<const std::int32_t> vertices() const noexcept { return vertices_; }
  bool resting() const noexcept { return vertices_.empty(); }  ///< Returns whether no vertex moves.
  /// Returns the stiffness (N/m) of a vertex of valence 6 with resting neighbours.
  double stiffness() const noexcept {
    return settings_.stiffness + 6 * settings_.neighbour_stiffness;
  }
  /// Returns the energy of springs and masses, without the cursor's springs, J.
  double energy() const noexcept;
  /// Returns the number of vertices that were stopped while they still oscillated, for lack of
  /// capacity.
  std::uint64_t cut() const noexcept { return cut_; }
  const DentSettings& settings() const noexcept { return settings_; }
  int substeps() const noexcept { return substeps_; }  ///< Returns the number of steps per tick.

 private:
  // A vector and a zero: the processor handles four numbers two or four at a time.
  using Lane = Eigen::Vector4d;
  using Lanef = Eigen::Vector4f;

  struct Place {
    std::int32_t slot = -1;   // index in the arrays below; -1: on its base point
    std::uint32_t round = 0;  // in which gather() has visited it
  };
  struct Link {
    std::int32_t slot = 0;
    float weight = 0;
  };
  struct Grip {
    std::int32_t slot = -1;
    double stiffness = 0;
    double damping = 0;
    Lane target{0, 0, 0, 0};
    Lane rate{0, 0, 0, 0};
    Vector force{0, 0, 0};
  };
  // One matrix of the network's pattern: `node` on the diagonal, `link` per weight of an edge.
  struct Weights {
    double node = 0;
    double link = 0;
  };

  DentMotion(std::shared_ptr<const VertexLinks> links, const DentSettings& settings);
  static std::size_t at(std::int32_t i) noexcept { return static_cast<std::size_t>(i); }
  NetworkBounds bounds() const noexcept;
  bool add(std::int32_t vertex) noexcept;
  void add_unsettled() noexcept;
  void prune() noexcept;
  void take_over() noexcept;
  void link_up() noexcept;
  bool unsettled(std::size_t slot) const noexcept;
  template <class Value>
  Value row(const Weights& weights, std::size_t i, const std::vector<Value>& x) const noexcept;
  Lane cursor_force(const Grip& grip, std::size_t i) const noexcept;
  void accelerate() noexcept;
  void drift(double time) noexcept;
  void reach_out() noexcept;
  void verlet() noexcept;
  void implicit(double share) noexcept;
  void solve(const Weights& system) noexcept;

  std::shared_ptr<const VertexLinks> links_;
  DentSettings settings_;
  Weights stiffness_, damping_;
  int substeps_ = 1;
  double h_ = 0;               // s per substep
  std::vector<Place> places_;  // of all vertices
  std::uint32_t round_ = 0;
  std::vector<std::int32_t> vertices_, gathered_;
  std::size_t wanted_ = 0;  // number of leading elements that are requested by the cursor
  std::size_t links_gathered_ = 0;
  std::vector<std::uint32_t> link_begin_;
  std::vector<Link> link_list_;
  std::vector<double> sum_;    // of all weights around a vertex, moving or not
  std::vector<double> extra_;  // contribution of the cursor's springs to the diagonal of the system
  std::vector<Lane> u_, v_, b_, w_, q_;
  std::vector<Lanef> wf_, rf_, pf_, qf_;  // for the rounds
  std::vector<float> inverse_, extraf_;
  std::array<Grip, 3> grips_;
  double largest_ = 0;  // largest displacement of the cursor since it touched, m
  int until_look_ = 0;
  std::uint64_t cut_ = 0;
};

}  // namespace thimble::render
