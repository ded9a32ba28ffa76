#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/render/body/dent_settings.h"
#include "thimble/render/body/shape_choice.h"
#include "thimble/render/contact_choice.h"
#include "thimble/render/effect/effect_table.h"
#include "thimble/render/mesh/triangle_mesh.h"
#include "thimble/render/object_touch.h"
#include "thimble/render/surface/spring_damper.h"

namespace thimble::render {

/// Surface properties of one object: its spring, and the effects of the scene in the order of
/// execution.
struct SurfaceChoice {
  SpringDamper spring;                   ///< Spring and damper of the surface.
  std::vector<EffectPlan> effects = {};  ///< Effects on the surface.
  /// Denting; only for a mesh in memory, other objects are stiff.
  std::optional<DentSettings> dent = {};
  /// Deformation of the base points; only for a mesh in memory.
  ShapeChoice shape = {};
};

/// Builds the force law of one object (mesh in W, m) from only the stages that `choice` and
/// `surface` name. The error is that of ContactMesh::build, or names incompatible stages.
/// Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<std::unique_ptr<ObjectTouch>> build_object_touch(
    const TriangleMesh& mesh_W, const ContactChoice& choice, const SurfaceChoice& surface);

}  // namespace thimble::render
