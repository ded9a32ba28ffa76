#pragma once

#include <Eigen/Core>
#include <concepts>
#include <cstdint>

#include "compact_mesh/packed_surface.h"
#include "search/contact_search.h"

namespace thimble::render {

/// Result of a query to a store in which packed triangles may be absent.
enum class Known : std::uint8_t { kNo, kYes, kUnknown };

/// First entry of a segment into the surface; if not `complete`, among the packed triangles in
/// memory.
struct FoundEntry {
  Entry entry;           ///< The entry, if there is one.
  bool complete = true;  ///< Whether all needed packed triangles were in memory.
  bool leaves =
      false;  ///< Whether the segment ends outside again; only set by stores with absent triangles.
};

/// The packed triangle nearest to a point; if not `complete`, among the packed triangles in memory.
struct FoundTriangle {
  std::int32_t triangle = -1;  ///< Index of the triangle; -1: none.
  bool complete = true;        ///< Whether all needed packed triangles were in memory.
};

/// Source of the packed triangles of a PackedContact. All queries are in W and m, and Real-time:
/// safe. With `kComplete` no packed triangle is ever absent, and the contact is compiled without
/// code for that.
// clang-format off
template <class Store>
concept PackedStore = requires(const Store& store, std::int32_t t, const Eigen::Vector3d& p_W,
                               double radius) {
  { Store::kComplete } -> std::convertible_to<bool>;
  // The packed triangle, nullptr if it is absent; valid until the end of the tick.
  { store.find(t) } noexcept -> std::same_as<const PackedTriangle*>;
  { store.to_lattice(p_W) } noexcept -> std::same_as<Eigen::Vector3d>;
  { store.step() } noexcept -> std::same_as<double>;
  // Distance around the tip and the contact within which everything is in memory, once loading has
  // caught up.
  { store.reach() } noexcept -> std::same_as<double>;
  { store.first_entry(p_W, p_W) } noexcept -> std::same_as<FoundEntry>;
  { store.inside(p_W) } noexcept -> std::same_as<Known>;
  { store.closest(p_W, radius) } noexcept -> std::same_as<FoundTriangle>;
};

// The store knows the maximum height of the surface above its triangles, m; contact then begins
// there.
template <class Store>
concept HasRise = requires(const Store& store) {
  { store.rise() } noexcept -> std::same_as<double>;
};
// clang-format on

}  // namespace thimble::render
