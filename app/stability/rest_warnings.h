#pragma once

#include <string>
#include <vector>

#include "stability/rest_trial.h"
#include "thimble/scene/scene_file.h"

namespace thimble::render {
class ContactMesh;
}

namespace thimble::stability {

// What `thimble study trouble` found in limit cycles under a hand that rests, though no wall is
// stiffer than the loop carries. Each has a law, and each law a sentence that names the object, the
// number and the remedy. What counts as a limit cycle: 20 mN above 50 Hz [PHYSICS 6]. Real-time:
// never from the servo thread.

/// Returns which fields and weights push a hand that does not press, where the gate has the energy
/// bound, which lets no such force through; nothing with any other energy stage.
std::vector<std::string> energy_warnings(const scene::Scene& scene);

/// Returns what by the laws may be the cause of a limit cycle of a hand that rests on the object of
/// this name (empty: on any), a sentence each with the remedy: facets, textures, frictions, springs
/// that add up, light bodies, damping on coarse encoders. No more than causes: arm and hand may
/// damp what they tell of, so whether there is a limit cycle is for `try_rests` to say. Reads the
/// meshes that lie in memory; what cannot be read is passed over, for the loader tells.
std::vector<std::string> rest_causes(const scene::Scene& scene, const std::string& on = {});

/// Returns a sentence for each rest of a trial that is felt to oscillate, with its measure, and the
/// causes that the laws know for it; and one if a fault ended the trial.
std::vector<std::string> rest_warnings(const scene::Scene& scene,
                                       const stability::RestTrial& trial);

/// Returns the stiffness (N/m) that a texture's waves add along the surface for each newton of
/// pressing: the largest curvature of its height, 1/m; for sines a (2 pi / L)^2 [PHYSICS 1.1].
double curvature_of(const render::EffectPlan& texture);

/// Returns how stiff (N/m) a friction holds what sticks to it, over a micrometre of path; 0 if it
/// does not hold.
double hold_of(const render::EffectPlan& friction);

/// Returns the sharpest hollow edge of a mesh as it is touched (wound outwards), rad: by so much
/// the normal turns where a tip that rests in the hollow goes from one facet to the next. Edges up
/// to `from` (rad) are passed over.
double sharpest_hollow(const render::ContactMesh& mesh, double from);

/// Returns the quantisation noise (N RMS) of a damping `damping` (N s/m) on encoders of `step` (m)
/// at a `speed` (m/s), through a velocity filter of `corner` (Hz; 0: none) in a loop of `period`
/// (s).
///
/// A count is a pulse of b d / T in the unfiltered velocity; at p = v T / d counts per tick their
/// RMS about the mean is b d / T sqrt(p (1 - p)), of which a pole of gain g leaves g / (2 - g) of
/// the power.
double quantisation_noise_of(double damping, double step, double speed, double corner,
                             double period);

}  // namespace thimble::stability
