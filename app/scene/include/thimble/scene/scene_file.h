#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/render/body/dent_settings.h"
#include "thimble/render/body/motion_choice.h"
#include "thimble/render/body/shape_choice.h"
#include "thimble/render/build_primitive_touch.h"
#include "thimble/render/contact_choice.h"
#include "thimble/render/effect/effect_table.h"
#include "thimble/render/field/field_table.h"
#include "thimble/render/mesh/triangle_mesh.h"
#include "thimble/scene/arm_file.h"
#include "thimble/scene/hand_route.h"
#include "thimble/scene/shipped_files.h"

namespace thimble::scene {

/// A shape that stands in a scene instead of a mesh.
struct SceneShape {
  render::Primitive shape_W;    ///< What is touched.
  render::TriangleMesh mesh_W;  ///< Drawn, and followed by the hand; nothing touches it.
};

/// The material of an object: what is left empty the scene does not call for.
struct SceneBody {
  std::optional<render::DentSettings> dent;    ///< The surface dents under the cursor.
  render::ShapeChoice shape;                   ///< Base points keep what they gave way, or snap.
  std::optional<render::MotionChoice> motion;  ///< All base points move together.
};

/// One object of a scene: a mesh, a shape or a field, where it stands, and how it feels.
struct SceneObject {
  std::string name;                  ///< Unlike any other of the scene.
  std::filesystem::path mesh_file;   ///< Empty for a shape or a field.
  bool paged = false;                ///< Whether that is a page file, of which little is in memory.
  std::optional<SceneShape> shape;   ///< A shape instead of a mesh.
  render::FieldBuilder build_field;  ///< A field instead of a mesh; it has no surface.
  std::optional<double> size;        ///< Largest side of the mesh's box, m.
  std::optional<double> scale;       ///< Metres per unit of the file, if no size: as the file
                                     ///< says, else 1.
  bool repair = false;               ///< Whether the mesh is repaired first (repair_mesh).
  std::optional<double> sheet_thickness;  ///< Of the sheets that are made of what is open, m.
  Eigen::Matrix3d R_WO = Eigen::Matrix3d::Identity();  ///< Rotation of the mesh in the world.
  Eigen::Vector3d p_WO{0, 0, 0};            ///< Where the centre of the turned mesh's box lies, m.
  double stiffness = 0;                     ///< N/m
  double damping = 0;                       ///< N s/m
  render::ContactChoice contact;            ///< How the surface is found, followed and felt.
  bool tracker_named = false;               ///< Whether the scene says how it is followed.
  std::vector<render::EffectPlan> effects;  ///< What is put on it, as a tick runs them.
  SceneBody body;                           ///< Its material.
  render::BodyCoupling coupling;            ///< How stiff its surface answers, if it moves.
};

/// Where a scene puts one of several arms: turned about the vertical, then moved.
struct THIMBLE_EXPORT ArmPlace {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();  ///< By a multiple of 90 degrees.
  Eigen::Vector3d p{0, 0, 0};                       ///< m

  /// Returns an arm, whose file says how it stands alone, where it stands among others.
  /// Real-time: never from the servo thread.
  ArmFile put(ArmFile arm) const;
};

/// An arm of a scene, with the hand that leads it if it is simulated.
struct SceneArm {
  std::string name;  ///< Unlike any other of the scene ("left"); of a single arm empty.
  std::filesystem::path arm_file;  ///< Where `arm` comes from.
  std::filesystem::path
      own_arm_file;                ///< What the scene itself names; used for the simulation alone.
  ArmPlace place;                  ///< Where the scene puts it.
  ArmFile arm;                     ///< Put there.
  std::vector<HandWaypoint> hand;  ///< What the simulated hand does.
};

/// What a fault of one of several arms does to the others.
enum class FaultRule {
  kTogether,  ///< It takes the force of all, and ends the run.
  kApart,     ///< The others go on.
};

/// One scene: which arms touch what, how fast the loop runs, and what the simulated hand does.
struct Scene {
  std::string name;                                       ///< For people.
  std::string description;                                ///< A few sentences; may be empty.
  std::filesystem::path file;                             ///< Where the scene comes from.
  std::vector<SceneArm> arms = std::vector<SceneArm>(1);  ///< That touch it; at least one.
  double rate = 1000;                                     ///< Ticks per second, Hz.
  double rate_factor = 1;                     ///< Of that, over what the scene's file says.
  double duration = 0;                        ///< s
  std::uint64_t seed = 0;                     ///< Of everything random in the simulation.
  std::optional<driver::EnergyStage> energy;  ///< In place of the arm's own, if named.
  int energy_line = 0;                        ///< Where in the scene's file; 0 if not named.
  std::vector<SceneObject> objects;           ///< What can be touched.
  FaultRule faults = FaultRule::kTogether;    ///< Of several arms.
};

/// What a scene is read with.
struct SceneReading {
  std::filesystem::path
      arm{};  ///< Arm file, by name or path, in place of the scene's; empty: its own.
  /// Where meshes `cgal:NAME` lie; empty: looked for where `thimble doctor` says.
  std::filesystem::path mesh_folder{};
  /// The loop's rate over what the file says, > 0. Above 1 the simulated board reports as often.
  /// Below 1 only where the scene bears it: every stiffness at most half of what the law of the
  /// latency lets this arm and hand hold [PHYSICS 1.1], and no setting refused at that rate.
  double rate_factor = 1;
  /// Whether the reader knows of several arms (Scene::arms); a scene that has them is an error
  /// for all others.
  bool several_arms = false;
};

/// Reads the scene that a person means: a name ("elephant") or a path, as `find_scene` finds it;
/// app/scenes/elephant.yaml shows the form. Paths in it are relative to the file. The arm's file is
/// read too: what is stable depends on the arm. The error lists the names that are known, or tells
/// up to five mistakes of the file, one per line. Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<Scene> load_scene(const std::filesystem::path& scene,
                                                const SceneReading& reading = {});

}  // namespace thimble::scene
