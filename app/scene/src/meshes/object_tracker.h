#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "meshes/object_mesh.h"
#include "thimble/render/build_object_touch.h"
#include "thimble/scene/scene_file.h"
#include "thimble/scene/scene_objects.h"
#include "thimble/scene/shared_meshes.h"

namespace thimble::scene {

/// Returns the surface settings of an object. Real-time: never from the servo thread.
render::SurfaceChoice surface_of(const SceneObject& object);

/// Returns whether the tracker of an object is the one that suits its mesh (SharedMeshes::tracker).
/// Precondition: the object is a mesh in memory. Real-time: never from the servo thread.
bool takes_suitable_tracker(const SceneObject& object);

/// Returns the contact settings of an object with the tracker that touches it, and the reason.
/// `meshes` keeps the choice for `mesh`. Precondition: the object is a mesh in memory. Real-time:
/// never from the servo thread.
ObjectTracker tracker_of(const SceneObject& object, const std::shared_ptr<const ObjectMesh>& mesh,
                         SharedMeshes& meshes);

/// Returns a line on the chosen trackers, for each group of objects with the same tracker and
/// reason: "elephant: compact (smooth: ...)". Objects that name their tracker are omitted.
/// Real-time: never from the servo thread.
std::vector<std::string> describe_trackers(const Scene& scene,
                                           std::span<const ObjectTracker> trackers);

}  // namespace thimble::scene
