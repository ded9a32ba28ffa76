#pragma once

#include <span>

#include "view/drawn_scene.h"
#include "view/gl/coloured_model.h"

namespace thimble::view {

/// Returns the colour for a fraction of the strongest force, from 0 (blue) over amber to 1
/// (vermillion). The lightness differs too, so that colour-blind people can distinguish the
/// colours.
Colour force_colour(double share);

/// Returns the force (N) of the strongest colour: the round number (1, 2 or 5 times a power of ten)
/// above all forces of the field and of the tip's trail; 0 if there are none.
double strongest_force(const DrawnScene& scene, const DrawnMoment& moment);

/// Adds the forces of a scene's fields as arrows, coloured by force. The length grows less than in
/// proportion to the force, so that weak forces are visible as well. `strongest` (N) is the end of
/// the scale.
void add_field(const DrawnScene& scene, double strongest, ColouredMesh& mesh);

/// Adds the tip's trail as a tube of this radius (m), coloured by force.
void add_trail(std::span<const TrailPoint> trail, double strongest, double radius,
               ColouredMesh& mesh);

}  // namespace thimble::view
