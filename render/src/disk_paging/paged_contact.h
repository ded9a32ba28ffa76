#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <utility>

#include "disk_paging/paged_surface.h"
#include "thimble/driver/device_state.h"
#include "track/packed_contact.h"

namespace thimble::render {

/// A store with packed triangles from a page file; triangles far from the tip are absent.
class PagedStore {
 public:
  static constexpr bool kComplete = false;

  explicit PagedStore(std::shared_ptr<PagedSurface> surface) : surface_(std::move(surface)) {}

  // Functions of PackedStore. Real-time: safe.

  // A caller that reads one packed triangle continues with those around it.
  const PackedTriangle* find(std::int32_t triangle) const noexcept {
    const std::int32_t group = triangle / PagedSurface::kGroup;
    if (group != group_) {
      group_ = group;
      surface_->announce(triangle);
    }
    return surface_->find(triangle);
  }
  Eigen::Vector3d to_lattice(const Eigen::Vector3d& p) const noexcept {
    return (p - surface_->lattice().origin) / surface_->lattice().step;
  }
  double step() const noexcept { return surface_->lattice().step; }
  double reach() const noexcept { return surface_->settings().reach; }
  double rise() const noexcept { return surface_->file().rise(); }
  FoundEntry first_entry(const Eigen::Vector3d& p_from,
                         const Eigen::Vector3d& p_to) const noexcept {
    return surface_->first_entry(p_from, p_to);
  }
  Known inside(const Eigen::Vector3d& p) const noexcept {
    bool complete = false;
    const bool inside = surface_->inside(p, complete);
    return !complete ? Known::kUnknown : inside ? Known::kYes : Known::kNo;
  }
  FoundTriangle closest(const Eigen::Vector3d& p, double radius) const noexcept {
    FoundTriangle found;
    found.triangle = surface_->closest(p, radius, found.complete);
    return found;
  }

  PagedSurface& surface() const noexcept { return *surface_; }

 private:
  std::shared_ptr<PagedSurface> surface_;
  mutable std::int32_t group_ = -1;  // of the last packed triangle
};

extern template class PackedContact<PagedStore>;

/// Place of a paged mesh M in the world: a point of it is at p_WM + scale R_WM p_M.
struct PagedPlace {
  double scale = 1;                                    ///< Metres in W per metre of the file; > 0.
  Eigen::Matrix3d R_WM = Eigen::Matrix3d::Identity();  ///< Rotation of the file's frame.
  Eigen::Vector3d p_WM{0, 0, 0};                       ///< m
};

/// Finds the contact on a surface that has only the pages around the tip in memory [BP 4.1]. A
/// `Contact` stage of ContactForceLaw for meshes that do not fit into memory. It measures the same
/// as InMemoryContact.
///
/// The servo never waits for the disk. Absent parts are held (packed_contact.h), and the felt depth
/// never grows faster than the tip sinks in by more than `kRiseSpeed`. So a tip that entered while
/// pages were absent is pushed out slowly and not thrown out. Loaded parts that the tip entered are
/// felt unchanged.
class PagedContact {
 public:
  /// Speed at which a surface rises after the tip entered it while absent, m/s in W: so slow that a
  /// hand yields without effort. [chosen: a quarter of a calm stroke]
  static constexpr double kRiseSpeed = 0.02;

  /// Takes a surface for exclusive use by this contact, and its place. Real-time: never from the
  /// servo thread.
  explicit PagedContact(std::shared_ptr<PagedSurface> surface, const PagedPlace& place = {});

  /// Finds the contact at `state.p_WT` (W, m) and keeps it until the next call, as
  /// PackedContact::update. Real-time: safe; never waits.
  const ContactState& update(const driver::DeviceState& state) noexcept;

  /// Returns the result of the last `update`. Real-time: safe.
  const ContactState& state() const noexcept { return state_; }

  /// Returns the surface point of the tip at `p_WT` (W, m) (PackedContact::foot). Real-time: safe;
  /// never waits.
  ClosestSurfacePoint closest(const Eigen::Vector3d& p_WT) const noexcept;

  const TrackerCounters& counters() const noexcept { return contact_.counters(); }
  /// Returns the number of ticks in which a needed page was absent.
  std::uint64_t misses() const noexcept { return contact_.ticks_held(); }
  PagedSurface& surface() const noexcept { return contact_.store().surface(); }
  const PagedPlace& place() const noexcept { return place_; }  ///< Returns the place.

  /// The query `inside` for other threads than the servo.
  class Search {
   public:
    /// Returns whether a point (W, m) is inside; reads the needed pages from disk. False if that
    /// fails. Real-time: never from the servo thread.
    bool inside(const Eigen::Vector3d& p_W) const;

   private:
    friend class PagedContact;
    explicit Search(const PagedContact& contact) : contact_(contact) {}
    const PagedContact& contact_;
  };
  Search search() const noexcept { return Search(*this); }

 private:
  Eigen::Vector3d in_mesh(const Eigen::Vector3d& p_W) const noexcept {
    return place_.R_WM.transpose() * (p_W - place_.p_WM) * per_scale_;
  }
  double allowed_depth(const driver::DeviceState& state, const Eigen::Vector3d& n_W) const noexcept;

  PackedContact<PagedStore> contact_;
  PagedPlace place_;
  double per_scale_ = 1;
  ContactState state_;
  Eigen::Vector3d p_WT_before_{0, 0, 0};
  bool has_before_ = false;
};

}  // namespace thimble::render
