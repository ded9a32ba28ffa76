#pragma once

#include <span>

#include "view/drawn_scene.h"
#include "view/gl/coloured_model.h"

namespace thimble::view {

/// Returns the colour that stands for a share of the strongest force, from 0 (blue) over amber to 1
/// (vermillion): lightness differs as well, and people who see two primaries only tell them apart.
Colour force_colour(double share);

/// Returns the force (N) that the strongest colour stands for: the round number (1, 2 or 5 times a
/// power of ten) above all forces of the field and of the tip's trail; 0 if there are none.
double strongest_force(const DrawnScene& scene, const DrawnMoment& moment);

/// Adds the forces of a scene's fields as arrows, coloured by force; longer for
/// stronger ones, less than in proportion so that weak ones are seen as well. `strongest` (N) is
/// the scale's end.
void add_field(const DrawnScene& scene, double strongest, ColouredMesh& mesh);

/// Adds the tip's trail as a tube of this radius (m), coloured by force.
void add_trail(std::span<const TrailPoint> trail, double strongest, double radius,
               ColouredMesh& mesh);

}  // namespace thimble::view
