#pragma once

#include <array>
#include <string_view>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/render/body/network_bounds.h"

namespace thimble::render {

/// Names a way to step a spring network in time. w is its highest frequency, h the step
/// [PHYSICS 4].
enum class SpringScheme {
  kExplicitEuler,    ///< order 1; gains energy wherever dampers do not take it: to show why not
  kSymplecticEuler,  ///< order 1; cheapest; h below 2 / w
  kVerlet,           ///< order 2; h below 2 / w; the best bargain below that
  kImplicitEuler,    ///< order 1; never gains energy at any h; damps what it cannot follow
  kTrapezoid,        ///< order 2; never gains energy at any h; what it cannot follow rings
  kExponential,      ///< exact at any h, for nodes that no springs join
  kModal,            ///< exact at any h, for small meshes (modal_motion.h)
};

/// The scheme of whoever names none: the one that is stable at any stiffness, mass and step and
/// comes to rest as well (spring_motion.h has the proof).
inline constexpr SpringScheme kDefaultScheme = SpringScheme::kImplicitEuler;

inline constexpr std::array kSpringSchemes{
    SpringScheme::kExplicitEuler, SpringScheme::kSymplecticEuler, SpringScheme::kVerlet,
    SpringScheme::kImplicitEuler, SpringScheme::kTrapezoid,       SpringScheme::kExponential,
    SpringScheme::kModal};

/// Returns the name of a scheme as scenes spell it ("implicit_euler"). Real-time: safe.
THIMBLE_EXPORT std::string_view name_of(SpringScheme scheme) noexcept;

/// Finds the largest step (s) at which the scheme stays bounded on a network with these bounds;
/// infinity for the schemes that always are. Sufficient for any springs and dampers; also
/// necessary where there are no dampers or, for symplectic Euler, where the fastest mode is the
/// most damped one too (all springs alike). 0: never. Real-time: safe.
THIMBLE_EXPORT double largest_step(SpringScheme scheme, const NetworkBounds& bounds) noexcept;

}  // namespace thimble::render
