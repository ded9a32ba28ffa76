#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/render/body/dent_settings.h"
#include "thimble/render/body/shape_choice.h"
#include "thimble/render/contact_choice.h"
#include "thimble/render/effect/effect_table.h"
#include "thimble/render/mesh/mesh_file.h"
#include "thimble/render/mesh/triangle_mesh.h"
#include "thimble/render/object_touch.h"
#include "thimble/render/surface/spring_damper.h"

namespace thimble::render {

class HeightImage;

/// Texture coordinates and vertex colours of a touched mesh.
struct SurfaceMaps;

/// Returns the maps of a mesh (W, m). `attributes` are those of its file, with the triangles in the
/// same order. The error states that their numbers differ. Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<std::shared_ptr<const SurfaceMaps>> make_surface_maps(
    const TriangleMesh& mesh_W, const MeshAttributes& attributes);

/// Quantity that varies over a surface: by a grey picture on the texture coordinates, or by one of
/// the vertex colours. The value is interpolated between `black` and `white`.
struct MapChoice {
  /// Picture, read by a scene; null: vertex colours.
  std::shared_ptr<const HeightImage> image = {};
  std::size_t channel = 0;  ///< Vertex colour: 0 red, 1 green, 2 blue.
  double black = 0;         ///< Value where picture or colour are 0.
  double white = 1;         ///< Value where picture or colour are full.
};

/// Surface properties of one object: its spring, and the effects of the scene in the order of
/// execution.
struct SurfaceChoice {
  SpringDamper spring;                   ///< Spring and damper of the surface.
  std::vector<EffectPlan> effects = {};  ///< Effects on the surface.
  /// Denting; only for a mesh in memory, other objects are stiff.
  std::optional<DentSettings> dent = {};
  /// Deformation of the base points; only for a mesh in memory.
  ShapeChoice shape = {};
  /// Maps of the mesh, for all below and for effects that need them; only for a mesh in memory that
  /// does not deform.
  std::shared_ptr<const SurfaceMaps> maps = {};
  /// Factor of the stiffness of `spring`, from 0 to 1.
  std::optional<MapChoice> stiffness_map = {};
  /// Factor of the coefficients of all frictions in `effects`, >= 0.
  std::optional<MapChoice> friction_map = {};
  /// Stage that replaces `spring`, if it holds a function.
  StageBuilder spring_stage = {};
};

/// Builds the force law of one object (mesh in W, m) from only the stages that `choice` and
/// `surface` name. The error is that of ContactMesh::build, or names incompatible stages.
/// Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<std::unique_ptr<ObjectTouch>> build_object_touch(
    const TriangleMesh& mesh_W, const ContactChoice& choice, const SurfaceChoice& surface);

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
