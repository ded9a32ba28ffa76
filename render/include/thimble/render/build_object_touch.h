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

/// How the surface of one object feels: its spring, and the effects a scene puts on it in the
/// order in which a tick runs them.
struct SurfaceChoice {
  SpringDamper spring;                    ///< Of the surface.
  std::vector<EffectPlan> effects = {};   ///< What is put on it.
  std::optional<DentSettings> dent = {};  ///< Of a mesh in memory; others are stiff.
  ShapeChoice shape = {};                 ///< Of a mesh in memory: how its base points move.
};

/// Builds the force law of one object (mesh in W, m) from just the stages that `choice` and
/// `surface` name. The error is that of ContactMesh::build, or says which stages do not go
/// together. Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<std::unique_ptr<ObjectTouch>> build_object_touch(
    const TriangleMesh& mesh_W, const ContactChoice& choice, const SurfaceChoice& surface);

}  // namespace thimble::render
