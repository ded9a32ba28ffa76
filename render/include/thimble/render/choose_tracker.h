#pragma once

#include <optional>
#include <string>

#include "thimble/driver/export.h"
#include "thimble/render/build_object_touch.h"
#include "thimble/render/contact_choice.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// Contact settings with a tracker that was chosen, and the reason.
struct ChosenTracker {
  /// The settings that were given, with the tracker. For kPacked also with the crease angle, if
  /// none was given and the mesh needs another one than the default.
  ContactChoice contact;
  /// Reason in a few words: "smooth: 98 % of the area curves, by 10 degrees over an edge".
  std::string reason;
};

/// Chooses the tracker of an object: kPacked for a smooth mesh (a scan, a turned part), kEdgePlanes
/// for a faceted one (a die, a part with chamfers) and wherever another setting excludes kPacked:
/// `contact` (blending, normals, curved_depth, band, profile) or `surface` (a dent, or a
/// deformation of the base shape). `contact.tracker` is ignored. If the tip has a radius, no
/// tracker is used, and `contact` is returned unchanged.
///
/// The result depends on angles and ratios of areas only: scaling, rotating and renumbering the
/// mesh do not change it, except by rounding. Any mesh is accepted; one that contact rejects gets
/// kEdgePlanes. Takes some 50 ns per triangle. Real-time: never from the servo thread.
THIMBLE_EXPORT ChosenTracker choose_tracker(const TriangleMesh& mesh,
                                            const ContactChoice& contact = {},
                                            const SurfaceChoice& surface = {});

/// Returns the tracker that the other settings of an object require, as `choose_tracker` does;
/// empty if its mesh decides. Real-time: never from the servo thread.
THIMBLE_EXPORT std::optional<ChosenTracker> required_tracker(const ContactChoice& contact,
                                                             const SurfaceChoice& surface);

}  // namespace thimble::render
