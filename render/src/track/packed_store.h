#pragma once

#include <Eigen/Core>
#include <concepts>
#include <cstdint>

#include "compact_mesh/packed_surface.h"
#include "search/contact_search.h"

namespace thimble::render {

/// An answer of a store that may lack the packed triangles it would need to know.
enum class Known : std::uint8_t { kNo, kYes, kUnknown };

/// Where a segment first enters the surface; not `complete`: among the packed triangles at hand.
struct FoundEntry {
  Entry entry;           ///< Where the path goes in, if it does.
  bool complete = true;  ///< Whether all packed triangles were at hand.
  bool leaves =
      false;  ///< Whether it ends outside again; only stores that lack packed triangles tell.
};

/// The packed triangle nearest to a point, -1 for none; not `complete`: among the packed
/// triangles at hand.
struct FoundTriangle {
  std::int32_t triangle = -1;  ///< The nearest; -1: none.
  bool complete = true;        ///< Whether all packed triangles were at hand.
};

/// Where a PackedContact takes its packed triangles from. All questions are in W and m, and
/// Real-time: safe. `kComplete` says that no packed triangle is ever absent; then the contact holds
/// no code for that.
// clang-format off
template <class Store>
concept PackedStore = requires(const Store& store, std::int32_t t, const Eigen::Vector3d& p_W,
                               double radius) {
  { Store::kComplete } -> std::convertible_to<bool>;
  // The packed triangle, nullptr if it is absent; good until the end of the tick.
  { store.find(t) } noexcept -> std::same_as<const PackedTriangle*>;
  { store.to_lattice(p_W) } noexcept -> std::same_as<Eigen::Vector3d>;
  { store.step() } noexcept -> std::same_as<double>;
  // Once it has caught up, everything is at hand this near to the tip and to what it touches.
  { store.reach() } noexcept -> std::same_as<double>;
  { store.first_entry(p_W, p_W) } noexcept -> std::same_as<FoundEntry>;
  { store.inside(p_W) } noexcept -> std::same_as<Known>;
  { store.closest(p_W, radius) } noexcept -> std::same_as<FoundTriangle>;
};

// Can tell how far the surface rises above its triangles at most, m: then contact begins there.
template <class Store>
concept TellsRise = requires(const Store& store) {
  { store.rise() } noexcept -> std::same_as<double>;
};
// clang-format on

}  // namespace thimble::render
