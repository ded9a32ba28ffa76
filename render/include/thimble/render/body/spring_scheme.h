#pragma once

#include <array>
#include <string_view>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/render/body/network_bounds.h"

namespace thimble::render {

/// Integration scheme of a spring network. w is the highest frequency of the network, h the step
/// [PHYSICS 4].
enum class SpringScheme {
  kExplicitEuler,    ///< Order 1; gains energy unless dampers remove it; for comparison.
  kSymplecticEuler,  ///< Order 1; cheapest; stable for h below 2 / w.
  kVerlet,           ///< Order 2; stable for h below 2 / w; most accurate for its cost.
  kImplicitEuler,    ///< Order 1; never gains energy at any h; damps modes that it cannot resolve.
  kTrapezoid,        ///< Order 2; never gains energy at any h; modes that it cannot resolve ring.
  kExponential,      ///< Exact at any h, for nodes without springs between them.
  kModal,            ///< Exact at any h, for small meshes (modal_motion.h).
};

/// Default scheme. It is stable at any stiffness, mass and step, and comes to rest (spring_motion.h
/// has the proof).
inline constexpr SpringScheme kDefaultScheme = SpringScheme::kImplicitEuler;

inline constexpr std::array kSpringSchemes{
    SpringScheme::kExplicitEuler, SpringScheme::kSymplecticEuler, SpringScheme::kVerlet,
    SpringScheme::kImplicitEuler, SpringScheme::kTrapezoid,       SpringScheme::kExponential,
    SpringScheme::kModal};

/// Returns the name of a scheme in scenes ("implicit_euler"). Real-time: safe.
THIMBLE_EXPORT std::string_view name_of(SpringScheme scheme) noexcept;

/// Returns the largest step (s) at which the scheme stays bounded on a network with these bounds.
/// Infinity for schemes that are always bounded; 0 if there is no such step. The condition is
/// sufficient for any springs and dampers. It is also necessary without dampers, or, for symplectic
/// Euler, if the fastest mode is the most damped one too (all springs alike). Real-time: safe.
THIMBLE_EXPORT double largest_step(SpringScheme scheme, const NetworkBounds& bounds) noexcept;

}  // namespace thimble::render
