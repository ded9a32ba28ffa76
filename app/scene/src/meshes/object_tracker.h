#pragma once

#include <span>
#include <string>
#include <vector>

#include "meshes/object_mesh.h"
#include "thimble/driver/export.h"
#include "thimble/render/build_object_touch.h"
#include "thimble/scene/scene_file.h"
#include "thimble/scene/scene_objects.h"

namespace thimble::scene {

/// Returns the surface settings of an object. Real-time: never from the servo thread.
render::SurfaceChoice surface_of(const SceneObject& object);

/// Returns whether the mesh of an object decides its tracker: the object is a mesh in memory that
/// names none, and none of its other settings requires one. Real-time: never from the servo thread.
bool mesh_decides_tracker(const SceneObject& object);

/// Returns the contact settings of an object with the tracker that touches it, and the reason.
/// Precondition: the object is a mesh in memory. Real-time: never from the servo thread.
ObjectTracker tracker_of(const SceneObject& object, const ObjectMesh& mesh);

/// Returns a line on the chosen trackers, for each group of objects with the same tracker and
/// reason: "elephant: compact (smooth: ...)". Objects that name their tracker are omitted.
/// Real-time: never from the servo thread.
std::vector<std::string> describe_trackers(const Scene& scene,
                                           std::span<const ObjectTracker> trackers);

}  // namespace thimble::scene
