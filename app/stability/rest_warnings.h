#pragma once

#include <string>
#include <vector>

#include "stability/rest_trial.h"
#include "thimble/scene/scene_file.h"

namespace thimble::render {
class ContactMesh;
}

namespace thimble::stability {

// Causes that `thimble study trouble` found for limit cycles under a resting hand, although no wall
// is stiffer than the loop permits. Each has a law, and each law a sentence that names the object,
// the number and the remedy. A limit cycle is an oscillation of at least 20 mN above 50 Hz [PHYSICS
// 6]. Real-time: never from the servo thread.

/// Lists fields and weights that push a hand that does not press. Only for a gate with the energy
/// bound, which blocks such forces; empty with any other energy stage.
std::vector<std::string> energy_warnings(const scene::Scene& scene);

/// Lists possible causes, by the laws, of a limit cycle of a hand that rests on the object of this
/// name (empty: on any). Each is a sentence with the remedy. Causes are facets, textures,
/// frictions, springs that add up, light bodies, and damping on coarse encoders. They are only
/// possible causes: arm and hand may damp them, so only `try_rests` shows whether there is a limit
/// cycle. Reads the meshes that are in memory; unreadable ones are skipped, because the loader
/// reports them.
std::vector<std::string> rest_causes(const scene::Scene& scene, const std::string& on = {});

/// Returns a sentence for each rest of a trial with a perceptible oscillation: its size and the
/// causes by the laws. Adds one if a fault ended the trial.
std::vector<std::string> rest_warnings(const scene::Scene& scene,
                                       const stability::RestTrial& trial);

/// Returns the stiffness (N/m) that a texture's waves add along the surface for each newton of
/// pressing. It is the largest curvature of its height, 1/m; for sines a (2 pi / L)^2 [PHYSICS
/// 1.1].
double curvature_of(const render::EffectPlan& texture);

/// Returns the stiffness (N/m) of a friction in its sticking phase, over a micrometre of path; 0 if
/// it does not stick.
double hold_of(const render::EffectPlan& friction);

/// Returns the sharpest concave edge of a mesh as it is touched (wound outwards), rad. It is the
/// change of the normal when a tip that rests in the edge passes from one facet to the next. Edges
/// up to `from` (rad) are skipped.
double sharpest_concave_edge(const render::ContactMesh& mesh, double from);

/// Returns the quantisation noise (N RMS) of a damping `damping` (N s/m) on encoders of `step` (m)
/// at a `speed` (m/s). The velocity filter has the corner `corner` (Hz; 0: none), the loop the
/// period `period` (s).
///
/// A count is a pulse of b d / T in the unfiltered velocity. At p = v T / d counts per tick their
/// RMS about the mean is b d / T sqrt(p (1 - p)). A pole of gain g leaves g / (2 - g) of the power.
double quantisation_noise_of(double damping, double step, double speed, double corner,
                             double period);

}  // namespace thimble::stability
