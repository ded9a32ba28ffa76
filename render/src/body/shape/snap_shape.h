#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "body/shape/shape_contact.h"
#include "body/shape/snap_base.h"
#include "body/shape/surface_patch.h"
#include "mesh/contact_mesh.h"
#include "thimble/render/body/shape_choice.h"

namespace thimble::render {

/// Moves the base points of a mesh like the wall of a tin can. Around the press a panel gives way
/// elastically. Past the threshold it jumps to a second shape and stays there.
///
/// All base points of a panel move in together, by a smooth profile times the displacement of one
/// SnapBase: 1 up to a quarter of the radius, then falling to 0 at the radius. Until it snaps, the
/// panel follows the tip. Afterwards it stays in place, and the next one begins elsewhere. Pressed
/// off its middle, where the profile is p, it feels 1 / p^2 times as stiff.
class SnapShape {
 public:
  /// Takes the surface's stiffness (N/m, > 0) and the mesh in its first shape. Its vertices' places
  /// (`first_places`) must outlive this object. Real-time: never from the servo thread.
  SnapShape(const SnapChoice& choice, double stiffness, const ContactMesh& mesh,
            std::span<const Eigen::Vector3d> first_places);

  // All of the following are Real-time: safe.

  /// Moves the panels under a contact for `step` s. Returns the distance by which the touched place
  /// moves inwards, m.
  double press(const ContactMesh& mesh, const ShapeContact& contact, double step) noexcept;
  /// Moves the panels for `step` s without a contact.
  void rest(double step) noexcept;

  /// Calls `take` with the vertices whose place may have changed in the last call, one panel after
  /// the other.
  template <class Take>
  void for_each_moved(Take take) const noexcept {
    for (const Panel& panel : panels_) {
      if (!panel.moved) continue;
      for (const std::int32_t vertex : panel.vertices) take(vertex);
    }
    for (const std::int32_t vertex : left_) take(vertex);
  }

  /// Returns the displacement of a vertex that was at `p_first` (m), m.
  Eigen::Vector3d displacement(const Eigen::Vector3d& p_first) const noexcept;

  /// Returns the number of snaps. Each releases energy (J): the work that pressed the panel in less
  /// the energy that it keeps. It goes into sound and heat.
  std::int64_t snaps() const noexcept;
  double energy() const noexcept;                         ///< Returns the energy in the panels, J.
  double released() const noexcept { return released_; }  ///< Returns the total energy released, J.

  static constexpr std::size_t kVerticesMax = 512;  ///< Maximum number of vertices of a panel.

 private:
  struct Panel {
    Eigen::Vector3d centre{0, 0, 0};
    Eigen::Vector3d inward{0, 0, 0};
    SnapBase base;
    std::vector<std::int32_t> vertices;
    bool used = false;
    bool moved = false;
  };

  double profile(double distance) const noexcept;
  double hold_of(const Panel& panel, const ShapeContact& contact) const noexcept;
  void lead(const ContactMesh& mesh, const ShapeContact& contact) noexcept;
  bool room_for(const Eigen::Vector3d& centre) const noexcept;
  void put(Panel& panel, const ContactMesh& mesh, const ShapeContact& contact) noexcept;
  double pull(Panel& panel, double end, double spring, double step) noexcept;

  SnapChoice choice_;
  SnapSettings truss_;
  double stiffness_;
  std::span<const Eigen::Vector3d> first_places_;
  std::vector<Eigen::Vector3d> first_normals_;  // inwards, of the vertices
  SurfacePatch patch_;
  std::vector<Panel> panels_;
  std::vector<std::int32_t> left_;  // vertices of a panel that has moved elsewhere
  Panel* live_ = nullptr;           // the panel that follows the tip
  double released_ = 0;
  std::int64_t snaps_ = 0;
};

}  // namespace thimble::render
