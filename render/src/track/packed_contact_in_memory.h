#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>

#include "compact_mesh/packed_surface.h"
#include "search/free_space.h"
#include "search/make_search.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "track/packed_contact.h"

namespace thimble::render {

/// A store that has all packed triangles in memory and a search over them. For use by one thread at
/// a time: it remembers the free space around the last path.
class THIMBLE_EXPORT InMemoryStore {
 public:
  static constexpr bool kComplete = true;

  /// Takes a prepared surface and builds its search (make_search). Real-time: never from the servo
  /// thread.
  explicit InMemoryStore(PackedSurface surface, std::optional<SearchChoice> search = {});
  /// Takes a shared surface and a shared search over it. Real-time: never from the servo thread.
  InMemoryStore(std::shared_ptr<const PackedSurface> surface,
                std::shared_ptr<const ContactSearch> search);

  // Functions of PackedStore. Real-time: safe.

  const PackedTriangle* find(std::int32_t triangle) const noexcept { return triangles_ + triangle; }
  Eigen::Vector3d to_lattice(const Eigen::Vector3d& p_W) const noexcept {
    return (p_W - origin_) * per_step_;  // as PackedSurface does, from this cache line
  }
  double step() const noexcept { return step_; }
  double reach() const noexcept { return std::numeric_limits<double>::infinity(); }
  /// Returns the height by which the surface rises above its triangles, m (PackedSurface::rise).
  double rise() const noexcept { return surface_->rise(); }
  FoundEntry first_entry(const Eigen::Vector3d& p_from,
                         const Eigen::Vector3d& p_to) const noexcept {
    return {.entry = free_space_.first_entry(*search_, p_from, p_to)};
  }
  Known inside(const Eigen::Vector3d& p_W) const noexcept {
    return search_->inside(p_W) ? Known::kYes : Known::kNo;
  }
  FoundTriangle closest(const Eigen::Vector3d& p_W, double radius) const noexcept {
    return {.triangle = search_->closest(p_W, radius).triangle};
  }

  const PackedSurface& surface() const noexcept { return *surface_; }
  const ContactSearch& search() const noexcept { return *search_; }

 private:
  // Members used by each tick come first.
  const PackedTriangle* triangles_;
  Eigen::Vector3d origin_;
  double per_step_, step_;
  // On the heap, so that the search's pointer to the surface stays valid when the contact is moved.
  std::shared_ptr<const PackedSurface> surface_;
  std::shared_ptr<const ContactSearch> search_;
  mutable FreeSpace free_space_;  // changes the cost of a query, never its result
};

extern template class PackedContact<InMemoryStore>;

/// Finds the contact on a smooth surface of any size that fits into memory. A `Contact` stage of
/// ContactForceLaw, used instead of MeshContact where meshes are large or curved. Tracking and
/// measures are described in packed_contact.h.
class THIMBLE_EXPORT InMemoryContact : public PackedContact<InMemoryStore> {
 public:
  /// Takes a prepared surface and builds its search (make_search). Real-time: never from the servo
  /// thread.
  explicit InMemoryContact(PackedSurface surface, std::optional<SearchChoice> search = {});
  /// Takes a shared surface and a shared search over it. Real-time: never from the servo thread.
  InMemoryContact(std::shared_ptr<const PackedSurface> surface,
                  std::shared_ptr<const ContactSearch> search);

  /// Prepares a mesh (W, m); the error is that of PackedSurface::build.
  /// Real-time: never from the servo thread.
  static driver::Result<InMemoryContact> build(const TriangleMesh& mesh,
                                               const PackedSurfaceOptions& options = {});

  /// A copy shares mesh and search, and does not allocate.
  static constexpr bool kCopiesCheaply = true;

  /// See PackedContact::begin_at. Real-time: safe.
  void begin(std::int32_t triangle, const Eigen::Vector3d& p_WP) noexcept {
    begin_at(triangle, p_WP);
  }

  const PackedSurface& surface() const noexcept { return store().surface(); }
  const ContactSearch& search() const noexcept { return store().search(); }
};

}  // namespace thimble::render
