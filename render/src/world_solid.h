#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "thimble/driver/device_state.h"
#include "thimble/driver/force_law.h"
#include "thimble/render/contact_state.h"

namespace thimble::render {

/// Place where a path enters a solid.
struct SolidEntry {
  std::int32_t triangle = -1;  ///< Triangle of the solid's own mesh; -1 for none.
  double parameter = 0;        ///< 0 at the begin of the path, 1 at its end.
};

/// Move of a solid's surface before a tick.
struct SolidMove {
  std::int32_t swept_over = -1;   ///< Triangle that has passed over the free proxy; -1: none.
  Eigen::Vector3d p_WP{0, 0, 0};  ///< Place of the proxy on that triangle, m.
  double path = 0;                ///< Path of the surface near the proxy, m.
  /// Centre of a ball that contains the solid in this tick, W, m.
  Eigen::Vector3d p_centre{0, 0, 0};
  double radius = std::numeric_limits<double>::infinity();  ///< Of that ball, m; infinite: unknown.
};

/// Axis-aligned box, m in W.
struct SolidBox {
  Eigen::Vector3d min{0, 0, 0};  ///< Smallest coordinates.
  Eigen::Vector3d max{0, 0, 0};  ///< Largest coordinates.
};

/// One solid of a world of several (world/contact_world.h), with the contact of one tip. The world
/// decides where contact begins and at which position the solid is followed. Frame W, m.
///
/// All functions but `prepare_fallback` are Real-time: safe.
class WorldSolid {
 public:
  WorldSolid() = default;
  WorldSolid(const WorldSolid&) = delete;
  WorldSolid& operator=(const WorldSolid&) = delete;
  virtual ~WorldSolid() = default;

  /// Returns the box of the solid. If `moves`, the box of its first place.
  virtual SolidBox box() const noexcept = 0;
  /// Returns the distance from the surface within which rounding may decide on which side a point
  /// is, m.
  virtual double rounding() const noexcept = 0;
  /// Returns the stiffness of the surface, N/m.
  virtual double stiffness() const noexcept = 0;
  /// Returns whether a point is inside.
  virtual bool inside(const Eigen::Vector3d& p_W) const noexcept = 0;
  /// Returns whether a point is inside the solid itself, without the radius of the tip.
  virtual bool in_solid(const Eigen::Vector3d& p_W) const noexcept { return inside(p_W); }

  /// Returns whether `begin_tick` and `end_tick` must be called in every tick.
  virtual bool changes() const noexcept { return false; }
  /// Returns whether the solid may be outside of `box`.
  virtual bool moves() const noexcept { return false; }
  /// Takes the place of this tick. `p_WP` is the proxy of the last tick; `touching` is whether this
  /// solid was active. Unless it was, or `swept_over` is set, `path` may be 0.
  virtual SolidMove begin_tick(const driver::DeviceState& /*state*/,
                               const Eigen::Vector3d& /*p_WP*/, bool /*touching*/) noexcept {
    return {};
  }
  /// Lets the solid give way and move after the force of a tick. The arguments are those of
  /// `begin_tick`, of this tick. Returns the energy in its storages, J (ForceCommand::stored).
  virtual double end_tick(const Eigen::Vector3d& /*p_WP*/, bool /*touching*/) noexcept { return 0; }

  /// Finds the first triangle that a path crosses from outside to inside.
  virtual SolidEntry first_entry(const Eigen::Vector3d& p_from,
                                 const Eigen::Vector3d& p_to) noexcept = 0;

  /// Begins contact on a triangle, with the proxy at `p_WP`. Returns the contact there, of depth 0.
  virtual const ContactState& begin(std::int32_t triangle,
                                    const Eigen::Vector3d& p_WP) noexcept = 0;
  /// Continues a contact that has ended in this tick, on its last triangle, with the proxy at
  /// `p_WP`.
  virtual void revive(const Eigen::Vector3d& p_WP) noexcept = 0;
  /// Follows a tip at `p_W` over the surface by the tracker of the object; contact may end.
  /// Precondition: contact has begun.
  virtual const ContactState& follow(const Eigen::Vector3d& p_W) noexcept = 0;
  /// Returns whether `follow` itself moves the proxy only over the part of the surface that it can
  /// reach.
  virtual bool follows_closely() const noexcept = 0;
  /// Returns whether the surface on which `follow` keeps the proxy is that of `inside`: no tracker
  /// that smooths it.
  virtual bool is_exact() const noexcept { return follows_closely(); }
  /// Returns the number of steps of the last `follow`, where each may take tens of microseconds.
  virtual int steps() const noexcept { return 0; }
  /// Does the same with a proxy that never leaves the part of the surface that it can reach
  /// (GodObjectContact), or by the plane of the last face if the mesh is not in memory. Continues
  /// from the contact `last`.
  virtual const ContactState& follow_closely(const ContactState& last,
                                             const Eigen::Vector3d& p_W) noexcept = 0;
  /// Writes the normals of the faces on which the proxy of the last `follow` rests, if these are
  /// two or three that form a concave edge or corner of the solid itself, and returns their number;
  /// 0 where one plane describes the contact.
  virtual std::size_t holding_faces(std::array<Eigen::Vector3d, 3>& /*n_W*/) const noexcept {
    return 0;
  }
  /// Returns the force of a contact, which was found at `state.p_WT` and may have been changed in
  /// depth and normal.
  virtual driver::ForceCommand feel(const driver::DeviceState& state,
                                    const ContactState& contact) noexcept = 0;
  /// Resets the surface stages after the last tick that was felt.
  virtual void leave() noexcept = 0;

  /// Prefetches the memory for the contact of a tick with about this state.
  virtual void prepare(const driver::DeviceState& /*expected*/) const noexcept {}
  /// Allocates what `follow_closely` needs. Real-time: never from the servo thread.
  virtual void prepare_fallback() {}
};

}  // namespace thimble::render
