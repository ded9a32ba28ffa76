#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "thimble/driver/tick_record.h"
#include "thimble/render/body_patch.h"
#include "thimble/render/body_pose.h"
#include "thimble/render/mesh/triangle_mesh.h"
#include "view/gl/palette.h"

namespace thimble::view {

/// A map of a surface, as a colour of its triangles.
struct DrawnMap {
  std::string quantity;  ///< "stiffness"
  std::string unit;
  double min = 0, max = 0;    ///< Values at 0 and 1.
  std::size_t parts = 0;      ///< Parts of each side of a triangle; 0: no map.
  std::vector<float> values;  ///< 0 to 1, of the grid of each triangle (triangle_grid.h).
};

/// One object as drawn; a field has a mesh without triangles.
struct DrawnObject {
  std::string name;
  render::TriangleMesh mesh;    ///< In W before the first tick, m.
  double crease_angle = 0.87;   ///< Edges sharper than this stay sharp, rad.
  bool is_placeholder = false;  ///< Its triangles are not those of the contact.
  std::string texture{};        ///< Name of its texture; empty: none.
  std::string friction{};       ///< Name of its friction; empty: none.
  bool endless = false;         ///< A plane: drawn, but not framed by the camera.
  bool field = false;           ///< Acts everywhere and has no triangles.
  DrawnMap map{};               ///< Of an object that does not deform.
  /// Shape with which it collides, in W before the first tick, m. Without triangles: it meets
  /// nothing, or is a plane.
  render::TriangleMesh collider{};
};

/// The force of a scene's fields on a tip at rest.
struct FieldSample {
  Eigen::Vector3d p_W{0, 0, 0};  ///< m
  Eigen::Vector3d f_W{0, 0, 0};  ///< N
};

/// One point of the tip's path.
struct TrailPoint {
  Eigen::Vector3d p_WT{0, 0, 0};  ///< m
  double force = 0;               ///< N, on the hand.
};

/// The constant part of a scene that is drawn.
struct DrawnScene {
  std::string name;
  std::string arm;
  std::string
      arm_in_scene;  ///< Name of the first arm in a scene with several; empty: it is the only one.
  std::vector<DrawnObject> objects;
  std::vector<FieldSample> field;  ///< Force of all fields together, on a grid; empty: no field.
  double force_limit = 5;          ///< N
  double tip_radius = 0;           ///< Radius of a tip that is a ball, m; 0: a point.
  double rate = 1000;              ///< Ticks per second, Hz.
  double duration = 0;             ///< Planned duration of the run, s; 0: unknown.
};

/// One part of the arm: a rod between two points of the world, m.
using DrawnRod = std::pair<Eigen::Vector3d, Eigen::Vector3d>;

/// How an arm differs from others in the picture.
struct ArmLook {
  std::optional<Colour> colour;  ///< Of arm, tip and force; none: the usual colours.
  bool ended = false;            ///< Its recording has ended: no force is drawn.
};

/// An arm after the first, at one moment, in a scene with several, or of another recording.
struct DrawnArm {
  std::string name;  ///< Its name in the scene.
  driver::TickRecord tick;
  std::vector<DrawnRod> rods;  ///< From the base to the tip; empty: not drawn.
  ArmLook look{};
};

/// The state of a scene at one moment.
struct DrawnMoment {
  driver::TickRecord tick;
  std::vector<render::BodyPose> poses;  ///< One per object of the scene.
  render::BodyPatch patch;              ///< No triangles if nothing is dented.
  std::vector<DrawnRod> arm;            ///< From the base to the tip; empty: not drawn.
  ArmLook look{};                       ///< Of the first arm.
  std::vector<DrawnArm> others;         ///< The arms after the first, if there are any.
  /// One per object: its permanently deformed mesh, including split triangles; null if it has none.
  /// A new shape is a new object.
  std::vector<std::shared_ptr<const render::TriangleMesh>> shapes;
  std::vector<TrailPoint> trail;  ///< Positions of the tip in the last seconds, oldest first.
};

/// Returns the current position (W, m) of a point of an object's frame.
Eigen::Vector3d placed(const render::BodyPose& pose, const Eigen::Vector3d& p_B);

}  // namespace thimble::view
