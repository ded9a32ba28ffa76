#pragma once

#include <optional>

#include "thimble/render/build_primitive_touch.h"
#include "thimble/render/mesh/triangle_mesh.h"
#include "thimble/scene/yaml_reader.h"

namespace thimble::scene {

/// Is a shape that stands in a scene instead of a mesh.
struct SceneShape {
  render::Primitive shape_W;
  render::TriangleMesh mesh_W;  ///< Drawn, and followed by the hand; nothing touches it.
};

/// Reads `plane`, `sphere` or `box` of an object that stands at p_WO (m), turned by R_WO. Nothing
/// if the object has none of them. Mistakes are noted by `object`. Real-time: never from the servo
/// thread.
std::optional<SceneShape> read_shape(YamlMap& object, const Eigen::Matrix3d& R_WO,
                                     const Eigen::Vector3d& p_WO);

}  // namespace thimble::scene
