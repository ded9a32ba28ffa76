#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "thimble/driver/tick_record.h"
#include "thimble/render/body_patch.h"
#include "thimble/render/body_pose.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::view {

/// One object as it is drawn; a field has a mesh without triangles.
struct DrawnObject {
  std::string name;
  render::TriangleMesh mesh;      ///< W before the first tick, m.
  double crease_angle = 0.87;     ///< Edges sharper than this stay sharp, rad.
  bool stands_for_shape = false;  ///< Its triangles are not those that are touched.
  std::string texture{};          ///< What is felt of it, by name; empty: none.
  std::string friction{};         ///< As above.
  bool endless = false;           ///< A plane: drawn, but no part of what must fit in the picture.
  bool field = false;             ///< Felt everywhere, and has no triangles.
};

/// The force of a scene's fields on a tip that rests at a place.
struct FieldSample {
  Eigen::Vector3d p_W{0, 0, 0};  ///< m
  Eigen::Vector3d f_W{0, 0, 0};  ///< N
};

/// One point of the tip's path.
struct TrailPoint {
  Eigen::Vector3d p_WT{0, 0, 0};  ///< m
  double force = 0;               ///< N, on the hand.
};

/// What of a scene stays the same while it is drawn.
struct DrawnScene {
  std::string name;
  std::string arm;
  std::string
      arm_in_scene;  ///< What the scene calls the first of several; empty: it is the only one.
  std::vector<DrawnObject> objects;
  std::vector<FieldSample> field;  ///< Of all its fields together, on a grid; none: no field.
  double force_limit = 5;          ///< N
  double rate = 1000;              ///< Ticks per second, Hz.
};

/// One part of the arm: a rod between two points of the world, m.
using DrawnRod = std::pair<Eigen::Vector3d, Eigen::Vector3d>;

/// An arm after the first of a scene with several, at one moment.
struct DrawnArm {
  std::string name;  ///< What the scene calls it.
  driver::TickRecord tick;
  std::vector<DrawnRod> rods;  ///< From the base to the tip; empty: not drawn.
};

/// A scene at one moment.
struct DrawnMoment {
  driver::TickRecord tick;
  std::vector<render::BodyPose> poses;  ///< One per object of the scene.
  render::BodyPatch patch;              ///< No triangles if nothing is dented.
  std::vector<DrawnRod> arm;            ///< From the base to the tip; empty: not drawn.
  std::vector<DrawnArm> others;         ///< The arms after the first, if there are any.
  /// One per object: what it has been shaped to, triangles that were split included; null if it has
  /// not. A new shape is a new object.
  std::vector<std::shared_ptr<const render::TriangleMesh>> shapes;
  std::vector<TrailPoint> trail;  ///< Where the tip was in the last seconds, oldest first.
};

/// Takes a point of an object's frame to where it is now (W, m).
Eigen::Vector3d placed(const render::BodyPose& pose, const Eigen::Vector3d& p_B);

}  // namespace thimble::view
