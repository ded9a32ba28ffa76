#pragma once

#include <string>
#include <vector>

#include "stability/rest_trial.h"
#include "thimble/scene/scene_file.h"

namespace thimble::render {
class ContactMesh;
}

namespace thimble::stability {

// Causes of limit cycles under a resting hand found by `thimble study trouble`, although no wall
// exceeds the loop's limit. Each cause has a law, and each law a sentence with the object, the
// number and the remedy. A limit cycle means at least 20 mN above 50 Hz [PHYSICS 6]. Real-time:
// never from the servo thread.

/// Returns a sentence for each field and weight that pushes a hand without contact while the gate
/// uses the energy bound, which blocks such forces; empty with any other energy stage.
std::vector<std::string> energy_warnings(const scene::Scene& scene);

/// Returns possible causes of a limit cycle of a hand that rests on the object of this name (empty:
/// on any), by the laws, a sentence each with the remedy. They are facets, textures, frictions,
/// springs that add up, light bodies, damping on coarse encoders. These are only possible causes:
/// arm and hand may damp the limit cycle, so `try_rests` decides whether there is one. Uses the
/// meshes in memory; unreadable meshes are ignored, because the loader reports them.
std::vector<std::string> rest_causes(const scene::Scene& scene, const std::string& on = {});

/// Returns a sentence for each rest of a trial with a perceptible oscillation, with its size and
/// the causes known by the laws; and one if a fault ended the trial.
std::vector<std::string> rest_warnings(const scene::Scene& scene,
                                       const stability::RestTrial& trial);

/// Returns the tangential stiffness (N/m) that a texture adds per newton of normal force: the
/// largest curvature of its height, 1/m; for sines a (2 pi / L)^2 [PHYSICS 1.1].
double curvature_of(const render::EffectPlan& texture);

/// Returns the stiffness (N/m) of a friction in stick over a micrometre of path; 0 if it does not
/// stick.
double hold_of(const render::EffectPlan& friction);

/// Returns the sharpest concave edge of a mesh for contact (oriented outwards), rad. This is the
/// change of the normal when a tip that rests in the groove changes from one facet to the next.
/// Edges up to `from` (rad) are ignored.
double sharpest_hollow(const render::ContactMesh& mesh, double from);

/// Returns the quantisation noise (N RMS) of a damping `damping` (N s/m) on encoders of `step` (m)
/// at a `speed` (m/s), through a velocity filter of `corner` (Hz; 0: none) in a loop of `period`
/// (s).
///
/// A count is a pulse of b d / T in the unfiltered velocity. At p = v T / d counts per tick the RMS
/// about the mean is b d / T sqrt(p (1 - p)); a pole of gain g passes g / (2 - g) of the power.
double quantisation_noise_of(double damping, double step, double speed, double corner,
                             double period);

}  // namespace thimble::stability
